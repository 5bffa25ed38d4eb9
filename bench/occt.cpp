#include "bench/occt.h"

#include <BRepAlgoAPI_Section.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepGProp.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <GeomAPI_ProjectPointOnSurf.hxx>
#include <Geom_Surface.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <Precision.hxx>
#include <STEPControl_Reader.hxx>
#include <ShapeAnalysis_FreeBounds.hxx>
#include <ShapeAnalysis_Surface.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_HSequenceOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Face.hxx>
#include <algorithm>
#include <gp_Pln.hxx>
#include <limits>
#include <vector>

#include "bench/measure.h"

namespace lyr::bench::occt {
namespace {

// Section ends this close are one: OCCT's own sections stray from each other by up to its 1e-7 mm and the tolerances
// of the file's edges.
constexpr double same_point_mm = 1e-5;

std::optional<TopoDS_Shape> shape_of(const std::string& path) {
    try {
        STEPControl_Reader reader;
        if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) return std::nullopt;
        if (reader.TransferRoots() == 0 || reader.NbShapes() == 0) return std::nullopt;
        return reader.OneShape();
    } catch (const Standard_Failure&) {
        return std::nullopt;
    }
}

}  // namespace

struct Part::Faces {
    struct Face {
        TopoDS_Shape shape;
        double bottom_mm, top_mm;
    };
    std::vector<Face> faces;
    double preparation_s = 0;
};

void silence() {
    Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
}

std::optional<double> reading_time_s(const std::string& path) {
    const double start_s = processor_time_s();
    const auto shape = shape_of(path);
    const double end_s = processor_time_s();
    return shape && !shape->IsNull() ? std::optional(end_s - start_s) : std::nullopt;
}

Part::Part(std::shared_ptr<const Faces> faces) : faces_(std::move(faces)) {}

double Part::preparation_s() const {
    return faces_->preparation_s;
}

std::optional<Part> Part::read(const std::string& path) {
    const auto shape = shape_of(path);
    if (!shape || shape->IsNull()) return std::nullopt;
    auto part = std::make_shared<Faces>();
    part->preparation_s = time_of_s([&] {
        for (TopExp_Explorer face(*shape, TopAbs_FACE); face.More(); face.Next()) {
            Bnd_Box box;
            BRepBndLib::AddOptimal(face.Current(), box, false, true);
            if (box.IsVoid()) continue;
            part->faces.push_back({face.Current(), box.CornerMin().Z(), box.CornerMax().Z()});
        }
    });
    return Part(std::move(part));
}

std::optional<Part::Section> Part::cut(double z_mm) const {
    try {
        const double start_s = processor_time_s();
        const BRep_Builder builder;
        TopoDS_Compound met;
        builder.MakeCompound(met);
        for (const Faces::Face& face : faces_->faces) {
            if (face.bottom_mm <= z_mm && z_mm <= face.top_mm) builder.Add(met, face.shape);
        }
        const gp_Pln plane(gp_Pnt(0, 0, z_mm), gp_Dir(0, 0, 1));
        BRepAlgoAPI_Section section(met, BRepBuilderAPI_MakeFace(plane).Shape(), false);
        section.Approximation(true);
        section.ComputePCurveOn1(false);
        section.ComputePCurveOn2(false);
        section.SetRunParallel(false);
        section.SetToFillHistory(false);
        section.SetCheckInverted(false);
        section.Build();
        if (section.HasErrors()) return std::nullopt;
        Handle(TopTools_HSequenceOfShape) edges = new TopTools_HSequenceOfShape;
        Handle(TopTools_HSequenceOfShape) wires = new TopTools_HSequenceOfShape;
        for (TopExp_Explorer edge(section.Shape(), TopAbs_EDGE); edge.More(); edge.Next()) {
            edges->Append(edge.Current());
        }
        ShapeAnalysis_FreeBounds::ConnectEdgesToWires(edges, same_point_mm, false, wires);
        const double seconds = processor_time_s() - start_s;
        GProp_GProps length;
        BRepGProp::LinearProperties(section.Shape(), length);
        return Section{seconds, static_cast<std::size_t>(wires->Length()), length.Mass()};
    } catch (const Standard_Failure&) {
        return std::nullopt;
    }
}

struct Surfaces::Faces {
    struct Face {
        Handle(Geom_Surface) surface;
        Handle(ShapeAnalysis_Surface) projector;
        Bnd_Box box;
    };
    std::vector<Face> faces;
};

Surfaces::Surfaces(std::shared_ptr<const Faces> faces) : faces_(std::move(faces)) {}

std::optional<Surfaces> Surfaces::read(const std::string& path) {
    // Around a face's box; what lies farther off than this is no question of a tolerance.
    constexpr double margin_mm = 0.05;
    const auto shape = shape_of(path);
    if (!shape || shape->IsNull()) return std::nullopt;
    auto faces = std::make_shared<Faces>();
    for (TopExp_Explorer face(*shape, TopAbs_FACE); face.More(); face.Next()) {
        Bnd_Box box;
        BRepBndLib::Add(face.Current(), box, false);
        box.Enlarge(margin_mm);
        const Handle(Geom_Surface) surface = BRep_Tool::Surface(TopoDS::Face(face.Current()));
        faces->faces.push_back({surface, new ShapeAnalysis_Surface(surface), box});
    }
    return Surfaces(std::move(faces));
}

double Surfaces::distance_mm(double x_mm, double y_mm, double z_mm, double enough_mm) const {
    const gp_Pnt point(x_mm, y_mm, z_mm);
    double least = std::numeric_limits<double>::infinity();
    for (const Faces::Face& face : faces_->faces) {
        if (face.box.IsOut(point)) continue;
        const gp_Pnt2d foot = face.projector->ValueOfUV(point, Precision::Confusion());
        least = std::min(least, face.projector->Value(foot).Distance(point));
    }
    if (least <= enough_mm) return least;
    for (const Faces::Face& face : faces_->faces) {
        if (face.box.IsOut(point)) continue;
        const GeomAPI_ProjectPointOnSurf all(point, face.surface);
        if (all.NbPoints() > 0) least = std::min(least, all.LowerDistance());
    }
    return least;
}

}  // namespace lyr::bench::occt
