// Both readers give out the same of real prints.

#include "apps/program.h"
#include "format/c_reader.h"
#include "format/check/verify.h"

using namespace lyr;
using namespace lyr::tests;

TEST_CASE("C reader 3: the same operations as in C++, for prints of real parts") {
    const Folder folder("stepc-readers");
    for (const char* part : {"cuboid", "gearbox_base", "lower_teeth"}) {
        CAPTURE(part);
        folder.copy("parts/" + std::string(part) + ".step", "p.step");
        const Ended sliced = folder.run(
            "stepc p.step -o p.lyr --layer-height 0.3 --set perimeters.count=3 && rm p.step");
        REQUIRE_MESSAGE(sliced.status == 0, sliced.err);
        const std::string print = text_of(folder / "p.lyr");
        const auto bytes = std::as_bytes(std::span(print.data(), print.size()));
        const std::string path = folder / "p.lyr";
        CHECK(format::test::difference(bytes, format::Reader::open(path)) == "");
        CHECK(format::verify(bytes).findings.empty());
    }
}
