// The C reader over bytes in memory, and whether it says what the C++ reader says.

#pragma once

#include <algorithm>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "format/c/lyr.h"
#include "format/layout.h"
#include "format/reader.h"

namespace lyr::format::test {

// Bytes as a source. What is read in a step is at most `most` bytes: pipes give less than asked for.
struct Memory {
    std::span<const std::byte> bytes;
    std::size_t at = 0, most = SIZE_MAX;

    static std::int32_t read(void* user, std::uint8_t* out, std::uint32_t count) {
        auto& memory = *static_cast<Memory*>(user);
        const std::size_t left = memory.bytes.size() - std::min(memory.at, memory.bytes.size());
        const std::size_t given = std::min({std::size_t{count}, left, memory.most});
        if (given > 0) std::memcpy(out, memory.bytes.data() + memory.at, given);
        memory.at += given;
        return static_cast<std::int32_t>(given);
    }
    static bool seek(void* user, std::uint64_t offset) {
        static_cast<Memory*>(user)->at = static_cast<std::size_t>(offset);
        return true;
    }
    lyr_source source() { return {read, seek, this}; }
};

// A reader with its buffer.
struct CReader {
    explicit CReader(Memory& memory, std::size_t buffer_size = buffer_bytes)
        : buffer(buffer_size), source(memory.source()) {}

    bool open() {
        return lyr_open(&reader, &source, buffer.data(), static_cast<std::uint32_t>(buffer.size()));
    }

