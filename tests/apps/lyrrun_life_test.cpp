// lyrrun from the outside: scripts, and going on with a print that was cut off.

#include "apps/program.h"
#include "apps/with_print.h"
#include "target/run/cut_off.h"
#include "target/run/print_files.h"

using namespace lyr;
using namespace lyr::tests;

namespace {

void draw_millimetre(const Pen& pen) {
    pen.path();
    pen.line(1, 0);
}

// A printer, p.toml, and a print on it that was cut off in its second layer.
struct CutOff {
    Folder folder;
    std::string file, journal;

    explicit CutOff(const std::string& name, const run::JournalEntry& what = {})
        : folder("lyrrun_" + name),
          file(write_print(name, std::vector<Drawing>(3, draw_millimetre))),
          journal(file + ".journal") {
        folder.write("p.toml", printer());
        fs::remove(journal);
        cut(what);
    }
    ~CutOff() { fs::remove(journal); }

    static std::string printer(const std::string& more = "") {
        return more + text_of(fs::path(LYR_FIXTURES) / "printers/cartesian.toml");
    }
    void cut(run::JournalEntry entry) const {
        entry.layer = 2;
        write_journal(*config::read_printer(folder / "p.toml"), file, entry);
    }
    Ended lyrrun(const std::string& options) const {
        return folder.run("lyrrun " + file + " --printer p.toml " + options);
    }
};

}  // namespace

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

TEST_CASE("lyrrun: a print that was cut off was resumed with any other printer's file") {
    const CutOff print("other_printer");
    const Ended found = print.lyrrun("--resumable");
    CHECK(found.status == 0);
    CHECK(found.out.find("layer 2 of 6, 5 s into the print") != std::string::npos);
    const auto with = [&](const std::string& change) {
        print.folder.write("p.toml", CutOff::printer());
        CHECK(print.folder.run("sed -i '" + change + "' p.toml").status == 0);
        CHECK(text_of(print.folder / "p.toml") != CutOff::printer());
    };
    with("s/^max_speed_mm_s.*/max_speed_mm_s = 9/");
    CHECK(print.lyrrun("--resumable").status == 0);
    with("0,/^steps_per_mm.*/s//steps_per_mm = 160/");
    for (const char* option : {"--resumable", "--resume", "--resume --simulate --no-heat"})
        check_failure(print.lyrrun(option), "lyrrun", 3, "other steps_per_mm; resume it with");
    with("s/^name.*/name = \"neighbour\"/");
    check_failure(print.lyrrun("--resumable"), "lyrrun", 3, "other name; resume it with");
}

TEST_CASE("lyrrun: a print took away the journal of another printer's print of the same file") {
    const CutOff print("neighbour");
    const std::string before = text_of(print.journal);
    print.folder.write("p.toml", CutOff::printer());
    CHECK(print.folder.run("sed -i 's/^name.*/name = \"neighbour\"/' p.toml").status == 0);
    // There are no such lines here; what the print is without is told before it looks for them.
    const Ended ended = print.lyrrun("--no-heat");
    CHECK(ended.status != 0);
    CHECK(ended.err.find("another printer (other name) and stays") != std::string::npos);
    CHECK(text_of(print.journal) == before);
}

TEST_CASE("lyrrun: a journal that is damaged, empty or of another version was told as none") {
    const CutOff print("damaged");
    const auto says = [&](const std::string& bytes, const std::string& what) {
        std::ofstream(print.journal, std::ios::binary) << bytes;
        for (const char* option : {"--resumable", "--resume --simulate --no-heat"})
            check_failure(print.lyrrun(option), "lyrrun", 3, what);
    };
    std::string bytes = text_of(print.journal);
    bytes[4096 + 30] ^= 1;
    says(bytes, "the journal is damaged");
    says("", "nothing in it");
    says("LYRJRNL1" + std::string(52, '\x07'), "written by another version of lyrrun");
}

TEST_CASE("lyrrun: a dry run said that it forgot where a print was cut off, and did not") {
    const CutOff print("dry");
    const std::string before = text_of(print.journal);
    const auto written = fs::last_write_time(print.journal);
    // Somebody prints it meanwhile.
    const Result<run::Journal> held = run::Journal::open(print.journal);
    for (const char* option : {"", "--resume "}) {
        const Ended ended = print.lyrrun(std::string("--dry-run --no-heat --socket s ") + option);
        CAPTURE(option);
        CHECK(ended.status == 0);
        CHECK(ended.err.find("begins anew") == std::string::npos);
        CHECK(text_of(print.journal) == before);
        CHECK(fs::last_write_time(print.journal) == written);
    }
}

