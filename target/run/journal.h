// How far a print has come, on the disk, so that it can go on after the power failed: a small file with two slots,
// written in turn, each with a number that grows and a checksum. Whatever becomes of the slot that is being written,
// the other one has the state before.
//
// Contract
//  1. read_journal() gives the latest entry that is whole. A write that was cut at any byte leaves that or the one
//     before; a byte that was changed at any place loses the entry that it belongs to, and never makes another one of
//     it. A file without a whole entry is an error, and one by another version of this program is told as such.
//  2. Journal::write() returns when the entry is on the disk (fdatasync), and never while the other slot is at risk.
//  3. A JournalWriter does so on a thread of its own, since a memory card may take seconds: post() returns at once,
//     and of entries that wait for the disk only the latest is kept. An error is told once.
//  4. identity_of() tells files apart by their length and the CRC-32C of all their bytes.

#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "base/diagnostic.h"
#include "target/run/printer_identity.h"

namespace lyr::run {

struct FileIdentity {
    std::uint64_t bytes = 0;
    std::uint32_t crc = 0;
    friend bool operator==(const FileIdentity&, const FileIdentity&) = default;
};

Result<FileIdentity> identity_of(const std::string& path);

struct JournalEntry {
    FileIdentity file;
    PrinterIdentity printer;
    std::uint32_t layer = 0;  // that the head was in, from 1; 0: before the first
    std::uint32_t layers = 0;
    std::int64_t time_ns = 0;  // of the plan, in all since the print was begun
    // Where the head was, if that was noted: its height at rest, or else x and y on the path.
    std::optional<std::int64_t> rest_nm;
    std::optional<std::array<std::int32_t, 2>> place_um;
    std::int32_t drawn_back_um = 0;  // of the filament
    bool is_unloaded = false;        // which was drawn out
    friend bool operator==(const JournalEntry&, const JournalEntry&) = default;
};

// None: no file, or an empty one. Errors (status input): it cannot be read, or nothing in it can be used.
Result<std::optional<JournalEntry>> read_journal(const std::string& path);

// Something in it is no whole entry, nor empty: a write was cut off, or bytes were changed since.
bool has_damage(const std::string& path);

// A print that is under way writes it.
bool is_kept(const std::string& path);

class Journal {
public:
    // Makes the file, or goes on after the entries that it has. Nobody else can until this one and what was forked with it
    // have ended. Errors (status output).
    static Result<Journal> open(const std::string& path);
    Journal(Journal&& other) noexcept;
    Journal& operator=(Journal&&) = delete;
    ~Journal();

    Status write(const JournalEntry& entry);
    // Nothing of what it has is found any more, nor after a loss of power; a device is left alone.
    Status clear();
    // The print is over, and nothing of it is left to resume; a device is left alone.
    void remove();

private:
    Journal(std::string path, int descriptor, std::uint64_t sequence, bool is_empty)
        : path_(std::move(path)),
          descriptor_(descriptor),
          sequence_(sequence),
          is_empty_(is_empty) {}

    std::string path_;
    int descriptor_;
    std::uint64_t sequence_;  // of the entry written last
    bool is_empty_;
};

class JournalWriter {
public:
    explicit JournalWriter(Journal journal);
    ~JournalWriter() { finish(); }
    JournalWriter(const JournalWriter&) = delete;
    JournalWriter& operator=(const JournalWriter&) = delete;

    void post(const JournalEntry& entry);
    // All that was posted is on the disk, or could not be written.
    bool is_idle();
    // What was posted last could not.
    bool has_failed();
    std::optional<Diagnostic> take_error();
    // At once and for good: neither what waits nor what is posted later is written.
    void remove();
    // Writes what waits, and ends; nothing may be posted any more.
    void finish();

private:
    void work();

    Journal journal_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::optional<JournalEntry> waiting_;
    std::optional<Diagnostic> error_;
    bool is_writing_ = false, has_failed_ = false, has_told_ = false, ends_ = false,
         removes_ = false;
    std::thread thread_;
};

}  // namespace lyr::run
