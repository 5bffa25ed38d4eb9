// A slot is one sector of a disk, and the two lie in different blocks of a file system:
//
//     bytes 0..7   "LYRJRNL2"       36..39  1 at rest, 2 on the path, neither where it is not known; 4 unloaded
//           8..15  sequence         40..47  time_ns
//          16..23  file's length    48..55  height in nm, if at rest; x and y in um, if on the path
//          24..27  file's CRC       56..59  how far the filament is drawn back, in um
//          28..31  layer            60..83  printer's parts
//          32..35  layers           84..87  CRC-32C of bytes 0..83
//
// All numbers are little-endian. The last character of the first eight is the version.

#include "target/run/journal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "base/file_place.h"
#include "format/crc32c.h"

namespace lyr::run {
namespace {

constexpr std::size_t slot_bytes = 88, checked_bytes = 84;
constexpr off_t slot_spacing = 4096;
constexpr std::array<char, 8> magic{'L', 'Y', 'R', 'J', 'R', 'N', 'L', '2'};
constexpr std::uint32_t at_rest = 1, on_path = 2, unloaded = 4;
constexpr std::size_t printer_at = 60;
using Slot = std::array<std::byte, slot_bytes>;

template <class Number>
void put(Slot& slot, std::size_t at, Number number) {
    const auto bits = static_cast<std::uint64_t>(number);
    for (std::size_t i = 0; i < sizeof(Number); ++i)
        slot[at + i] = static_cast<std::byte>(bits >> (8 * i) & 0xff);
}

template <class Number>
Number get(const Slot& slot, std::size_t at) {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < sizeof(Number); ++i)
        bits |= std::to_integer<std::uint64_t>(slot[at + i]) << (8 * i);
    return static_cast<Number>(bits);
}

Slot slot_of(const JournalEntry& entry, std::uint64_t sequence) {
    Slot slot{};
    std::memcpy(slot.data(), magic.data(), magic.size());
    put(slot, 8, sequence);
    put(slot, 16, entry.file.bytes);
    put(slot, 24, entry.file.crc);
    put(slot, 28, entry.layer);
    put(slot, 32, entry.layers);
    put(slot, 36,
        (entry.rest_nm    ? at_rest
         : entry.place_um ? on_path
                          : 0) |
            (entry.is_unloaded ? unloaded : 0));
    put(slot, 40, entry.time_ns);
    if (entry.rest_nm) {
        put(slot, 48, *entry.rest_nm);
    } else if (entry.place_um) {
        put(slot, 48, (*entry.place_um)[0]);
        put(slot, 52, (*entry.place_um)[1]);
    }
    put(slot, 56, entry.drawn_back_um);
    for (std::size_t i = 0; i < entry.printer.parts.size(); ++i)
        put(slot, printer_at + 4 * i, entry.printer.parts[i]);
    put(slot, checked_bytes, format::crc32c(std::span(slot).first(checked_bytes)));
    return slot;
}

struct Numbered {
    std::uint64_t sequence = 0;
    JournalEntry entry;
};

std::optional<Numbered> entry_of(const Slot& slot) {
    if (std::memcmp(slot.data(), magic.data(), magic.size()) != 0) return std::nullopt;
    const std::uint32_t crc = format::crc32c(std::span(slot).first(checked_bytes));
    if (get<std::uint32_t>(slot, checked_bytes) != crc) return std::nullopt;
    Numbered read{get<std::uint64_t>(slot, 8), {}};
    JournalEntry& entry = read.entry;
    entry.file = {get<std::uint64_t>(slot, 16), get<std::uint32_t>(slot, 24)};
    for (std::size_t i = 0; i < entry.printer.parts.size(); ++i)
        entry.printer.parts[i] = get<std::uint32_t>(slot, printer_at + 4 * i);
    entry.layer = get<std::uint32_t>(slot, 28);
    entry.layers = get<std::uint32_t>(slot, 32);
    entry.time_ns = get<std::int64_t>(slot, 40);
    const auto state = get<std::uint32_t>(slot, 36);
    if (state & at_rest) entry.rest_nm = get<std::int64_t>(slot, 48);
    if (state & on_path)
        entry.place_um = {get<std::int32_t>(slot, 48), get<std::int32_t>(slot, 52)};
    entry.drawn_back_um = get<std::int32_t>(slot, 56);
    entry.is_unloaded = (state & unloaded) != 0;
    return read;
}

struct Slots {
    std::optional<Numbered> latest;
    bool is_empty = true;
    bool has_other_version = false;
    bool has_damage = false;
};

// What a full disk has no room for is found out before anything moves. A file system that cannot reserve is written to
// without, as is what is no file. The size stays: an empty journal is one that says nothing.
bool has_room(int descriptor) {
    return ::fallocate(descriptor, FALLOC_FL_KEEP_SIZE, 0, slot_spacing + slot_bytes) == 0 ||
           errno != ENOSPC;
}

Slots read_slots(int descriptor) {
    Slots slots;
    for (const off_t place : {off_t{0}, slot_spacing}) {
        Slot slot{};
        const ssize_t count = ::pread(descriptor, slot.data(), slot.size(), place);
        if (count > 0) slots.is_empty = false;
        slots.has_other_version |= std::memcmp(slot.data(), magic.data(), magic.size() - 1) == 0 &&
                                   static_cast<char>(slot[magic.size() - 1]) != magic.back();
        const bool is_long_enough = count == static_cast<ssize_t>(slot.size());
        const auto read = is_long_enough ? entry_of(slot) : std::nullopt;
        slots.has_damage |= !read && slot != Slot{};
        if (read && (!slots.latest || read->sequence > slots.latest->sequence)) slots.latest = read;
    }
    return slots;
}

Diagnostic failed(ExitStatus status, const std::string& what, const std::string& path) {
    return {Severity::error, status, what + ": " + std::strerror(errno), {.file = path}};
}

// A name is on the disk when its folder is.
void sync_folder_of(const std::string& path) {
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    const int descriptor =
        ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    (void)::fsync(descriptor);
    ::close(descriptor);
}

}  // namespace

