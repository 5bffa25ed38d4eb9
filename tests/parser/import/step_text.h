// STEP files for tests, written line by line: instances are numbered as they are added, and helpers write the
// shapes that tests need again and again, with every orientation flag free to be set either way.

#pragma once

#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "kernel/geometry/vector.h"

namespace lyr::test {

// How a shape states what it states: each flag has a counterpart that undoes it.
struct ShapeFlags {
    bool surfaces_inward = false;    // the planes' normals point inward, same_sense is .F.
    bool bounds_reversed = false;    // loops run clockwise, the bound's orientation is .F.
    bool edges_against = false;      // curves run against their edges, same_sense is .F.
    bool faces_oriented = false;     // each face turned inside out, and back by an ORIENTED_FACE
    bool senses_contradict = false;  // same_sense is wrong, and nothing makes up for it
};

class StepText {
public:
    // Adds "#n=<text>;" and returns n.
    int add(const std::string& text) {
        define(++last_, text);
        return last_;
    }

    // Takes a number for an instance that define() writes later.
    int reserve() { return ++last_; }
    void define(int id, const std::string& text) {
        body_.append(ref(id)).append("=").append(text).append(";\n");
    }

    // Spoils the n-th instance of a type: its attribute `index` becomes `text`.
    void spoil(const std::string& type, int n, int index, const std::string& text) {
        std::size_t at = 0;
        for (int i = 0; i <= n; ++i) at = body_.find(type + "(", at) + type.size() + 1;
        for (int i = 0; i < index; ++i) at = body_.find(',', at) + 1;
        body_.replace(at, body_.find_first_of(",)", at) - at, text);
    }

    std::string text() const {
        return "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\n"
               "FILE_NAME('','',(''),(''),'','','');\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;"
               "\nDATA;\n" +
               body_ + "ENDSEC;\nEND-ISO-10303-21;\n";
    }

    static std::string ref(int id) { return std::string("#").append(std::to_string(id)); }
    static std::string refs(const std::vector<int>& ids) {
        std::string text = "(";
        for (const int id : ids) {
            if (text.size() > 1) text += ',';
            text += ref(id);
        }
        return text += ')';
    }
    static std::string num(double value) {
        char text[40];
        std::snprintf(text, sizeof text, "%.17g", value);
        return std::string(text).find_first_of(".en") == std::string::npos ? std::string(text) + "."
                                                                           : text;
    }
    static std::string flag(bool value) { return value ? ".T." : ".F."; }

    int point(const Point3& p) {
        return add("CARTESIAN_POINT('',(" + num(p.x()) + "," + num(p.y()) + "," + num(p.z()) +
                   "))");
    }
    int direction(const Vector3& d) {
        return add("DIRECTION('',(" + num(d.x()) + "," + num(d.y()) + "," + num(d.z()) + "))");
    }
    int vertex(const Point3& p) { return add("VERTEX_POINT(''," + ref(point(p)) + ")"); }
    int placement(const Point3& origin, const Vector3& z, const Vector3& x) {
        const int o = point(origin), a = direction(z), b = direction(x);
        return add("AXIS2_PLACEMENT_3D(''," + ref(o) + "," + ref(a) + "," + ref(b) + ")");
    }
    int line(const Point3& from, const Point3& to) {
        const int o = point(from), d = direction(to - from);
        const int v = add("VECTOR(''," + ref(d) + ",1.)");
        return add("LINE(''," + ref(o) + "," + ref(v) + ")");
    }
    int edge(int start, int end, int curve, bool same_sense = true) {
        return add("EDGE_CURVE(''," + ref(start) + "," + ref(end) + "," + ref(curve) + "," +
                   flag(same_sense) + ")");
    }
    int oriented(int edge, bool orientation) {
        return add("ORIENTED_EDGE('',*,*," + ref(edge) + "," + flag(orientation) + ")");
    }
    int loop(const std::vector<int>& oriented_edges) {
        return add("EDGE_LOOP(''," + refs(oriented_edges) + ")");
    }
    int bound(int loop, bool orientation = true) {
        return add("FACE_OUTER_BOUND(''," + ref(loop) + "," + flag(orientation) + ")");
    }
    int face(const std::vector<int>& bounds, int surface, bool same_sense = true) {
        return add("ADVANCED_FACE(''," + refs(bounds) + "," + ref(surface) + "," +
                   flag(same_sense) + ")");
    }

