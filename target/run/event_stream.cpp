// Steps come in batches; each becomes events as far as they are certain.

#include "target/run/event_stream.h"

#include "target/run/inspect.h"

namespace lyr::run {

Result<EventStream> EventStream::open(const std::string& path, const config::Printer& printer,
                                      double filament_diameter_mm, OrderQueue* orders,
                                      std::uint32_t first_layer) {
    Result<format::Reader> reader = open_file(path, first_layer);
    if (!reader) return reader.error();
    return open(std::move(*reader), path, printer, filament_diameter_mm, orders);
}

Result<EventStream> EventStream::open(format::Reader reader, const std::string& path,
                                      const config::Printer& printer, double filament_diameter_mm,
                                      OrderQueue* orders) {
    Result<StepStream> steps =
        StepStream::open(std::move(reader), path, printer, filament_diameter_mm, orders);
    if (!steps) return steps.error();
    return EventStream(std::move(*steps),
                       PulseSchedule(printer.pulse, line_layout(printer).enable));
}

Result<bool> EventStream::next(std::vector<LineEvent>& events) {
    batch_.clear();
    const Result<bool> more = next(batch_);
    if (!more) return more.error();
    append(batch_, *more ? std::nullopt : std::optional(steps_.time_ns()), events);
    return *more;
}

void EventStream::append(std::span<const Step> steps, std::optional<std::int64_t> end_ns,
                         std::vector<LineEvent>& events) {
    if (!begun_) schedule_.begin(driver_wake_ns, events);
    begun_ = true;
    schedule_.append(steps, events);
    if (end_ns) schedule_.finish(*end_ns, events);
}

}  // namespace lyr::run
