#include "apps/files.h"

#include <cstdio>

#include "apps/command_line.h"
#include "base/file_place.h"
#include "base/read_text.h"
#include "base/replace_file.h"
#include "base/text.h"

namespace lyr::command_line {
namespace {

std::string input_path(const NamedFile& file) {
    return file.path == "-" ? "/dev/stdin" : file.path;
}

std::string output_path(const NamedFile& file) {
    return file.path == "-" ? "/dev/stdout" : file.path;
}

Status check_inputs(const NamedFile& a, const NamedFile& b) {
    const std::string path_a = input_path(a), path_b = input_path(b);
    const bool one_stream =
        (a.path == "-" && b.path == "-") || (same_file(path_a, path_b) && !is_regular_file(path_a));
    if (!one_stream) return Done{};
    return usage(a.what + " and " + b.what + " cannot both be read from " + input_name(a.path));
}

Status check_input_and_output(const NamedFile& input, const NamedFile& output) {
    const std::string path = input_path(input);
    if (!same_file(path, output_path(output)) || is_two_way(path)) return Done{};
    return usage(output.what + " would overwrite " + input.what + ": " + output_name(output.path));
}

Status check_outputs(const NamedFile& a, const NamedFile& b) {
    if (!same_file(output_path(a), output_path(b))) return Done{};
    return usage(a.what + " and " + b.what + " would be one file: " + output_name(b.path));
}

std::vector<NamedFile> given(const std::vector<NamedFile>& files) {
    std::vector<NamedFile> some;
    for (const NamedFile& file : files)
        if (!file.path.empty()) some.push_back(file);
    return some;
}

// Checks each of `some` with each one behind it.
Status check_pairs(const std::vector<NamedFile>& some,
                   Status (*check)(const NamedFile&, const NamedFile&)) {
    for (std::size_t i = 0; i < some.size(); ++i)
        for (std::size_t k = i + 1; k < some.size(); ++k)
            if (const Status apart = check(some[i], some[k]); !apart) return apart;
    return Done{};
}

}  // namespace

Status check_apart(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs) {
    const std::vector<NamedFile> read = given(inputs), written = given(outputs);
    for (const NamedFile& input : read)
        for (const NamedFile& output : written)
            if (const Status apart = check_input_and_output(input, output); !apart) return apart;
    if (const Status apart = check_pairs(read, check_inputs); !apart) return apart;
    return check_pairs(written, check_outputs);
}

std::string input_name(const std::string& path) {
    return path == "-" ? standard_input_name : escaped(path);
}

std::string output_name(const std::string& path) {
    return path == "-" ? standard_output_name : escaped(path);
}

Status tell(const std::string& text, const std::vector<NamedFile>& outputs) {
    for (const NamedFile& output : given(outputs)) {
        if (!same_file(output_path(output), "/dev/stdout")) continue;
        std::fputs(text.c_str(), stderr);
        return Done{};
    }
    auto out = ReplaceFile::open("-");
    if (!out) return out.error();
    out->write(text);
    return out->commit();
}

}  // namespace lyr::command_line
