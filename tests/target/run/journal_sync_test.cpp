// That what journal.h (2) says to be on the disk was sent there: the calls are counted, and made to fail.

#include <doctest/doctest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "target/run/journal.h"

using namespace lyr;
using namespace lyr::run;

namespace {

int syncs = 0, name_syncs = 0;
bool sync_fails = false;

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
    return static_cast<int>(::syscall(SYS_fsync, descriptor));
}

TEST_CASE(
    "journal 2: an entry is on the disk when write() returns, its name too, or that is told") {
    const std::string path = std::filesystem::temp_directory_path() / "lyr_synced.journal";
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
