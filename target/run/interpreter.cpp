#include "target/run/interpreter.h"

namespace lyr::run {

Interpreter::Interpreter(format::Reader reader, const config::Printer& printer,
                         double filament_diameter_mm)
    : reader_(std::move(reader)),
      maker_(printer, reader_.header().quantum, filament_diameter_mm,
             moves::head_at_start(printer)) {}

Result<std::optional<Instruction>> Interpreter::next() {
    while (given_ == maker_.made().size()) {
        const Result<std::optional<format::Operation>> operation = reader_.next();
        if (!operation) return operation.error();
        if (!*operation) return std::optional<Instruction>();
        maker_.take(**operation, reader_.layer().state, reader_.path());
        given_ = 0;
        if (const auto order = orders_.take(**operation, reader_.layer().state))
            return std::optional<Instruction>(*order);
    }
    return std::optional(
        std::visit([](const auto& made) -> Instruction { return made; }, maker_.made()[given_++]));
}

}  // namespace lyr::run
