// What repair() writes is a print that is whole, and what it keeps is what it was.

#include "format/check/repair.h"

#include <doctest/doctest.h>

#include "format/sample.h"
#include "tests_of_check.h"

using namespace lyr;
using namespace lyr::format;
using namespace lyr::format::test;

namespace {

const std::string output = scratch("repaired");

Result<Repaired> repaired(const FileBytes& file) {
    FileView view(file);
    return repair(view, verify(file), "broken.lyr", output);
}

// The operations of the layers in front of one (from 0).
std::vector<Operation> operations_before(const Reading& reading, std::uint32_t layer) {
    std::vector<Operation> all;
    for (const Given& given : reading.given) {
        const auto* start = std::get_if<LayerStart>(&given.operation);
        if (start && start->index == layer) break;
        all.push_back(given.operation);
    }
    return all;
}

}  // namespace

TEST_CASE("repair 3: a whole file comes out as it is") {
    const FileBytes file = small_file();
    const auto done = repaired(file);
    REQUIRE(done.ok());
    CHECK(done->notes.empty());
    CHECK(load(output) == file);
    std::vector<EncodedLayer> layers;
    for (std::uint32_t seed = 1; seed < 4; ++seed) {
        auto layer = RandomLayer(seed, 0.2 * seed, Quantum{1000}, 30000).finish();
        REQUIRE(layer.ok());
        layers.push_back(*layer);
    }
    Metadata metadata;
    metadata.filament_density_g_cm3 = 1.24;
    metadata.extra.push_back({"note", "two\nlines"});
    const std::string path = scratch("to_repair");
    write_layers(path, Quantum{1000}, metadata, layers);
    REQUIRE(repaired(load(path)).ok());
    CHECK(load(output) == load(path));
}

TEST_CASE("repair 1 and 2: the layers in front of the damage, operation by operation") {
    const FileBytes file = small_file();
    const Reading whole = read_bytes(file);
    const double whole_mm3 = open_bytes(file)->header().summary.volume_mm3;
    for (const Extent& block : extents(file)) {
        if (block.begin == 0) continue;
        INFO(block.name);
        FileBytes damaged = file;
        damaged[block.begin + 5] ^= std::byte{16};
        const auto done = repaired(damaged);
        const std::uint32_t kept =
            block.layer > 0 ? static_cast<std::uint32_t>(block.layer) - 1 : 3;
        CHECK(done.ok() == (kept > 0));
        if (!done) {
            CHECK(done.error().status == ExitStatus::input);
            continue;
        }
        CHECK(done->totals.layers == kept);
        REQUIRE(!done->notes.empty());
        const FileBytes bytes = load(output);
        CHECK(verify(bytes).findings.empty());
        const Reading reading = read_bytes(bytes);
        REQUIRE(!reading.error);
        CHECK(operations_before(reading, kept) == operations_before(whole, kept));
        CHECK(reading.given.size() == operations_before(whole, kept).size());
        const auto opened = open_bytes(bytes);
        CHECK(opened->header().summary.layers == kept);
        CHECK(opened->header().summary.volume_mm3 ==
              doctest::Approx(whole_mm3 * kept / 3).epsilon(1e-6));
        CHECK(opened->header().metadata.source_name ==
              (block.name == "the metadata" ? "" : "part.step"));
        CHECK(opened->header().metadata.configuration.empty() ==
              (block.name == "the metadata" || block.name == "the configuration"));
    }
}

TEST_CASE("repair 4: what is left out is said") {
    const FileBytes file = small_file();
    const std::vector<Extent> blocks = extents(file);
    FileBytes damaged = file;
    damaged[blocks[6].begin + 5] ^= std::byte{1};  // layer 2
    damaged[blocks[1].begin + 5] ^= std::byte{1};  // the metadata
    const auto done = repaired(damaged);
    REQUIRE(done.ok());
    REQUIRE(done->notes.size() == 2);
    CHECK(done->notes[0] == "layer 1 is kept, of 3; left out behind the damage: 1 whole layer");
    CHECK(done->notes[1].starts_with("the metadata was damaged"));
}

TEST_CASE("repair: wherever the file is cut, the layers in front are kept") {
    const FileBytes file = small_file();
    for (std::size_t size = 0; size < file.size(); size += 7) {
        const FileBytes cut(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size));
        const std::uint32_t whole = verify(cut).whole_from_start;
        const auto done = repaired(cut);
        INFO("cut at byte " << size);
        CHECK(done.ok() == (whole > 0));
        if (done.ok()) CHECK(done->totals.layers == whole);
    }
}

TEST_CASE("repair: without the unit of the coordinates nothing is written") {
    FileBytes damaged = small_file();
    damaged[9] ^= std::byte{1};
    std::filesystem::remove(output);
    const auto done = repaired(damaged);
    REQUIRE(!done.ok());
    CHECK(done.error().message.find("prologue is damaged") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(output));
}
