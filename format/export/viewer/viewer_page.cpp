// page.html has places, @title@, @styles@, @print@ and @scripts@, which are filled on the way out.

#include "format/export/viewer/viewer_page.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <span>

#include "base/base64.h"
#include "base/read_text.h"
#include "format/export/viewer/viewer_files.h"
#include "format/layout.h"
#include "format/reader.h"

namespace lyr::format {
namespace {

using Write = std::function<void(std::string_view)>;

constexpr std::size_t piece_bytes = 3 * 65536;

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

// Reads all of it, for what the reader has to say. It reads descriptors, so the bytes go into a file without a name;
// they may have come from a pipe.
Result<FileHeader> check(const std::string& bytes, const std::string& name) {
    const std::unique_ptr<std::FILE, CloseFile> copy(std::tmpfile());
    if (!copy || std::fwrite(bytes.data(), 1, bytes.size(), copy.get()) != bytes.size() ||
        std::fflush(copy.get()) != 0 || std::fseek(copy.get(), 0, SEEK_SET) != 0)
        return Diagnostic{Severity::error,
                          ExitStatus::output,
                          "cannot write a temporary file of the print's size",
                          {}};
    auto reader = Reader::from_descriptor(::dup(::fileno(copy.get())), name,
                                          {.keep_thumbnails = false, .keep_configuration = false});
    if (!reader) return reader.error();
    while (reader->read()) {
    }
    if (reader->error()) return *reader->error();
    return reader->header();
}

std::string escaped_html(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else
            out += c;
    }
    return out;
}

void write_print(std::string_view bytes, const Write& write) {
    Base64 base64;
    for (std::size_t at = 0; at < bytes.size(); at += piece_bytes) {
        std::string text;
        base64.append(std::as_bytes(std::span(bytes.substr(at, piece_bytes))), text);
        write(text);
    }
    std::string rest;
    base64.finish(rest);
    write(rest);
}

void write_scripts(const Write& write) {
    write("<script>\nvar lyr = {};\n</script>\n");
    for (const ViewerFile& file : viewer_files()) {
        if (!file.name.ends_with(".js")) continue;
        write("<script>\n");
        write(file.text);
        write("</script>\n");
    }
}

std::string_view file_named(std::string_view name) {
    const auto files = viewer_files();
    return std::ranges::find(files, name, &ViewerFile::name)->text;
}

void write_page(std::string_view bytes, const std::string& title, const Write& write) {
    std::string_view page = file_named("page.html");
    const auto up_to = [&](std::string_view place) {
        const std::size_t at = page.find(place);
        write(page.substr(0, at));
        page.remove_prefix(at + place.size());
    };
    up_to("@title@");
    write(escaped_html(title));
    up_to("@styles@");
    write(file_named("viewer.css"));
    up_to("@print@");
    write_print(bytes, write);
    up_to("@scripts@");
    write_scripts(write);
    write(page);
}

}  // namespace

Status write_viewer(const std::string& path, const Write& write) {
    const auto wrong = [](std::string_view head) -> std::optional<std::string> {
        const auto first =
            std::as_bytes(std::span(head)).first(std::min(head.size(), magic.size()));
        if (std::equal(first.begin(), first.end(), magic.begin())) return std::nullopt;
        return "this is not a .lyr file: it does not begin with LYR and the byte 1a";
    };
    const auto bytes = read_text(path, largest_shown_bytes, {magic.size(), wrong});
    if (!bytes) return bytes.error();
    const auto header = check(*bytes, path == "-" ? standard_input_name : path);
    if (!header) return header.error();
    const std::string& source = header->metadata.source_name;
    write_page(*bytes, source.empty() ? "A print" : source, write);
    return Done{};
}

}  // namespace lyr::format
