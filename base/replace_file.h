// Output that is whole or absent: written under a temporary name in the same folder, then renamed.
//
// Contract
//  1. Until commit() succeeds, the file at `path` is as it was before.
//  2. Whatever is not committed is removed, also when the program is ended by an exception or by end_process().
//  3. A path that is not a regular file (a pipe, a device) is written directly. So is an open descriptor: "-", which is
//     standard output, or a name of one, such as /dev/stdout; what it leads to is neither truncated nor renamed.
//  4. Through a symbolic link the file that it leads to is replaced, or made if it is not there; the link stays.
//  5. A file that is replaced hands its permissions on.
//  6. The first failure is the one that commit() reports.

#pragma once

#include <cstdio>
#include <span>
#include <string>

#include "base/diagnostic.h"

namespace lyr {

// What messages call the output that is named "-".
inline constexpr const char* standard_output_name = "standard output";

class ReplaceFile {
public:
    // Errors (status output): the folder is missing or not writable, `path` is a folder.
    static Result<ReplaceFile> open(const std::string& path);

    ReplaceFile(ReplaceFile&& other) noexcept;
    ReplaceFile& operator=(ReplaceFile&&) = delete;
    ~ReplaceFile();

    // Buffered; a failure to write is reported by flush() and commit(), and shows in failed().
    void write(std::span<const std::byte> bytes);
    void write(std::string_view text);
    bool failed() const { return error_ != 0; }

    // Everything written so far is on the disk, but not yet under its name: of several files that belong together, flush
    // all before the first commit(). Errors (status output): disk full.
    Status flush();

    // Flushes and renames. Errors (status output): disk full, folder gone.
    Status commit();

private:
    ReplaceFile(std::string name, std::FILE* file) : name_(std::move(name)), file_(file) {}
    static Result<ReplaceFile> on_descriptor(int descriptor, const std::string& name);
    static Result<ReplaceFile> beside(const std::string& target, const std::string& name);
    bool direct() const { return temporary_.empty(); }
    void note(bool succeeded);
    void discard();

    std::string name_;                // as the caller says it
    std::string target_, temporary_;  // empty when written directly
    std::FILE* file_;
    int error_ = 0;  // errno of the first failure
};

// Ends the process at once, from any thread, and leaves no temporary behind.
[[noreturn]] void end_process(ExitStatus status);

}  // namespace lyr
