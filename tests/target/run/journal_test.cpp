// Contract of target/run/journal.h, by number: the file is cut and changed at every byte.

#include "target/run/journal.h"

#include <doctest/doctest.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "scratch.h"
#include "target/run/full_disk.h"

using namespace lyr;
using namespace lyr::run;

namespace {

// A file in memory: tens of thousands of versions of it are read.
struct Memory {
    int descriptor = ::memfd_create("journal", 0);
    std::string path = "/proc/self/fd/" + std::to_string(descriptor);

    ~Memory() { ::close(descriptor); }
    std::string bytes() const {
        std::string text(static_cast<std::size_t>(::lseek(descriptor, 0, SEEK_END)), '\0');
        CHECK(::pread(descriptor, text.data(), text.size(), 0) ==
              static_cast<ssize_t>(text.size()));
        return text;
    }
    void put(const std::string& bytes) const {
        const bool put = ::ftruncate(descriptor, 0) == 0 &&
                         ::pwrite(descriptor, bytes.data(), bytes.size(), 0) ==
                             static_cast<ssize_t>(bytes.size());
        if (!put) FAIL("no memory");
    }
    // None: no entry that is whole, which is told but of an empty file.
    std::optional<JournalEntry> read() const {
        const auto entry = read_journal(path);
        return entry ? *entry : std::nullopt;
    }
    std::string why_none() const {
        const auto entry = read_journal(path);
        return entry ? "" : entry.error().message;
    }
};

struct Bench {
    std::string path = lyr::tests::scratch("journal");

    Bench() { std::filesystem::remove(path); }
    ~Bench() { std::filesystem::remove(path); }
    std::optional<JournalEntry> read() const {
        const auto entry = read_journal(path);
        REQUIRE(entry.ok());
        return *entry;
    }
};

JournalEntry entry_of(std::uint32_t layer) {
    JournalEntry entry;
    entry.file = {1'234'567'890'123, 0xdeadbeef};
    entry.printer = identity_of(config::generic_printer());
    entry.layer = layer;
    entry.layers = 400;
    entry.time_ns = layer * 7'000'000'000;
    entry.drawn_back_um = layer % 2 == 0 ? 2'800 : -50;
    entry.is_unloaded = layer % 5 == 0;
    if (layer % 3 == 0) entry.rest_nm = 40'000'000 + layer;
    if (layer % 3 == 1) entry.place_um = {-12'345 - static_cast<std::int32_t>(layer), 250'000};
    return entry;
}

// The files after each of so many entries.
std::vector<std::string> states_of(const Memory& bench, std::uint32_t count) {
    std::vector<std::string> states;
    Result<Journal> journal = Journal::open(bench.path);
    REQUIRE(journal.ok());
    for (std::uint32_t i = 0; i < count; ++i) {
        REQUIRE(journal->write(entry_of(i)).ok());
        states.push_back(bench.bytes());
    }
    return states;
}

}  // namespace

TEST_CASE("journal 1: what was written last is read, before and after it was opened again") {
    const Bench bench;
    CHECK_FALSE(bench.read());
    for (std::uint32_t i = 0; i < 12; ++i) {
        Result<Journal> journal = Journal::open(bench.path);
        REQUIRE(journal.ok());
        REQUIRE(journal->write(entry_of(i)).ok());
        CHECK(bench.read() == entry_of(i));
        REQUIRE(journal->write(entry_of(i + 100)).ok());
        CHECK(bench.read() == entry_of(i + 100));
    }
    Result<Journal> journal = Journal::open(bench.path);
    REQUIRE(journal.ok());
    journal->remove();
    CHECK_FALSE(std::filesystem::exists(bench.path));
    CHECK_FALSE(bench.read());
}

TEST_CASE("journal 1: a write that is cut at any byte leaves the entry before it, or is whole") {
    const Memory bench;
    const std::vector<std::string> states = states_of(bench, 8);
    for (std::uint32_t i = 1; i < states.size(); ++i) {
        const std::string &before = states[i - 1], &after = states[i];
        std::size_t wrong = 0, old = 0, silent = 0;
        for (std::size_t cut = 0; cut <= after.size(); ++cut) {
            // The bytes before the cut are new, those behind it old, or not there yet.
            std::string torn = after.substr(0, cut);
            if (cut < before.size()) torn += before.substr(cut);
            bench.put(torn);
            const std::optional<JournalEntry> read = bench.read();
            wrong += read != entry_of(i) && read != entry_of(i - 1);
            old += read == entry_of(i - 1);
            silent += torn != before && torn != after && !has_damage(bench.path);
        }
        CHECK(wrong == 0);
        CHECK(old > 0);
        CHECK(silent == 0);
        bench.put(after);
        CHECK_FALSE(has_damage(bench.path));
    }
}

