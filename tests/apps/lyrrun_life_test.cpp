// lyrrun from the outside: scripts, and going on with a print that was cut off.

#include "apps/program.h"
#include "target/run/print_files.h"

using namespace lyr;
using namespace lyr::tests;

TEST_CASE("lyrrun: a script pauses a simulation and lets it go on, and its path is the same") {
    const Folder folder("lyrrun_life");
    const std::string file = write_print("script", {draw_square, draw_arcs, draw_hatch});
    folder.write("go.txt", "3 pause # for lunch\n40 resume\n");
    folder.write("stay.txt", "3 pause\n");
    folder.write("end.txt", "3 cancel\n");
    folder.write("bad.txt", "3 pause\n4 pasue\n");
    const std::string simulate = "lyrrun " + file + " --no-heat --simulate";
    const Ended plain = folder.run(simulate);
    const Ended paused = folder.run(simulate + " --script go.txt");
    CHECK(paused.status == 0);
    CHECK(paused.out.find(" of pauses") != std::string::npos);
    CHECK(paused.out.find("within half a microstep everywhere") != std::string::npos);
    // The axes' rows and what follows.
    CHECK(paused.out.substr(paused.out.find("  axis")) ==
          plain.out.substr(plain.out.find("  axis")));
    check_failure(folder.run(simulate + " --script stay.txt"), "lyrrun", 8, "the print rests");
    check_failure(folder.run(simulate + " --script end.txt"), "lyrrun", 8, "cancelled");
    check_failure(folder.run(simulate + " --script bad.txt"), "lyrrun", 3, "bad.txt:2");
    check_failure(folder.run("lyrrun " + file + " --script go.txt"), "lyrrun", 2, "--simulate");
}

TEST_CASE("lyrrun: without a journal there is nothing to resume") {
    const Folder folder("lyrrun_life");
    const std::string file = write_print("no_journal", {draw_square});
    std::filesystem::remove(file + ".journal");
    for (const char* option : {" --resumable", " --resume --simulate"})
        check_failure(folder.run("lyrrun " + file + option), "lyrrun", 3, "nothing to resume");
    check_failure(folder.run("lyrrun " + file + " --resume --resumable"), "lyrrun", 2,
                  "--resumable");
}
