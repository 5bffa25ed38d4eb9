// lyrview --verify, --repair and --diff as users run them.

#include "apps/with_print.h"

using namespace lyr;
using namespace lyr::tests;

namespace {

// A whole print a.lyr of three layers, and b.lyr with a wrong byte in the second one.
Folder with_prints(const std::string& name) {
    Folder folder = with_print(name);
    std::string damaged = text_of(folder / "a.lyr");
    std::size_t at = 16;
    for (int block = 0, layers = 0; layers < 2; ++block) {
        layers += damaged[at] == 2;
        const auto length = [&](std::size_t i) {
            return std::size_t{static_cast<unsigned char>(damaged[at + i])};
        };
        if (layers < 2) at += 8 + length(1) + (length(2) << 8) + (length(3) << 16);
    }
    damaged[at + 10] = static_cast<char>(damaged[at + 10] ^ 1);
    folder.write("b.lyr", damaged);
    return folder;
}

}  // namespace

TEST_CASE("lyrview --verify: a whole print, a damaged one, one that is cut, and what is none") {
    const Folder folder = with_prints("lyrview-verify");
    const Ended whole = folder.run("lyrview --verify a.lyr");
    CHECK(whole.status == 0);
    CHECK(whole.err.empty());
    CHECK(whole.out.starts_with("a.lyr: .lyr 1."));
    CHECK(whole.out.find(", whole\n3 layers, ") != std::string::npos);
    CHECK(folder.run("lyrview --verify - < a.lyr").status == 0);
    CHECK(folder.run("cat a.lyr | lyrview - --verify").status == 0);

    const Ended damaged = folder.run("lyrview --verify b.lyr");
    CHECK(damaged.status == 3);
    CHECK(damaged.out.find("layer 2 is damaged (CRC)\nwhole: layers 1, 3 of 3\n") !=
          std::string::npos);
    CHECK(lines_in(damaged.err) == 1);
    CHECK(damaged.err.starts_with("lyrview: b.lyr: error: layer 2 is damaged (CRC) (bytes "));
    CHECK(damaged.err.find("in front of any damage is 1 (lyrview --repair") != std::string::npos);

    const Ended cut = folder.run("head -c -50 a.lyr | lyrview --verify -");
    CHECK(cut.status == 3);
    CHECK(cut.out.find("the file is cut short: ") != std::string::npos);
    CHECK(cut.err.find("in front of any damage is 3") != std::string::npos);

    folder.write("c.lyr", "solid ascii\n");
    CHECK(folder.run("lyrview --verify c.lyr").status == 3);
    check_lyrview_failure(folder.run("lyrview --verify missing.lyr"), 3, "missing.lyr");
}

TEST_CASE("lyrview: a file whose name says png, G-code or the like is not given something else") {
    const Folder folder = with_prints("lyrview-endings");
    const auto before = folder.files();
    for (const char* name : {"a.png", "a.svg.gz", "a.pdf"})
        check_lyrview_failure(folder.run("lyrview a.lyr --layer 1 -o " + std::string(name)), 2,
                              "--to FORMAT");
    check_lyrview_failure(folder.run("lyrview b.lyr --repair -o b.gcode"), 2, "say -o FILE.lyr");
    check_lyrview_failure(folder.run("lyrview a.lyr --thumbnail -o a.SVG"), 2, "say -o FILE.png");
    CHECK(folder.files() == before);
    CHECK(folder.run("lyrview a.lyr --layer 1 --to svg -o a.svgz.part").status == 0);
    CHECK(folder.run("lyrview a.lyr --layer 1 -o picture").status == 0);
    CHECK(folder.run("lyrview a.lyr --layer 1").out.starts_with("<svg"));
}

#ifndef __SANITIZE_ADDRESS__  // which needs the address space that is bounded here
TEST_CASE("lyrview --verify, --repair: a file larger than memory is read piece by piece") {
    const Folder folder = with_prints("lyrview-verify-large");
    const std::string grow = "cp a.lyr large.lyr; truncate -s 60M large.lyr; ulimit -v 40000; ";
    const Ended verified = folder.run(grow + "lyrview --verify large.lyr");
    CHECK(verified.status == 3);
    CHECK(
        verified.out.find("something follows the end of the print\nwhole: layers 1 to 3 of 3\n") !=
        std::string::npos);
    CHECK(folder.run(grow + "lyrview --repair large.lyr -o whole.lyr").status == 0);
    CHECK(text_of(folder / "whole.lyr") == text_of(folder / "a.lyr"));
}
#endif