Result<FileIdentity> identity_of(const std::string& path) {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return failed(ExitStatus::input, "cannot read the print", path);
    std::array<std::byte, 65'536> buffer;
    FileIdentity identity;
    ssize_t count = 0;
    while ((count = ::read(descriptor, buffer.data(), buffer.size())) > 0) {
        const auto size = static_cast<std::size_t>(count);
        identity.bytes += size;
        identity.crc = format::crc32c(std::span(buffer).first(size), identity.crc);
    }
    const int error = errno;
    ::close(descriptor);
    errno = error;
    if (count < 0) return failed(ExitStatus::input, "cannot read the print", path);
    return identity;
}

Result<std::optional<JournalEntry>> read_journal(const std::string& path) {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0 && errno == ENOENT) return std::optional<JournalEntry>();
    if (descriptor < 0) return failed(ExitStatus::input, "cannot read the journal", path);
    const Slots slots = read_slots(descriptor);
    ::close(descriptor);
    if (slots.latest) return std::optional(slots.latest->entry);
    if (slots.is_empty) return std::optional<JournalEntry>();
    return Diagnostic{Severity::error,
                      ExitStatus::input,
                      slots.has_other_version
                          ? "the journal was written by another version of lyrrun"
                          : "the journal is damaged, or the power failed before its first entry "
                            "was written: no entry is whole",
                      {.file = path}};
}

bool has_damage(const std::string& path) {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return false;
    const Slots slots = read_slots(descriptor);
    ::close(descriptor);
    return slots.has_damage;
}

bool is_kept(const std::string& path) {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return false;
    const bool is_free = ::flock(descriptor, LOCK_SH | LOCK_NB) == 0;
    const bool is_locked = !is_free && errno == EWOULDBLOCK;
    ::close(descriptor);
    return is_locked;
}

