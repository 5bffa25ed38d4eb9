// Units: SI units with prefixes, and conversion-based units, which refer to others with a factor.

#include "parser/import/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace lyr::importer {

namespace {

constexpr double mm_per_metre = 1000;

struct Prefix {
    std::string_view name;
    double factor;
};
constexpr std::array prefixes{
    Prefix{"EXA", 1e18},  Prefix{"PETA", 1e15},  Prefix{"TERA", 1e12},   Prefix{"GIGA", 1e9},
    Prefix{"MEGA", 1e6},  Prefix{"KILO", 1e3},   Prefix{"HECTO", 1e2},   Prefix{"DECA", 1e1},
    Prefix{"DECI", 1e-1}, Prefix{"CENTI", 1e-2}, Prefix{"MILLI", 1e-3},  Prefix{"MICRO", 1e-6},
    Prefix{"NANO", 1e-9}, Prefix{"PICO", 1e-12}, Prefix{"FEMTO", 1e-15}, Prefix{"ATTO", 1e-18},
};

// Files write the degree with 7 to 16 digits. No other unit of angle is this close to it.
constexpr double degree_closeness = 1e-5;

double exact_degree(double angle_rad) {
    constexpr double degree_rad = std::numbers::pi / 180;
    return std::abs(angle_rad / degree_rad - 1) < degree_closeness ? degree_rad : angle_rad;
}

// The record that states a measure and its unit, in either mapping, whatever the subtype.
constexpr std::array measure_types{
    std::string_view("LENGTH_MEASURE_WITH_UNIT"), std::string_view("PLANE_ANGLE_MEASURE_WITH_UNIT"),
    std::string_view("MEASURE_WITH_UNIT"), std::string_view("UNCERTAINTY_MEASURE_WITH_UNIT")};

bool is_measure(const File& file, InstanceIndex instance) {
    return std::any_of(measure_types.begin(), measure_types.end(),
                       [&](std::string_view type) { return file.is(instance, type); });
}

struct Measure {
    double value;
    InstanceIndex unit;
};

Result<Measure> read_measure(const File& file, InstanceIndex instance) {
    const std::string_view type =
        file.is_complex(instance) ? "MEASURE_WITH_UNIT" : keyword(file, instance);
    const std::size_t own = type == "UNCERTAINTY_MEASURE_WITH_UNIT" ? 4 : 2;
    Attributes a(file, instance, type, 0, own);
    const part21::Value component = a.fields.value(a.first).untyped();
    const InstanceIndex unit = a.fields.reference(a.first + 1);
    if (!a.fields.ok()) return a.fields.error();
    const Result<double> value = component.as_real();
    if (!value) return value.error();
    return Measure{*value, unit};
}

}  // namespace

UnitTable::UnitTable(const File& file, Diagnostics& diagnostics)
    : file_(&file), diagnostics_(&diagnostics), trail_(file) {}

Result<Units> UnitTable::of_context(InstanceIndex context) {
    if (!context.valid()) {
        context = only_context();
        if (!context.valid()) return Units{};
    }
    const auto found = known_.find(context.value);
    if (found != known_.end()) return found->second;
    Result<Units> units = read_context(context);
    if (units) known_.emplace(context.value, *units);
    return units;
}

InstanceIndex UnitTable::only_context() const {
    const auto contexts = file_->instances_of("GLOBAL_UNIT_ASSIGNED_CONTEXT");
    return contexts.size() == 1 ? contexts.front() : InstanceIndex();
}

Result<Units> UnitTable::read_context(InstanceIndex context) {
    Units result;
    bool has_length = false;
    if (file_->is(context, "GLOBAL_UNIT_ASSIGNED_CONTEXT")) {
        // Behind identifier and type of the representation context.
        Attributes a(*file_, context, "GLOBAL_UNIT_ASSIGNED_CONTEXT", 2, 1);
        const std::vector<InstanceIndex> units = a.fields.references(a.first);
        if (!a.fields.ok()) return a.fields.error();
        for (const InstanceIndex instance : units) {
            const Result<Unit> unit = read_unit(instance);
            if (!unit) return unit.error();
            if (unit->quantity == Quantity::length) {
                result.length_mm = unit->factor;
                has_length = true;
            } else if (unit->quantity == Quantity::angle) {
                result.angle_rad = exact_degree(unit->factor);
            }
        }
    }
    if (!has_length) {
        diagnostics_->push_back(warning(
            *file_, context, "no unit of length is stated; lengths are taken to be millimetres"));
    }
    if (const Status status = read_uncertainties(context, result); !status) return status.error();
    return result;
}

