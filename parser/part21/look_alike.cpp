// What a text that is no STEP file seems to be, from its first bytes, so that the user learns what
// was opened by mistake.

#include <algorithm>
#include <array>
#include <cstring>

#include "parser/part21/scan.h"
#include "parser/part21/table.h"

namespace lyr::part21 {
namespace {

using namespace std::string_view_literals;

constexpr std::size_t looked_at = 4096;  // of the start of the file

struct Magic {
    std::string_view bytes;
    const char* name;
};

constexpr Magic binary_magics[] = {
    {"\x1F\x8B"sv, "a gzip archive (unpack it first)"},
    {"BZh"sv, "a bzip2 archive (unpack it first)"},
    {"\xFD"
     "7zXZ\0"sv,
     "an xz archive (unpack it first)"},
    {"7z\xBC\xAF\x27\x1C"sv, "a 7z archive (unpack it first)"},
    {"Rar!"sv, "a RAR archive (unpack it first)"},
    {"\xFF\xFE"sv, "UTF-16 text (save it as UTF-8 or ASCII)"},
    {"\xFE\xFF"sv, "UTF-16 text (save it as UTF-8 or ASCII)"},
    {"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1"sv, "an OLE document (a SolidWorks or Inventor file?)"},
    {"LYR\x1A"sv, "a .lyr file, already sliced"},
    {"\x89PNG"sv, "a PNG picture"},
    {"\xFF\xD8\xFF"sv, "a JPEG picture"},
    {"%PDF"sv, "a PDF document"},
    {"\x7F"
     "ELF"sv,
     "a program"},
    {"PS\0\0"sv, "a Parasolid binary file"},
    {"ACIS BinaryFile"sv, "an ACIS binary file"},
    {"AutoCAD Binary DXF"sv, "a binary DXF drawing"},
    {"AC10"sv, "a DWG drawing"},
    {"3D Geometry File Format"sv, "a Rhino 3DM file"},
    {"glTF"sv, "a glTF mesh"},
};

constexpr Magic text_magics[] = {
    {"**ABCDEFGHIJKLMNOPQRSTUVWXYZ"sv, "a Parasolid text file"},
    {"version https://git-lfs"sv, "a Git LFS pointer (the file itself was not fetched)"},
    {"DBRep_DrawableShape"sv, "an OpenCASCADE BREP file"},
    {"CASCADE Topology"sv, "an OpenCASCADE BREP file"},
    {"ply\n"sv, "a PLY mesh"},
    {"ply\r"sv, "a PLY mesh"},
    {"OFF\n"sv, "an OFF mesh"},
    {"OFF\r"sv, "an OFF mesh"},
    {"#VRML"sv, "a VRML scene"},
    {"{"sv, "a JSON file"},
};

template <std::size_t n>
const char* name_by_magic(const Magic (&magics)[n], std::string_view text) {
    for (const Magic& magic : magics) {
        if (text.starts_with(magic.bytes)) return magic.name;
    }
    return nullptr;
}

const char* zip_name(std::string_view text) {
    if (!text.starts_with("PK\x03\x04") && !text.starts_with("PK\x05\x06")) return nullptr;
    const std::string_view start = text.substr(0, looked_at);
    if (start.find("3D/") != start.npos || start.find("[Content_Types].xml") != start.npos) {
        return "a 3MF mesh (a zip archive)";
    }
    if (start.find("Document.xml") != start.npos) return "a FreeCAD document (export STEP from it)";
    return "a zip archive (unpack it first)";
}

bool is_binary_stl(std::string_view text) {
    constexpr std::size_t header = 80, triangle = 50;
    if (text.size() < header + 4) return false;
    std::array<unsigned char, 4> bytes{};
    std::memcpy(bytes.data(), text.data() + header, bytes.size());
    std::uint64_t count = 0;
    for (std::size_t i = bytes.size(); i-- > 0;) count = count << 8 | bytes[i];
    return text.size() == header + 4 + count * triangle;
}

bool is_binary(std::string_view start) {
    return std::any_of(start.begin(), start.end(), [](char c) {
        return (c >= '\0' && c < ' ' && !is_blank(c)) || c == '\x7F';
    });
}

std::string_view first_line(std::string_view text) {
    return text.substr(0, text.find_first_of("\r\n"));
}

std::string_view behind_first_line(std::string_view text) {
    const std::size_t line_end = text.find_first_of("\r\n");
    return line_end == text.npos ? ""sv
                                 : text.substr(text.find_first_not_of("\r\n", line_end) == text.npos
                                                   ? text.size()
                                                   : text.find_first_not_of("\r\n", line_end));
}

// 80 columns, "S" in the 73rd, then the number of the line.
bool is_iges(std::string_view start) {
    const std::string_view line = first_line(start);
    return line.size() >= 80 && line[72] == 'S' && line[79] == '1';
}

bool is_dxf(std::string_view start) {
    const auto trimmed = [](std::string_view line) {
        line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
        return line.substr(0, line.find_last_not_of(" \t") + 1);
    };
    const std::string_view code = trimmed(first_line(start));
    if (code == "999") return true;  // a comment
    return code == "0" && trimmed(first_line(behind_first_line(start))) == "SECTION";
}

// The first words of lines tell these formats. Comment lines tell nothing.
const char* name_by_lines(std::string_view start) {
    int mesh_lines = 0, gcode_lines = 0, other_lines = 0;
    for (std::string_view rest = start; !rest.empty(); rest = behind_first_line(rest)) {
        std::string_view line = first_line(rest);
        line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
        const std::string_view word = line.substr(0, line.find_first_of(" \t"));
        if (word.empty() || word[0] == ';' || word[0] == '#' || word[0] == '%') continue;
        constexpr std::string_view mesh_words[] = {"v", "vn", "vt",     "f",     "o",
                                                   "g", "s",  "mtllib", "usemtl"};
        const bool is_code = word.size() > 1 && std::strchr("GMTN", word[0]) && is_digit(word[1]);
        if (std::find(std::begin(mesh_words), std::end(mesh_words), word) != std::end(mesh_words)) {
            ++mesh_lines;
        } else if (is_code) {
            ++gcode_lines;
        } else {
            ++other_lines;
        }
    }
    if (mesh_lines > 0 && mesh_lines > 2 * other_lines) return "an OBJ mesh";
    if (gcode_lines > 0 && gcode_lines > other_lines) return "G-code, already sliced";
    return nullptr;
}

const char* markup_name(std::string_view start) {
    if (!start.starts_with('<')) return nullptr;
    const auto has = [&](std::string_view word) { return start.find(word) != start.npos; };
    if (has("<html") || has("<HTML") || has("<!DOCTYPE html") || has("<!doctype html")) {
        return "a web page (was the file itself downloaded?)";
    }
    if (has("<amf")) return "an AMF mesh";
    if (has("<svg")) return "an SVG drawing";
    if (has("iso_10303_28") || has("ISO_10303_28")) {
        return "STEP in XML (ISO 10303-28); export it as Part 21";
    }
    return "an XML file";
}

bool is_acis(std::string_view start) {  // "400 0 1 0"
    const std::string_view line = first_line(start);
    return std::count(line.begin(), line.end(), ' ') >= 3 && is_digit(line[0]) &&
           line.find_first_not_of("0123456789 ") == line.npos;
}

const char* text_name(std::string_view start) {
    if (const char* name = name_by_magic(text_magics, start)) return name;
    if (const char* name = markup_name(start)) return name;
    if (start.starts_with("solid") && start.find("facet") != start.npos) return "an ASCII STL mesh";
    if (is_iges(start)) return "an IGES file";
    if (is_dxf(start)) return "a DXF drawing";
    if (is_acis(start)) return "an ACIS SAT file";
    if (const char* name = name_by_lines(start)) return name;
    if (start.starts_with("solid")) return "an ASCII STL mesh";
    return "a text file of another kind";
}

}  // namespace

std::string look_alike(std::string_view text) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.empty()) return "an empty file";
    if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    const std::size_t first = text.find_first_not_of(" \t\r\n\f\v");
    if (first == text.npos) return "a file of blanks only";
    if (const char* name = name_by_magic(binary_magics, text)) return name;
    if (const char* name = zip_name(text)) return name;
    if (is_binary_stl(text)) return "a binary STL mesh";
    const std::string_view start = text.substr(0, looked_at);
    // IGES counts columns, so leading blanks stay in front of it.
    if (is_iges(start)) return "an IGES file";
    return is_binary(start) ? "a binary file" : text_name(text.substr(first, looked_at));
}

}  // namespace lyr::part21