Result<Journal> Journal::open(const std::string& path) {
    constexpr mode_t for_all_to_read = 0644;
    const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, for_all_to_read);
    if (descriptor < 0) return failed(ExitStatus::output, "cannot write the journal", path);
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
        const Diagnostic busy =
            failed(ExitStatus::output, "another print of this file keeps the journal", path);
        ::close(descriptor);
        return busy;
    }
    sync_folder_of(path);
    const Slots before = read_slots(descriptor);
    if (before.is_empty && !has_room(descriptor)) {
        const Diagnostic full = failed(ExitStatus::output, "cannot write the journal", path);
        (void)::unlink(path.c_str());
        ::close(descriptor);
        return full;
    }
    return Journal(path, descriptor, before.latest ? before.latest->sequence : 0, before.is_empty);
}

Journal::Journal(Journal&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      sequence_(other.sequence_),
      is_empty_(other.is_empty_) {}

Journal::~Journal() {
    if (descriptor_ < 0) return;
    // A print that did not begin leaves nothing behind.
    if (is_empty_) remove();
    ::close(descriptor_);
}

Status Journal::write(const JournalEntry& entry) {
    const Slot slot = slot_of(entry, sequence_ + 1);
    is_empty_ = false;
    const off_t place = (sequence_ + 1) % 2 == 0 ? 0 : slot_spacing;
    errno = ENOSPC;  // of a write that was cut short
    const ssize_t written = ::pwrite(descriptor_, slot.data(), slot.size(), place);
    if (written != static_cast<ssize_t>(slot.size()) || ::fdatasync(descriptor_) != 0)
        return failed(ExitStatus::output, "cannot write the journal", path_);
    ++sequence_;
    return Done{};
}

Status Journal::clear() {
    const bool is_cleared = ::ftruncate(descriptor_, 0) == 0 && ::fsync(descriptor_) == 0;
    const bool is_device = !is_cleared && errno == EINVAL;
    if (!is_cleared && !is_device)
        return failed(ExitStatus::output, "cannot write the journal", path_);
    is_empty_ = true;
    // What there was room for a moment ago.
    (void)has_room(descriptor_);
    return Done{};
}

void Journal::remove() {
    // What the user named may be no file of ours.
    struct stat kind {};
    if (::fstat(descriptor_, &kind) != 0 || !S_ISREG(kind.st_mode)) return;
    (void)::unlink(path_.c_str());
    // Not to come back after a loss of power.
    sync_folder_of(path_);
}

JournalWriter::JournalWriter(Journal journal)
    : journal_(std::move(journal)), thread_([this] { work(); }) {}

void JournalWriter::finish() {
    if (!thread_.joinable()) return;
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
    }
    changed_.notify_one();
    thread_.join();
}

void JournalWriter::post(const JournalEntry& entry) {
    {
        const std::lock_guard lock(mutex_);
        waiting_ = entry;
    }
    changed_.notify_one();
}

void JournalWriter::remove() {
    {
        const std::lock_guard lock(mutex_);
        removes_ = true;
    }
    changed_.notify_one();
}

bool JournalWriter::is_idle() {
    const std::lock_guard lock(mutex_);
    return !waiting_ && !is_writing_;
}

bool JournalWriter::has_failed() {
    const std::lock_guard lock(mutex_);
    return has_failed_;
}

std::optional<Diagnostic> JournalWriter::take_error() {
    const std::lock_guard lock(mutex_);
    return std::exchange(error_, std::nullopt);
}

void JournalWriter::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return waiting_ || ends_ || removes_; });
        if (removes_) return journal_.remove();
        if (!waiting_) return;
        const JournalEntry entry = *std::exchange(waiting_, std::nullopt);
        is_writing_ = true;
        lock.unlock();
        const Status written = journal_.write(entry);
        lock.lock();
        is_writing_ = false;
        has_failed_ = !written;
        if (has_failed_ && !std::exchange(has_told_, true)) error_ = written.error();
    }
}

}  // namespace lyr::run