TEST_CASE("journal 1: a file that ends at any byte has an entry that is whole, or none") {
    const Memory bench;
    const std::string whole = states_of(bench, 5).back();
    std::size_t wrong = 0, none = 0;
    for (std::size_t length = 0; length <= whole.size(); ++length) {
        bench.put(whole.substr(0, length));
        const std::optional<JournalEntry> read = bench.read();
        none += !read;
        wrong += read && read != entry_of(4) && read != entry_of(3);
    }
    CHECK(wrong == 0);
    // The first slot has 88 bytes.
    CHECK(none == 88);
}

TEST_CASE("journal 1: any byte that is changed loses its entry and makes no other of it") {
    for (const std::uint32_t count : {5u, 6u}) {
        const Memory bench;
        const std::string whole = states_of(bench, count).back();
        std::size_t wrong = 0, lost = 0, damaged = 0;
        for (std::size_t at = 0; at < whole.size(); ++at)
            for (const int change : {0x01, 0x80, 0xff}) {
                std::string changed = whole;
                changed[at] = static_cast<char>(changed[at] ^ change);
                bench.put(changed);
                const std::optional<JournalEntry> read = bench.read();
                lost += read == entry_of(count - 2);
                damaged += has_damage(bench.path);
                wrong += read != entry_of(count - 1) && read != entry_of(count - 2);
            }
        CHECK(wrong == 0);
        CHECK(lost == 3 * 88);
        CHECK(damaged == 2 * 3 * 88);
    }
}

