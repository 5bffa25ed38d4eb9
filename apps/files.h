// The files that a command line names: that none takes another's place, and that text for people does not get into one.

#pragma once

#include <string>
#include <vector>

#include "base/diagnostic.h"

namespace lyr::command_line {

struct NamedFile {
    std::string what;  // as in "the print"
    std::string path;  // empty: there is none; "-": standard input or output
};

// Errors (usage): an output that is one file with an input or with another output, through whatever links; two inputs
// from one stream.
Status check_apart(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs);

// What people are told where an input or output is: "-" is standard input or output, and nothing can steer the terminal.
std::string input_name(const std::string& path);
std::string output_name(const std::string& path);

// Text for people, on standard output or, where one of `outputs` goes there, on standard error.
// Errors (status output): standard output cannot be written.
Status tell(const std::string& text, const std::vector<NamedFile>& outputs = {});

}  // namespace lyr::command_line