    std::vector<std::byte> buffer;
    lyr_source source;
    lyr_reader reader;
    lyr_operation operation;
};

inline Point point_of(const lyr_point& p) {
    return {p.x, p.y, p.z};
}

inline PathStyle style_of(const lyr_style& s) {
    return {static_cast<Role>(s.role), s.width / scale::width,
            s.height / scale::width,   s.flow / scale::flow,
            s.speed / scale::speed,    s.acceleration / scale::acceleration};
}

// What the C++ reader gives out for it. `left_mm` of a wipe is taken over: C has the whole way instead.
inline Operation operation_of(const lyr_reader& r, const lyr_operation& o, const Operation& like) {
    const Point from = point_of(o.from), to = point_of(o.to);
    switch (o.kind) {
        case LYR_LAYER:
            return LayerStart{o.number, to};
        case LYR_PATH:
            return PathStart{style_of(r.style)};
        case LYR_LINE:
            return Line{from, to, o.hatch};
        case LYR_ARC:
            return Arc{from, to, o.sagitta};
        case LYR_CIRCLE:
            return Circle{from, to, o.center_x, o.center_y, o.counter_clockwise};
        case LYR_TRAVEL:
            return Travel{from, to, o.hatch};
        case LYR_HATCH:
            return HatchStart{static_cast<double>(r.grid[0]) / scale::direction,
                              static_cast<double>(r.grid[1]) / scale::direction,
                              Quantum{r.quantum_nm}.mm(r.grid[3]) / scale::offset};
        case LYR_WIPE: {
            const auto* wipe = std::get_if<Wipe>(&like);
            return Wipe{from, to, o.sagitta, o.value / scale::filament, wipe ? wipe->left_mm : -1};
        }
        case LYR_WIDTH:
            return Width{o.value / scale::width};
        case LYR_SPEED:
            return Speed{o.value / scale::speed};
        case LYR_ACCELERATION:
            return Acceleration{o.value / scale::acceleration};
        case LYR_TRAVEL_SPEED:
            return TravelSpeed{o.value / scale::speed};
        case LYR_TRAVEL_ACCELERATION:
            return TravelAcceleration{o.value / scale::acceleration};
        case LYR_RETRACT:
            return Retract{o.value / scale::filament};
        case LYR_TEMPERATURE:
            return Temperature{{static_cast<HeaterKind>(o.heater), o.number},
                               o.value / scale::temperature,
                               o.wait};
        case LYR_FAN:
            return Fan{o.number, o.value / scale::duty};
        case LYR_DWELL:
            return Dwell{o.value};
        case LYR_TOOL:
            return Tool{o.value};
        case LYR_PAUSE:
            return Pause{static_cast<PauseReason>(o.value)};
        case LYR_OBJECT:
            return Object{o.value};
    }
    return Object{0xffffffff};
}

inline bool same_layer(const lyr_layer& c, const Layer& layer, Quantum quantum) {
    const LayerState& s = layer.state;
    const LayerTotals& t = layer.totals;
    bool same = c.index == layer.index && quantum.mm(c.start.x) == s.start_x_mm &&
                quantum.mm(c.start.y) == s.start_y_mm && quantum.mm(c.start.z) == s.z_mm &&
                c.thickness / scale::width == s.height_mm &&
                c.travel_speed / scale::speed == s.travel_speed_mm_s &&
                c.travel_acceleration / scale::acceleration == s.travel_acceleration_mm_s2 &&
                c.tool == s.tool && c.object == s.object &&
                c.retracted / scale::filament == s.retracted_mm &&
                c.retract_length / scale::filament == s.retract_length_mm &&
                c.retract_speed / scale::speed == s.retract_speed_mm_s &&
                c.unretract_speed / scale::speed == s.unretract_speed_mm_s &&
                c.heater_count == s.temperatures.size() && c.fan_count == s.fans.size() &&
                static_cast<double>(c.time) / scale::time == s.estimated_time_s &&
                c.chunks == t.chunks && c.operations == t.operations &&
                point_of(c.low) == t.motion.low && point_of(c.high) == t.motion.high &&
                static_cast<std::int64_t>(c.extruded) == t.extruded_quanta &&
                static_cast<std::int64_t>(c.travelled) == t.travel_quanta &&
                static_cast<double>(c.volume) / scale::volume == t.volume_mm3;
    for (std::size_t i = 0; same && i < s.temperatures.size(); ++i)
        same = c.heaters[i].kind == static_cast<std::uint32_t>(s.temperatures[i].heater.kind) &&
               c.heaters[i].number == s.temperatures[i].heater.tool &&
               c.heaters[i].value / scale::temperature == s.temperatures[i].target_c;
    for (std::size_t i = 0; same && i < s.fans.size(); ++i)
        same = c.fans[i].number == s.fans[i].fan && c.fans[i].value / scale::duty == s.fans[i].duty;
    return same;
}

// The place in a C++ message: "... at byte 12", "it ends at byte 12"; 0: none.
inline std::uint64_t byte_in(const std::string& message) {
    const std::size_t at = message.find(" at byte ");
    return at == std::string::npos ? 0 : std::stoull(message.substr(at + 9));
}

inline std::uint64_t number_behind(const std::string& message, const std::string& words) {
    const std::size_t at = message.find(words);
    return at == std::string::npos ? 0 : std::stoull(message.substr(at + words.size()));
}

// Empty if both give out the same operations at the same bytes and then end alike; else what differs.
inline std::string difference(std::span<const std::byte> bytes, Result<Reader> reader,
                              std::size_t most = SIZE_MAX) {
    Memory memory{bytes, 0, most};
    CReader c(memory);
    c.open();
    std::uint64_t count = 0;
    // C++ reads what precedes the first layer when it opens the file, C only the metadata.
    for (;;) {
        const Operation* operation = reader.ok() ? reader->read() : nullptr;
        const bool given = lyr_next(&c.reader, &c.operation);
        const std::string place = "operation " + std::to_string(count++) + ": ";
        if (given != (operation != nullptr)) return place + (given ? "only C" : "only C++");
        if (!given) break;
        if (!(operation_of(c.reader, c.operation, *operation) == *operation))
            return place + "another";
        if (c.operation.offset != reader->position().offset) return place + "another byte";
        if (!(style_of(c.reader.style) == reader->path())) return place + "another style";
        if (c.operation.kind == LYR_LAYER &&
            !same_layer(c.reader.layer, reader->layer(), reader->header().quantum))
            return place + "another layer";
    }
    const lyr_reader& r = c.reader;
    const Diagnostic* error = !reader.ok()      ? &reader.error()
                              : reader->error() ? &*reader->error()
                                                : nullptr;
    const std::string status = "C: status " + std::to_string(r.status);
    if (!error) return r.status == LYR_END ? "" : "only C refuses it: " + status;
    const std::string& message = error->message;
    const std::string both = message + " | " + status + " at byte " + std::to_string(r.offset);
    if (r.status == LYR_END || r.status == LYR_OK) return "only C++ refuses it: " + message;
    const bool newer = error->status == ExitStatus::unsupported;
    if (newer != (r.status == LYR_UNSUPPORTED)) return "another status: " + both;
    if (byte_in(message) != r.offset) return "another byte: " + both;
    if ((message.find("CRC is wrong") != std::string::npos) != (r.status == LYR_DAMAGED) ||
        (message.find("cut short: it ends") != std::string::npos) !=
            (r.status == LYR_CUT_SHORT && !bytes.empty()))
        return "another reason: " + both;
    if (number_behind(message, "the last whole layer is ") != r.whole_layers)
        return "another last layer: " + both;
    return "";
}

}  // namespace lyr::format::test
