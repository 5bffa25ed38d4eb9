// VCD text is collected in a buffer and handed to the file in large pieces.

#include "target/gpio/tracing_chip.h"

#include <array>
#include <bit>
#include <charconv>

namespace lyr::gpio {
namespace {

constexpr std::size_t flush_bytes = std::size_t{1} << 16;

// VCD identifies a wire by printable characters from '!' on; 64 lines need only one each.
char wire_id(std::size_t line) {
    return static_cast<char>('!' + line);
}

// Wave viewers take "." for a level of hierarchy and white space for the end of the name.
std::string wire_name(const std::string& purpose) {
    std::string name = purpose;
    for (char& c : name) {
        const bool plain =
            (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        if (!plain) c = '_';
    }
    return name.empty() ? "line" : name;
}

}  // namespace

TracingChip::TracingChip(GpioChip& inner, const Clock& clock, std::span<const std::string> names,
                         ReplaceFile& file)
    : inner_(inner), clock_(clock), file_(file), start_ns_(clock.now_ns()) {
    buffer_ = "$version lyrrun $end\n$timescale 1 ns $end\n$scope module printer $end\n";
    for (std::size_t i = 0; i < inner.line_count(); ++i) {
        const std::string name =
            i < names.size() ? wire_name(names[i]) : "line" + std::to_string(i);
        buffer_ += std::string("$var wire 1 ") + wire_id(i) + ' ' + name + " $end\n";
    }
    buffer_ += "$upscope $end\n$enddefinitions $end\n#0\n$dumpvars\n";
    for (std::size_t i = 0; i < inner.line_count(); ++i) append_level(i);
    buffer_ += "$end\n";
    traced_ns_ = 0;
}

TracingChip::~TracingChip() {
    (void)inner_.release();
}

Status TracingChip::write(LineMask changed, LineMask levels) {
    Status written = inner_.write(changed, levels);
    if (written) trace(changed & all_lines(line_count()), levels);
    return written;
}

Status TracingChip::release() {
    if (released_) return Done{};
    released_ = true;
    Status released = inner_.release();
    if (released) trace(all_lines(line_count()), 0);
    return released;
}

void TracingChip::trace(LineMask changed, LineMask levels) {
    LineMask edges = (levels_ ^ levels) & changed;
    if (!edges) return;
    levels_ ^= edges;
    append_time();
    for (; edges; edges &= edges - 1)
        append_level(static_cast<std::size_t>(std::countr_zero(edges)));
    if (buffer_.size() >= flush_bytes) flush();
}

void TracingChip::finish() {
    append_time();
    flush();
}

void TracingChip::append_time() {
    const std::int64_t time_ns = clock_.now_ns() - start_ns_;
    if (time_ns <= traced_ns_) return;
    traced_ns_ = time_ns;
    std::array<char, 24> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), time_ns).ptr;
    buffer_ += '#';
    buffer_.append(digits.data(), end);
    buffer_ += '\n';
}

void TracingChip::append_level(std::size_t line) {
    const std::array<char, 3> change{levels_ & line_bit(line) ? '1' : '0', wire_id(line), '\n'};
    buffer_.append(change.data(), change.size());
}

void TracingChip::flush() {
    file_.write(std::string_view(buffer_));
    buffer_.clear();
}

}  // namespace lyr::gpio