TEST_CASE("journal 1: a file of something else is no journal, and what cannot be read is told") {
    const Memory bench;
    bench.put(std::string(10'000, 'x'));
    CHECK_FALSE(bench.read());
    CHECK(bench.why_none().find("damaged") != std::string::npos);
    const auto folder = read_journal("/proc/self/mem/x");
    REQUIRE_FALSE(folder.ok());
    CHECK(folder.error().status == ExitStatus::input);
    const Result<Journal> refused = Journal::open("/nonexistent/folder/journal");
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.error().status == ExitStatus::output);
    CHECK(to_string(refused.error()).find("/nonexistent/folder/journal") != std::string::npos);
}

TEST_CASE("journal 1: a journal of another version was no journal, or read as one of this") {
    const Memory bench;
    // As written before there were printers in it: both slots, and the first one alone.
    const std::string old = "LYRJRNL1" + std::string(52, '\x07');
    const std::string both = old + std::string(4096 - old.size(), '\0') + old;
    for (const std::string& bytes : {both, old, std::string(4096, '\0') + old}) {
        bench.put(bytes);
        CHECK_FALSE(bench.read());
        CHECK(bench.why_none() == "the journal was written by another version of lyrrun");
    }
    // Whatever else a later version has in it.
    bench.put("LYRJRNL3" + std::string(100'000, 'x'));
    CHECK(bench.why_none() == "the journal was written by another version of lyrrun");
    // A print that begins anew goes on after it, from its first entry.
    bench.put(both);
    CHECK(Journal::open(bench.path).ok());
    CHECK(bench.bytes() == both);
    Result<Journal> journal = Journal::open(bench.path);
    REQUIRE(journal.ok());
    for (std::uint32_t i = 0; i < 3; ++i) {
        REQUIRE(journal->write(entry_of(i)).ok());
        CHECK(bench.read() == entry_of(i));
    }
}

TEST_CASE("journal 1: a journal that is damaged in both slots was told as none") {
    const Memory bench;
    const std::string whole = states_of(bench, 4).back();
    std::string torn = whole;
    torn[50] ^= 1;
    torn[4096 + 50] ^= 1;
    for (const std::string& bytes : {torn, whole.substr(0, 20), std::string(5'000, '\0')}) {
        bench.put(bytes);
        CHECK_FALSE(bench.read());
        CHECK(bench.why_none().find("damaged") != std::string::npos);
    }
    // The power failed when it was made.
    bench.put("");
    CHECK_FALSE(bench.read());
    CHECK(bench.why_none().empty());
}

TEST_CASE("journal: two printers that printed the same file wrote into one journal") {
    const Bench bench;
    {
        Result<Journal> first = Journal::open(bench.path);
        REQUIRE(first.ok());
        REQUIRE(first->write(entry_of(5)).ok());
        const Result<Journal> second = Journal::open(bench.path);
        REQUIRE(!second.ok());
        CHECK(second.error().message.find("another print of this file") != std::string::npos);
        CHECK(bench.read() == entry_of(5));
    }
    CHECK(Journal::open(bench.path).ok());
    CHECK(bench.read() == entry_of(5));
}

TEST_CASE("journal 2, 3: a full disk is told once, from either side") {
    const Bench bench;
    Result<Journal> full = Journal::open(bench.path);
    REQUIRE(full.ok());
    const tests::FullDisk disk;
    const Status written = full->write(entry_of(1));
    REQUIRE_FALSE(written.ok());
    CHECK(written.error().status == ExitStatus::output);
    CHECK(written.error().message.find("cannot write the journal: File too large") !=
          std::string::npos);
    JournalWriter writer(std::move(*full));
    std::optional<Diagnostic> told;
    for (std::uint32_t i = 0; i < 200 && !told; ++i) {
        writer.post(entry_of(i));
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        told = writer.take_error();
    }
    REQUIRE(told);
    writer.post(entry_of(9));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    CHECK_FALSE(writer.take_error());
}

TEST_CASE(
    "journal 3: the writer's last entry is on the disk when it has ended; nothing after remove()") {
    const Bench bench;
    {
        JournalWriter writer(*Journal::open(bench.path));
        for (std::uint32_t i = 0; i < 50; ++i) writer.post(entry_of(i));
    }
    CHECK(bench.read() == entry_of(49));
    {
        JournalWriter writer(*Journal::open(bench.path));
        writer.post(entry_of(50));
        writer.remove();
    }
    CHECK_FALSE(std::filesystem::exists(bench.path));
}

TEST_CASE("journal 4: files differ by length and by any byte") {
    const Memory bench;
    const auto identity = [&](const std::string& bytes) {
        bench.put(bytes);
        const auto found = identity_of(bench.path);
        REQUIRE(found.ok());
        return *found;
    };
    const std::string text(200'000, 'a');
    const FileIdentity whole = identity(text);
    CHECK(whole == identity(text));
    CHECK(whole.bytes == text.size());
    CHECK_FALSE(whole == identity(text + 'a'));
    for (const std::size_t at : {0u, 65'535u, 65'536u, 199'999u}) {
        std::string changed = text;
        changed[at] = 'b';
        CHECK_FALSE(whole == identity(changed));
    }
    CHECK_FALSE(identity_of("/nonexistent").ok());
}

namespace {

constexpr int may_not_mount = 77;

// In a process of its own, which sees a disk of one page, and that full. 0: as it should be.
int open_on_full_disk(const std::string& folder) {
    if (::unshare(CLONE_NEWNS) != 0 && ::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0)
        return may_not_mount;
    if (::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
        ::mount("tmpfs", folder.c_str(), "tmpfs", 0, "size=4k") != 0)
        return may_not_mount;
    std::ofstream(folder + "/filled") << std::string(4096, 'x');
    const std::string path = folder + "/print.lyr.journal";
    const Result<Journal> journal = Journal::open(path);
    if (journal) return 1;
    if (journal.error().message.find("No space left on device") == std::string::npos) return 2;
    return std::filesystem::exists(path) ? 3 : 0;
}

}  // namespace

TEST_CASE("journal: that a disk is full is known before anything moves, and no file is left") {
    const std::filesystem::path folder = lyr::tests::scratch_folder("full_disk");
    const pid_t child = ::fork();
    if (child == 0) ::_exit(open_on_full_disk(folder));
    int status = 0;
    REQUIRE(::waitpid(child, &status, 0) == child);
    REQUIRE(WIFEXITED(status));
    if (WEXITSTATUS(status) == may_not_mount)
        MESSAGE("not run: nobody may mount a disk here");
    else
        CHECK(WEXITSTATUS(status) == 0);
}
