// The other side of the comparison: OCCT does the same work, with the fastest of its settings that give right results
// (docs/benchmarks.md says which were tried). Nothing of OCCT shows here.

#pragma once

#include <memory>
#include <optional>
#include <string>

namespace lyr::bench::occt {

// Once, before all else: OCCT's own messages are not for our table.
void silence();

// A shape, ready to be cut: its faces with their heights.
class Part {
public:
    // Reads the file with STEPControl_Reader (ReadFile and TransferRoots). None: it holds no shape, or OCCT gives up.
    static std::optional<Part> read(const std::string& path);

    double preparation_s() const;  // processor time to find the heights of the faces

    // One plane: BRepAlgoAPI_Section of the faces that the plane can meet, its edges connected to wires by
    // ShapeAnalysis_FreeBounds.
    struct Section {
        double seconds = 0;  // processor time, without measuring the length
        std::size_t wires = 0;
        double length_mm = 0;
    };
    std::optional<Section> cut(double z_mm) const;

private:
    struct Faces;
    explicit Part(std::shared_ptr<const Faces> faces);
    std::shared_ptr<const Faces> faces_;
};

// The faces' whole surfaces, for projecting points.
class Surfaces {
public:
    static std::optional<Surfaces> read(const std::string& path);

    // From the nearest surface of those whose faces' boxes come near the point. The quick projection from a grid may end
    // in a place that is not the nearest: where it says more than `enough_mm`, all extrema are looked for.
    double distance_mm(double x_mm, double y_mm, double z_mm, double enough_mm) const;

private:
    struct Faces;
    explicit Surfaces(std::shared_ptr<const Faces> faces);
    std::shared_ptr<const Faces> faces_;
};

// Processor time of reading a file and making shapes of it, nothing else; none if no shape comes out.
std::optional<double> reading_time_s(const std::string& path);

}  // namespace lyr::bench::occt
