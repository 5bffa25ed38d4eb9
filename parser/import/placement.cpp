// Local coordinate systems: ISO 10303-42's first_proj_axis, build_axes and base_axis.

#include "parser/import/placement.h"

#include <array>
#include <cmath>

#include "kernel/geometry/tolerance.h"

namespace lyr::importer {

namespace {

// The part of `wanted` across the unit vector `z`, unit length; zero where they are parallel.
Vector3 across(const Vector3& wanted, const Vector3& z) {
    const Vector3 rest = wanted - wanted.dot(z) * z;
    if (rest.norm() <= angular_resolution_rad) return Vector3::Zero();
    // What is left of a nearly parallel direction is mostly round-off; once more, it is square to z.
    const Vector3 x = rest.normalized();
    return (x - x.dot(z) * z).normalized();
}

// first_proj_axis: x as wanted, made square to z.
Vector3 first_projected(const Vector3& z, const Vector3* wanted) {
    if (wanted != nullptr) {
        const Vector3 x = across(*wanted, z);
        if (!x.isZero()) return x;
    }
    const Vector3 x = across(Vector3::UnitX(), z);
    return x.isZero() ? across(Vector3::UnitY(), z) : x;
}

// The coordinates of a point or direction; of a plane one, with z = 0.
Result<std::array<double, 3>> read_triple(const File& file, InstanceIndex instance, int dimension) {
    std::array<double, 3> values{};
    if (file.plain_reals(instance, values) == static_cast<std::size_t>(dimension)) return values;
    values = {};
    Fields fields(file, instance, 2);
    const part21::Value list = fields.value(1);
    if (!fields.ok()) return fields.error();
    const Result<std::size_t> count = list.read_reals(values);
    if (!count) return count.error();
    if (*count != static_cast<std::size_t>(dimension))
        return list.expected(dimension == 3 ? "three numbers" : "two numbers");
    for (const double value : values) {
        if (!std::isfinite(value)) return list.expected("finite numbers");
    }
    return values;
}

// An optional direction attribute; zero when absent.
Result<Vector3> optional_direction(const File& file, InstanceIndex user, InstanceIndex direction,
                                   const Units& units) {
    if (!direction.valid()) return Vector3(Vector3::Zero());
    return read_direction(file, user, direction, units);
}

struct OperatorFields {
    InstanceIndex axis1, axis2, origin, axis3;
    double scale = 1;
};

// CARTESIAN_TRANSFORMATION_OPERATOR has axis1, axis2, local_origin and scale, its subtype ..._3D axis3.
Result<OperatorFields> operator_fields(const File& file, InstanceIndex item) {
    constexpr std::string_view type = "CARTESIAN_TRANSFORMATION_OPERATOR_3D";
    OperatorFields result;
    const auto read_first_four = [&](Fields& fields, std::size_t first) {
        result.axis1 = fields.optional_reference(first);
        result.axis2 = fields.optional_reference(first + 1);
        result.origin = fields.reference(first + 2);
        if (!fields.value(first + 3).is_unset()) result.scale = fields.real(first + 3);
    };
    if (file.is_complex(item)) {
        Fields fields(file, file.record(item, "CARTESIAN_TRANSFORMATION_OPERATOR"), 4);
        read_first_four(fields, 0);
        if (!fields.ok()) return fields.error();
        Fields third(file, file.record(item, type), 1);
        result.axis3 = third.optional_reference(0);
        if (!third.ok()) return third.error();
        return result;
    }
    // Writers agree on the last five attributes, not on how many names stand before them.
    const Result<part21::Arguments> arguments = file.arguments(item);
    if (!arguments) return arguments.error();
    Fields fields(file, item, std::max<std::size_t>(arguments->count(), 6));
    const std::size_t first = arguments->count() < 5 ? 0 : arguments->count() - 5;
    read_first_four(fields, first);
    result.axis3 = fields.optional_reference(first + 4);
    if (!fields.ok()) return fields.error();
    return result;
}

Result<Eigen::Affine3d> read_operator(const File& file, InstanceIndex item, const Units& units) {
    const Result<OperatorFields> fields = operator_fields(file, item);
    if (!fields) return fields.error();
    const double scale = fields->scale;
    if (!(scale > 0 && std::isfinite(scale))) {
        return file.error(item, named(file, item) + ": the scale must be positive");
    }
    const Result<Point3> at = read_point(file, item, fields->origin, units);
    if (!at) return at.error();
    const Result<Vector3> d1 = optional_direction(file, item, fields->axis1, units);
    if (!d1) return d1.error();
    const Result<Vector3> d2 = optional_direction(file, item, fields->axis2, units);
    if (!d2) return d2.error();
    const Result<Vector3> d3 = optional_direction(file, item, fields->axis3, units);
    if (!d3) return d3.error();

    const Vector3 z = d3->isZero() ? Vector3(Vector3::UnitZ()) : *d3;
    const Vector3 x = first_projected(z, d1->isZero() ? nullptr : &*d1);
    // second_proj_axis: on which side of x and z axis2 lies decides the handedness.
    const Vector3 right_handed = z.cross(x);
    const Vector3 wanted = d2->isZero() ? Vector3(Vector3::UnitY()) : *d2;
    const Vector3 y = wanted.dot(right_handed) < 0 ? Vector3(-right_handed) : right_handed;
    Eigen::Affine3d transform;
    transform.linear() << scale * x, scale * y, scale * z;
    transform.translation() = *at;
    transform.makeAffine();
    return transform;
}

}  // namespace

Result<Point3> read_point(const File& file, InstanceIndex user, InstanceIndex point,
                          const Units& units) {
    const std::string_view type = keyword(file, point);
    if (type != "CARTESIAN_POINT") return unexpected(file, user, "CARTESIAN_POINT", point);
    const auto values = read_triple(file, point, units.dimension);
    if (!values) return values.error();
    return Point3(units.length_mm * Point3(values->data()));
}

Result<Vector3> read_direction(const File& file, InstanceIndex user, InstanceIndex direction,
                               const Units& units) {
    if (keyword(file, direction) != "DIRECTION")
        return unexpected(file, user, "DIRECTION", direction);
    const auto values = read_triple(file, direction, units.dimension);
    if (!values) return values.error();
    const Vector3 vector(values->data());
    const double length = vector.stableNorm();
    if (!(length > 0)) return file.error(direction, named(file, direction) + " has no length");
    return Vector3((vector / length).normalized());
}

Result<Frame> read_frame(const File& file, InstanceIndex user, InstanceIndex placement,
                         const Units& units) {
    // In a plane there is no axis to state.
    const bool is_plane = units.dimension == 2;
    const std::string_view expected = is_plane ? "AXIS2_PLACEMENT_2D" : "AXIS2_PLACEMENT_3D";
    if (keyword(file, placement) != expected) return unexpected(file, user, expected, placement);
    Fields fields(file, placement, is_plane ? 3 : 4);
    const InstanceIndex location = fields.reference(1);
    const InstanceIndex axis = is_plane ? InstanceIndex() : fields.optional_reference(2);
    const InstanceIndex reference = fields.optional_reference(is_plane ? 2 : 3);
    if (!fields.ok()) return fields.error();
    const Result<Point3> origin = read_point(file, placement, location, units);
    if (!origin) return origin.error();
    const Result<Vector3> z_stated = optional_direction(file, placement, axis, units);
    if (!z_stated) return z_stated.error();
    const Result<Vector3> x_stated = optional_direction(file, placement, reference, units);
    if (!x_stated) return x_stated.error();
    Frame frame;
    frame.origin = *origin;
    if (!z_stated->isZero()) frame.z = *z_stated;
    frame.x = first_projected(frame.z, x_stated->isZero() ? nullptr : &*x_stated);
    frame.y = frame.z.cross(frame.x);
    return frame;
}

Result<Frame> read_axis(const File& file, InstanceIndex user, InstanceIndex placement,
                        const Units& units) {
    if (keyword(file, placement) != "AXIS1_PLACEMENT") {
        return unexpected(file, user, "AXIS1_PLACEMENT", placement);
    }
    Fields fields(file, placement, 3);
    const InstanceIndex location = fields.reference(1);
    const InstanceIndex axis = fields.optional_reference(2);
    if (!fields.ok()) return fields.error();
    const Result<Point3> origin = read_point(file, placement, location, units);
    if (!origin) return origin.error();
    const Result<Vector3> z_stated = optional_direction(file, placement, axis, units);
    if (!z_stated) return z_stated.error();
    Frame frame;
    frame.origin = *origin;
    if (!z_stated->isZero()) frame.z = *z_stated;
    frame.x = first_projected(frame.z, nullptr);
    frame.y = frame.z.cross(frame.x);
    return frame;
}

Eigen::Affine3d to_affine(const Frame& frame) {
    Eigen::Affine3d transform;
    transform.linear() << frame.x, frame.y, frame.z;
    transform.translation() = frame.origin;
    transform.makeAffine();
    return transform;
}

bool is_operator(const File& file, InstanceIndex item) {
    return file.is(item, "CARTESIAN_TRANSFORMATION_OPERATOR_3D");
}

Result<Eigen::Affine3d> read_transform(const File& file, InstanceIndex user, InstanceIndex item,
                                       const Units& units) {
    if (is_operator(file, item)) return read_operator(file, item, units);
    if (keyword(file, item) != "AXIS2_PLACEMENT_3D") {
        return unexpected(file, user, "AXIS2_PLACEMENT_3D or CARTESIAN_TRANSFORMATION_OPERATOR_3D",
                          item);
    }
    const Result<Frame> frame = read_frame(file, user, item, units);
    if (!frame) return frame.error();
    return to_affine(*frame);
}

}  // namespace lyr::importer
