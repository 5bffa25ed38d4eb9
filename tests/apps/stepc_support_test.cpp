// Supports as a user asks stepc for them.

#include "apps/program.h"
#include "format/reader.h"

using namespace lyr;
using namespace lyr::tests;

namespace {

// A block with a bore, which lies across.
Folder with_bore(const std::string& name) {
    Folder folder(name);
    folder.copy("parts/cube_hole.step", "p.step");
    return folder;
}

const std::string lying =
    "stepc p.step -o p.lyr --up 1,0,0 --layer-height 0.3 --set support.kind=grid ";

std::vector<format::Role> roles_of_layer(const fs::path& path, std::size_t layer) {
    std::vector<format::Role> roles;
    auto reader = format::Reader::open(path);
    REQUIRE(reader.ok());
    std::size_t layers = 0;
    for (;;) {
        const auto next = reader->next();
        REQUIRE(next.ok());
        if (!*next || layers > layer) return roles;
        if (std::holds_alternative<format::LayerStart>(**next)) ++layers;
        const auto* begin = std::get_if<format::PathStart>(&**next);
        if (begin && layers == layer && (roles.empty() || roles.back() != begin->style.role))
            roles.push_back(begin->style.role);
    }
}

}  // namespace

TEST_CASE(
    "stepc --set support.kind: the support is printed before the part, and runs on the printer") {
    const Folder folder = with_bore("stepc-support");
    const Ended printed = folder.run(lying);
    CHECK(printed.status == 0);
    CHECK(printed.out.find("support interface") != std::string::npos);
    const auto roles = roles_of_layer(folder / "p.lyr", 75);
    REQUIRE(roles.size() > 1);
    CHECK(roles.front() == format::Role::support);
    CHECK(std::count(roles.begin() + 1, roles.end(), format::Role::support) == 0);
    CHECK(folder.run("lyrrun p.lyr --simulate").status == 0);
}

TEST_CASE("stepc --set support.kind: the same bytes for any number of threads") {
    const Folder folder = with_bore("stepc-support-threads");
    for (const std::string kind : {"grid", "tree"}) {
        std::set<std::string> files;
        for (const char* threads : {"1", "2", "5"}) {
            const std::string more = "--set support.kind=" + kind + " --threads " + threads;
            CHECK(folder.run(lying + more).status == 0);
            files.insert(text_of(folder / "p.lyr"));
        }
        CHECK(files.size() == 1);
    }
}

TEST_CASE("stepc --set support.blockers: a face is named, by its #id too, or the mistake is") {
    const Folder folder = with_bore("stepc-blockers");
    const Ended wrong = folder.run(lying + "--set support.blockers=BORE");
    CHECK(wrong.status == static_cast<int>(ExitStatus::usage));
    CHECK(wrong.err.find("no face is named \"BORE\"") != std::string::npos);
    CHECK(!fs::exists(folder / "p.lyr"));
    const std::string step = text_of(folder / "p.step");
    const std::size_t cylinder = step.find("CYLINDRICAL_SURFACE");
    REQUIRE(cylinder != std::string::npos);
    // The face names its surface.
    const std::size_t line = step.rfind('#', cylinder);
    const std::string surface = step.substr(line, step.find_first_of(" =", line) - line);
    std::size_t face = std::string::npos;
    for (std::size_t at = step.find("ADVANCED_FACE"); at != std::string::npos;
         at = step.find("ADVANCED_FACE", at + 1)) {
        const std::string entity = step.substr(at, step.find(';', at) - at);
        if (entity.find(surface + ',') != std::string::npos) face = step.rfind('#', at);
    }
    REQUIRE(face != std::string::npos);
    const std::string id = step.substr(face, step.find_first_of(" =", face) - face);
    const Ended blocked = folder.run(lying + "--set 'support.blockers=" + id + "'");
    CHECK(blocked.status == 0);
    CHECK(blocked.out.find("support") == std::string::npos);
}
