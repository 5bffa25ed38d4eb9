#include "bench/occt.h"

#include <BRepAlgoAPI_Section.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepGProp.hxx>
#include <BRep_Builder.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPControl_Reader.hxx>
#include <ShapeAnalysis_FreeBounds.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_HSequenceOfShape.hxx>
#include <TopoDS_Compound.hxx>
#include <gp_Pln.hxx>
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

}  // namespace lyr::bench::occt