Status UnitTable::read_uncertainties(InstanceIndex context, Units& units) {
    if (!file_->is(context, "GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT")) return Done{};
    Attributes a(*file_, context, "GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT", 2, 1);
    const std::vector<InstanceIndex> uncertainties = a.fields.references(a.first);
    if (!a.fields.ok()) return a.fields.error();
    for (const InstanceIndex instance : uncertainties) {
        if (!is_measure(*file_, instance)) continue;
        const Result<Measure> measure = read_measure(*file_, instance);
        if (!measure) return measure.error();
        const Result<Unit> unit = read_unit(measure->unit);
        if (!unit) return unit.error();
        if (unit->quantity != Quantity::length) continue;
        units.uncertainty_mm = std::max(units.uncertainty_mm, measure->value * unit->factor);
    }
    return Done{};
}

Result<UnitTable::Unit> UnitTable::read_unit(InstanceIndex unit) {
    const auto step = trail_.enter(unit);
    if (!step) return step.error();
    const bool matters = file_->is(unit, "LENGTH_UNIT") || file_->is(unit, "PLANE_ANGLE_UNIT");
    if (file_->is(unit, "SI_UNIT")) return read_si_unit(unit);
    // Masses, times and the like; a simple instance does not say what it measures.
    if (!matters && file_->is_complex(unit)) return Unit{Quantity::other, 1};
    if (!file_->is(unit, "CONVERSION_BASED_UNIT")) {
        if (matters) return unsupported(*file_, unit, "a unit of length or angle");
        return Unit{Quantity::other, 1};
    }
    Attributes a(*file_, unit, "CONVERSION_BASED_UNIT", 1, 2);
    const InstanceIndex factor = a.fields.reference(a.first + 1);
    if (!a.fields.ok()) return a.fields.error();
    if (!is_measure(*file_, factor)) return unexpected(*file_, unit, "a measure with unit", factor);
    const Result<Measure> measure = read_measure(*file_, factor);
    if (!measure) return measure.error();
    const Result<Unit> base = read_unit(measure->unit);
    if (!base) return base.error();
    if (base->quantity != Quantity::other &&
        !(measure->value > 0 && std::isfinite(measure->value))) {
        return file_->error(factor,
                            named(*file_, factor) + ": the factor of a unit must be positive");
    }
    return Unit{base->quantity, base->factor * measure->value};
}

Result<UnitTable::Unit> UnitTable::read_si_unit(InstanceIndex unit) {
    Attributes a(*file_, unit, "SI_UNIT", 1, 2);
    const part21::Value prefix = a.fields.value(a.first);
    const std::string name = a.fields.enumeration(a.first + 1).upper();
    if (!a.fields.ok()) return a.fields.error();
    double factor = 1;
    if (!prefix.is_unset()) {
        const Result<part21::Name> written = prefix.as_enumeration();
        if (!written) return written.error();
        const auto known = std::find_if(prefixes.begin(), prefixes.end(),
                                        [&](const Prefix& p) { return *written == p.name; });
        if (known == prefixes.end()) return prefix.expected("an SI prefix such as .MILLI.");
        factor = known->factor;
    }
    if (name == "METRE") {
        // Multiplying by 1e-3 and 1e3 would leave one unit in the last place; a millimetre is 1 exactly.
        const bool is_small = factor < 1;
        return Unit{Quantity::length,
                    is_small ? mm_per_metre / std::round(1 / factor) : mm_per_metre * factor};
    }
    if (name == "RADIAN") return Unit{Quantity::angle, factor};
    return Unit{Quantity::other, factor};
}

}  // namespace lyr::importer