    // A representation context. Units as instances; none: no GLOBAL_UNIT_ASSIGNED_CONTEXT.
    int context(const std::vector<int>& units, const std::vector<int>& uncertainties = {}) {
        std::string text = "(GEOMETRIC_REPRESENTATION_CONTEXT(3)";
        if (!uncertainties.empty())
            text += "GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT(" + refs(uncertainties) + ")";
        if (!units.empty()) text += "GLOBAL_UNIT_ASSIGNED_CONTEXT(" + refs(units) + ")";
        return add(text + "REPRESENTATION_CONTEXT('',''))");
    }
    int si_length(const std::string& prefix) {
        return add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(" + prefix + ",.METRE.))");
    }
    int radian() { return add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))"); }
    int converted_length(const std::string& name, double factor, int base) {
        const int measure =
            add("LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(" + num(factor) + ")," + ref(base) + ")");
        return add("(CONVERSION_BASED_UNIT('" + name + "'," + ref(measure) +
                   ")LENGTH_UNIT()NAMED_UNIT(*))");
    }
    int degree(const std::string& factor = "0.0174532925") {
        const int measure = add("PLANE_ANGLE_MEASURE_WITH_UNIT(PLANE_ANGLE_MEASURE(" + factor +
                                ")," + ref(radian()) + ")");
        return add("(CONVERSION_BASED_UNIT('DEGREE'," + ref(measure) +
                   ")NAMED_UNIT(*)PLANE_ANGLE_UNIT())");
    }
    int millimetres() { return context({si_length(".MILLI."), radian()}); }

    int representation(const std::vector<int>& items, int context,
                       const std::string& type = "ADVANCED_BREP_SHAPE_REPRESENTATION") {
        return add(type + "(''," + refs(items) + "," + ref(context) + ")");
    }
    // A product with a shape; returns the PRODUCT_DEFINITION.
    int product(const std::string& name, int representation) {
        const int product = add("PRODUCT('" + name + "','" + name + "','',())");
        const int formation = add("PRODUCT_DEFINITION_FORMATION('',''," + ref(product) + ")");
        const int definition = add("PRODUCT_DEFINITION('',''," + ref(formation) + ",$)");
        const int shape = add("PRODUCT_DEFINITION_SHAPE('',''," + ref(definition) + ")");
        add("SHAPE_DEFINITION_REPRESENTATION(" + ref(shape) + "," + ref(representation) + ")");
        return definition;
    }
    // `child` within `parent`, from placement `of_first` of representation `first` to `of_second` of `second`.
    void occurrence(int parent, int child, int first, int second, int of_first, int of_second) {
        const int usage = add("NEXT_ASSEMBLY_USAGE_OCCURRENCE('','',''," + ref(parent) + "," +
                              ref(child) + ",$)");
        const int shape = add("PRODUCT_DEFINITION_SHAPE('',''," + ref(usage) + ")");
        const int transformation =
            add("ITEM_DEFINED_TRANSFORMATION('',''," + ref(of_first) + "," + ref(of_second) + ")");
        const int relationship =
            add("(REPRESENTATION_RELATIONSHIP('',''," + ref(first) + "," + ref(second) +
                ")REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(" + ref(transformation) +
                ")SHAPE_REPRESENTATION_RELATIONSHIP())");
        add("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(" + ref(relationship) + "," + ref(shape) + ")");
    }

    // The faces of an axis-parallel box, looking out of it.
    std::vector<int> box_faces(const Point3& low, const Point3& high,
                               const ShapeFlags& flags = {}) {
        std::array<int, 8> vertices;
        std::array<Point3, 8> corners;
        for (std::size_t i = 0; i < 8; ++i) {
            corners[i] = {i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                          i & 4 ? high.z() : low.z()};
            vertices[i] = vertex(corners[i]);
        }
        // Corners counter-clockwise as seen from outside.
        const std::size_t sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
        const Vector3 normals[6] = {-Vector3::UnitZ(), Vector3::UnitZ(),  -Vector3::UnitY(),
                                    Vector3::UnitY(),  -Vector3::UnitX(), Vector3::UnitX()};
        int edges[8][8] = {};
        std::vector<int> faces;
        for (std::size_t s = 0; s < 6; ++s) {
            std::vector<int> uses;
            for (std::size_t k = 0; k < 4; ++k) {
                const std::size_t a = sides[s][k], b = sides[s][(k + 1) % 4];
                const std::size_t first = std::min(a, b), second = std::max(a, b);
                int& e = edges[first][second];
                if (e == 0) {
                    const int curve = flags.edges_against ? line(corners[second], corners[first])
                                                          : line(corners[first], corners[second]);
                    e = edge(vertices[first], vertices[second], curve, !flags.edges_against);
                }
                uses.push_back(
                    oriented(e, (a < b) != (flags.bounds_reversed != flags.faces_oriented)));
            }
            if (flags.bounds_reversed != flags.faces_oriented)
                uses = {uses[3], uses[2], uses[1], uses[0]};
            const double side = flags.surfaces_inward ? -1 : 1;
            const Vector3 x = normals[s].unitOrthogonal();
            const int plane =
                add("PLANE(''," + ref(placement(corners[sides[s][0]], side * normals[s], x)) + ")");
            int f =
                face({bound(loop(uses), !flags.bounds_reversed)}, plane,
                     (!flags.surfaces_inward != flags.faces_oriented) != flags.senses_contradict);
            if (flags.faces_oriented) f = add("ORIENTED_FACE('',*," + ref(f) + ",.F.)");
            faces.push_back(f);
        }
        return faces;
    }
    int box_shell(const Point3& low, const Point3& high, const ShapeFlags& flags = {}) {
        return add("CLOSED_SHELL(''," + refs(box_faces(low, high, flags)) + ")");
    }
    int box(const Point3& low, const Point3& high, const ShapeFlags& flags = {}) {
        return add("MANIFOLD_SOLID_BREP('box'," + ref(box_shell(low, high, flags)) + ")");
    }

    // A cylinder standing on z = 0: a lateral face with a seam, two discs.
    int cylinder(double radius, double height) {
        const int bottom_vertex = vertex({radius, 0, 0}), top_vertex = vertex({radius, 0, height});
        const auto circle = [&](double z) {
            const int at = placement({0, 0, z}, Vector3::UnitZ(), Vector3::UnitX());
            return add("CIRCLE(''," + ref(at) + "," + num(radius) + ")");
        };
        const int bottom = edge(bottom_vertex, bottom_vertex, circle(0));
        const int top = edge(top_vertex, top_vertex, circle(height));
        const int seam = edge(bottom_vertex, top_vertex, line({radius, 0, 0}, {radius, 0, height}));
        const int axis = placement({0, 0, 0}, Vector3::UnitZ(), Vector3::UnitX());
        const int lateral = add("CYLINDRICAL_SURFACE(''," + ref(axis) + "," + num(radius) + ")");
        const int floor = add("PLANE(''," + ref(axis) + ")");
        const int lid = add(
            "PLANE(''," + ref(placement({0, 0, height}, Vector3::UnitZ(), Vector3::UnitX())) + ")");
        const int side_loop = loop({oriented(bottom, true), oriented(seam, true),
                                    oriented(top, false), oriented(seam, false)});
        const int shell = add("CLOSED_SHELL(''," +
                              refs({face({bound(side_loop)}, lateral),
                                    face({bound(loop({oriented(bottom, false)}))}, floor, false),
                                    face({bound(loop({oriented(top, true)}))}, lid)}) +
                              ")");
        return add("MANIFOLD_SOLID_BREP('cylinder'," + ref(shell) + ")");
    }

private:
    std::string body_;
    int last_ = 0;
};

}  // namespace lyr::test