TEST_CASE("lyrview --repair: the layers in front of the damage, said and whole") {
    const Folder folder = with_prints("lyrview-repair");
    const std::string before = text_of(folder / "b.lyr");
    const Ended repaired = folder.run("lyrview --repair b.lyr -o c.lyr");
    CHECK(repaired.status == 0);
    CHECK(repaired.err.empty());
    CHECK(repaired.out.find("layer 1 is kept, of 3; left out behind the damage: 1 whole layer\n"
                            "c.lyr: 1 layer, ") != std::string::npos);
    CHECK(folder.run("lyrview --verify c.lyr").status == 0);
    CHECK(text_of(folder / "b.lyr") == before);
    // A whole one comes out as it is; through pipes the words go to standard error.
    const Ended same = folder.run("lyrview --repair a.lyr -o - | cmp - a.lyr");
    CHECK(same.status == 0);
    CHECK(same.err.find("nothing is to be repaired") != std::string::npos);

    check_lyrview_failure(folder.run("lyrview --repair b.lyr"), 2, "-o FILE");
    check_lyrview_failure(folder.run("lyrview --repair b.lyr -o b.lyr"), 2, "would overwrite");
    check_lyrview_failure(folder.run("lyrview --repair b.lyr -o missing/c.lyr"), 6,
                          "missing/c.lyr");
    check_lyrview_failure(folder.run("head -c 100 a.lyr | lyrview --repair - -o d.lyr"), 3,
                          "nothing to keep");
    CHECK_FALSE(fs::exists(folder / "d.lyr"));
}

TEST_CASE(
    "lyrview --repair: a whole print with times finer than it states comes out byte for byte") {
    const Folder folder("lyrview-repair-times");
    fs::copy_file(write_print("lyrview-repair-times", {draw_square, draw_arcs, draw_hatch}, {},
                              [](format::LayerState& state) { state.estimated_time_s = 0.0014; }),
                  folder / "a.lyr");
    const Ended same = folder.run("lyrview --repair a.lyr -o b.lyr && cmp a.lyr b.lyr");
    CHECK(same.status == 0);
    CHECK(same.out.find("nothing is to be repaired\nb.lyr: 3 layers, ") != std::string::npos);
}

TEST_CASE("lyrview: an endless input that is no print, or no G-code, is refused") {
    const Folder folder("lyrview-endless");
    for (const char* what : {"--verify", "--repair -o x.lyr", "-o x.html", "--info"})
        for (const char* command : {"lyrview /dev/zero ", "cat /dev/zero | lyrview - "}) {
            CAPTURE(what);
            check_lyrview_failure(folder.run(command + std::string(what)), 3,
                                  "this is not a .lyr file");
        }
    check_lyrview_failure(folder.run("lyrview --from-gcode /dev/zero -o x.lyr"), 3, "longer than ");
    CHECK(folder.files().empty());
}

TEST_CASE("lyrview --verify: a print whose first byte is damaged is still one") {
    const Folder folder = with_prints("lyrview-verify-magic");
    std::string damaged = text_of(folder / "a.lyr");
    damaged[0] = 'l';
    folder.write("c.lyr", damaged);
    check_lyrview_failure(folder.run("lyrview --verify c.lyr > out"), 3, "the prologue is damaged");
}

TEST_CASE("lyrview --diff: 0 for the same, 9 for others, 3 for what cannot be read") {
    const Folder folder = with_prints("lyrview-diff");
    const Ended same = folder.run("cp a.lyr c.lyr; lyrview --diff a.lyr c.lyr");
    CHECK(same.status == 0);
    CHECK(same.out.empty());
    CHECK(same.err.empty());
    CHECK(folder.run("lyrview --repair b.lyr -o c.lyr").status == 0);
    const Ended differ = folder.run("lyrview --diff a.lyr c.lyr");
    CHECK(differ.status == 9);
    CHECK(differ.out.starts_with("a.lyr  ->  c.lyr\n3 layers, 1 layer; 1 the same\n"));
    CHECK(differ.out.find("): only in the first\n") != std::string::npos);
    CHECK(differ.err.starts_with("lyrview: note: the prints differ: 2 layers, "));
    check_lyrview_failure(folder.run("lyrview --diff a.lyr b.lyr"), 3, "b.lyr");
    check_lyrview_failure(folder.run("lyrview --diff b.lyr a.lyr"), 3, "b.lyr");
    check_lyrview_failure(folder.run("lyrview --diff a.lyr - < a.lyr"), 2, "twice");
    check_lyrview_failure(folder.run("lyrview --diff a.lyr"), 2, "print");
    check_lyrview_failure(folder.run("lyrview --diff a.lyr a.lyr --verify"), 2, "stand alone");
    check_lyrview_failure(folder.run("lyrview a.lyr --verify --layer 1"), 2, "stand alone");
    check_lyrview_failure(folder.run("lyrview a.lyr --verify -o x"), 2, "-o goes with --repair");
}

TEST_CASE("lyrview --thumbnail: a print without one is said so") {
    const Folder folder = with_prints("lyrview-thumbnail");
    check_lyrview_failure(folder.run("lyrview --thumbnail a.lyr -o a.png"), 3, "no thumbnail");
    check_lyrview_failure(folder.run("lyrview --thumbnail a.lyr -o a.lyr"), 2, "would overwrite");
    check_lyrview_failure(folder.run("lyrview --thumbnail a.lyr --verify"), 2, "stand alone");
    CHECK_FALSE(fs::exists(folder / "a.png"));
}
