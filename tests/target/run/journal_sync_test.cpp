// That what journal.h (2) says to be on the disk was sent there: the calls are counted, and made to fail.

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <filesystem>

#include "scratch.h"
#include "target/gpio/mock_chip.h"
#include "target/run/cut_off.h"
#include "target/run/patient_printer.h"
#include "target/run/print.h"
#include "target/run/print_files.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

int syncs = 0, name_syncs = 0;
bool sync_fails = false, write_is_refused = false;

}  // namespace

extern "C" int fdatasync(int descriptor) {
    ++syncs;
    if (sync_fails) {
        errno = EIO;
        return -1;
    }
    return static_cast<int>(::syscall(SYS_fdatasync, descriptor));
}

extern "C" int fsync(int descriptor) {
    ++name_syncs;
    if (sync_fails) {
        errno = EIO;
        return -1;
    }
    return static_cast<int>(::syscall(SYS_fsync, descriptor));
}

// As on a disk that the kernel has made read-only.
extern "C" int open(const char* path, int flags, ...) {
    if (write_is_refused && (flags & O_ACCMODE) == O_RDWR) {
        errno = EROFS;
        return -1;
    }
    va_list more;
    va_start(more, flags);
    const unsigned mode = flags & O_CREAT ? va_arg(more, unsigned) : 0;
    va_end(more);
    return static_cast<int>(::syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}

TEST_CASE(
    "journal 2: an entry is on the disk when write() returns, its name too, or that is told") {
    const std::string path = lyr::tests::scratch("synced.journal");
    std::filesystem::remove(path);
    name_syncs = 0;
    Result<Journal> journal = Journal::open(path);
    REQUIRE(journal.ok());
    CHECK(name_syncs == 1);
    syncs = 0;
    CHECK(journal->write({}).ok());
    CHECK(syncs == 1);
    sync_fails = true;
    CHECK_FALSE(journal->write({}).ok());
    sync_fails = false;
    journal->remove();
    CHECK(name_syncs == 2);
    CHECK_FALSE(std::filesystem::exists(path));
}

TEST_CASE(
    "print 7: a print moved the head although the journal went on saying how high it had rested") {
    gpio::MonotonicClock clock;
    PrintJob job{write_print("outlived", {draw_small}), nearby_printer(), false, {}};
    job.journal = job.file + ".journal";
    bool has_begun = false;
    job.before = [&](gpio::GpioChip&, gpio::Clock&, const StopSource&, const NoteRisen&) {
        has_begun = true;
        return Status(Done{});
    };
    for (bool* fault : {&sync_fails, &write_is_refused})
        for (const bool resumes : {false, true}) {
            write_journal(job.printer, job.file, resting_at(7.4));
            const Result<Resumption> found = find_resumption(job.printer, job.file);
            REQUIRE(found.ok());
            job.resumption = resumes ? std::optional(*found) : std::nullopt;
            gpio::MockChip chip(line_count, clock, {});
            *fault = true;
            const Result<PrintReport> refused = print(job, chip, clock);
            *fault = false;
            CAPTURE(resumes);
            REQUIRE_FALSE(refused.ok());
            CHECK(refused.error().status == ExitStatus::output);
            CHECK(refused.error().where.file == job.journal);
            CHECK(refused.error().message.find("or remove it") != std::string::npos);
            CHECK_FALSE(has_begun);
            std::filesystem::remove(job.journal);
        }
    // Of a print that has none there is nothing to be believed.
    job.resumption.reset();
    write_is_refused = true;
    gpio::MockChip chip(line_count, clock, {});
    CHECK(print(job, chip, clock).ok());
    write_is_refused = false;
    CHECK(has_begun);
}