TEST_CASE("lyrrun: a print that was refused beside one under way said that it forgets that") {
    const CutOff print("beside");
    const Result<run::Journal> held = run::Journal::open(print.journal);
    const Ended ended = print.lyrrun("--no-heat --socket s");
    CHECK(ended.err.find("begins anew") == std::string::npos);
    CHECK(ended.err.find("another print of this file keeps the journal") != std::string::npos);
    CHECK(ended.err.find("remove it") == std::string::npos);
    CHECK(run::find_resumption(*config::read_printer(print.folder / "p.toml"), print.file).ok());
}

TEST_CASE("lyrrun: the head was moved away from where a print that was cut off had left it") {
    const CutOff print("moved");
    const auto with = [&](const std::string& change) {
        print.folder.write("p.toml", CutOff::printer("recovery.folder = \".\"\n"));
        CHECK(print.folder.run("sed -i '" + change + "' p.toml").status == 0);
        fs::copy_file(print.journal, print.folder / "a.lyr.journal",
                      fs::copy_options::overwrite_existing);
    };
    const auto move = [&](const std::string& options) {
        return print.folder.run("lyrrun --printer p.toml " + options);
    };
    // There are no such lines here, which is what all else fails by.
    const char* rests = "a print was cut off";
    with("");
    for (const char* moves : {"--home", "--home x", "--jog x=1", "--jog z=1", "--calibrate mesh"})
        check_failure(move(moves), "lyrrun", 3, rests);
    CHECK(move("--jog e=1").err.find("cut off") == std::string::npos);
    CHECK(move("--home --simulate").status == 0);
    {
        const Result<run::Journal> held = run::Journal::open(print.folder / "a.lyr.journal");
        check_failure(move("--home"), "lyrrun", 3, "a print is under way on this printer");
    }
    const Ended other = print.lyrrun("--no-heat --socket s");
    CHECK(other.err.find("./a.lyr.journal: warning: a print was cut off") != std::string::npos);
    CHECK(fs::exists(print.folder / "a.lyr.journal"));
    // Without endstops nothing moves but what is asked for.
    with("/^endstop/d");
    check_failure(move("--jog x=1,z=-1"), "lyrrun", 3, rests);
    CHECK(move("--jog x=1").err.find("cut off") == std::string::npos);
    with("s/^name.*/name = \"neighbour\"/");
    CHECK(move("--home").err.find("cut off") == std::string::npos);
    // A delta finds its height again.
    const std::string delta = text_of(fs::path(LYR_FIXTURES) / "printers/delta.toml");
    print.folder.write("p.toml", delta);
    print.cut({});
    with("");
    print.folder.write("p.toml", "recovery.folder = \".\"\n" + delta);
    CHECK(move("--home").err.find("cut off") == std::string::npos);
    print.folder.write("p.toml", "recovery.folder = \".\"\nhoming.before_print = false\n" + delta);
    check_failure(move("--home"), "lyrrun", 3, rests);
}

TEST_CASE("lyrrun: a print resumes with the next filament after it was cut off without") {
    run::JournalEntry out;
    out.is_unloaded = true;
    out.rest_nm = 7'000'000;
    const CutOff print("unloaded", out);
    CHECK(print.lyrrun("--resumable").out.find("at rest, the filament drawn out") !=
          std::string::npos);
    print.folder.write("go.txt", "100 resume\n");
    const std::string options = "--resume --simulate --no-heat";
    check_failure(print.lyrrun(options), "lyrrun", 8, "the print rests");
    CHECK(print.lyrrun(options + " --script go.txt").status == 0);
}

TEST_CASE("lyrrun: that recovery.folder is missing was not found by --check") {
    const CutOff print("no_folder");
    print.folder.write("p.toml", CutOff::printer("recovery.folder = \"missing\"\n"));
    const Ended checked = print.folder.run("lyrrun --check --printer p.toml");
    CHECK(checked.out.find("warning  recovery.folder: missing is no folder") != std::string::npos);
    const Ended ended = print.lyrrun("--no-heat");
    const std::size_t told = ended.err.find("cannot write the journal: No such file or directory");
    REQUIRE(told != std::string::npos);
    CHECK(told < ended.err.find("GPIO"));
    fs::create_directory(print.folder / "missing");
    CHECK(print.folder.run("lyrrun --check --printer p.toml")
              .out.find("ok       recovery.folder: missing is there") != std::string::npos);
}

TEST_CASE(
    "lyrrun --simulate: what a script could not have was forgotten where it ended the print") {
    const Folder folder = with_print("notes");
    folder.write("script", "0.1 set tool 900\n0.2 cancel\n");
    const Ended ended = folder.run("lyrrun a.lyr --simulate --no-heat --script script");
    CHECK(ended.status == 8);
    CHECK(ended.err.find("refused `set tool 900`") != std::string::npos);
    CHECK(ended.err.find("cancelled") != std::string::npos);
    CHECK(lines_in(ended.err) == 2);
}
