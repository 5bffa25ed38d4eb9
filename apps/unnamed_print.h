// A print on its way into another format: a .lyr file without a name, which is gone when the process is.

#pragma once

#include <string>

#include "base/diagnostic.h"
#include "format/reader.h"

namespace lyr::command_line {

class UnnamedPrint {
public:
    // Errors (status output): no temporary file can be made.
    static Result<UnnamedPrint> create();
    UnnamedPrint(UnnamedPrint&& other) noexcept;
    UnnamedPrint& operator=(UnnamedPrint&&) = delete;
    ~UnnamedPrint();

    // What to write to.
    std::string path() const;
    // Once, when it is written. Errors: the reader's.
    Result<format::Reader> read();

private:
    explicit UnnamedPrint(int descriptor) : descriptor_(descriptor) {}
    int descriptor_;
};

}  // namespace lyr::command_line
