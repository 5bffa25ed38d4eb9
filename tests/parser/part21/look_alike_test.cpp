// What is no STEP file is refused with the name of what it looks like; part21.h, contract 3.

#include "parser/part21/step_text.h"

namespace lyr::part21 {
namespace {

std::string padded(std::string line, char section, int number) {
    line.resize(72, ' ');
    char tail[16];
    std::snprintf(tail, sizeof tail, "%c%7d\n", section, number);
    return line + tail;
}

std::string binary_stl(std::string title, unsigned triangles) {
    title.resize(80, ' ');
    title += std::string{static_cast<char>(triangles), '\0', '\0', '\0'};
    return title + std::string(50 * triangles, '\x01');
}

TEST_CASE("files of other kinds are named") {
    using namespace std::string_literals;
    const std::pair<std::string, const char*> cases[] = {
        {"", "an empty file"},
        {" \n\t\n", "a file of blanks only"},
        {"solid cube\n facet normal 0 0 1\n  outer loop\n", "an ASCII STL mesh"},
        {"solid empty\nendsolid empty\n", "an ASCII STL mesh"},
        {binary_stl("exported", 3), "a binary STL mesh"},
        {binary_stl("solid exported", 3), "a binary STL mesh"},
        {"PK\x03\x04....[Content_Types].xml....3D/3dmodel.model", "a 3MF mesh (a zip archive)"},
        {"PK\x03\x04....Document.xml", "a FreeCAD document (export STEP from it)"},
        {"PK\x03\x04\x14\0\0part.step"s, "a zip archive (unpack it first)"},
        {"\x1F\x8B\x08\0\0"s, "a gzip archive (unpack it first)"},
        {"# Blender\nmtllib a.mtl\no Cube\nv 1.0 1.0 -1.0\nv 1.0 -1.0 -1.0\nf 1 2 3\n",
         "an OBJ mesh"},
        {padded("made by a CAD program", 'S', 1) + padded("1H,,1H;", 'G', 1), "an IGES file"},
        {padded("", 'S', 1) + padded("1H,,1H;", 'G', 1), "an IGES file"},
        {"**ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz***\n", "a Parasolid text file"},
        {"PS\0\0\0\x35"s, "a Parasolid binary file"},
        {"  0\nSECTION\n  2\nHEADER\n", "a DXF drawing"},
        {"999\ncomment\n  0\r\nSECTION\r\n", "a DXF drawing"},
        {"AutoCAD Binary DXF\r\n\x1A\0"s, "a binary DXF drawing"},
        {"AC1032\0\0"s, "a DWG drawing"},
        {"; generated\nG28\nM104 S200\nG1 X10 Y10 E1\n", "G-code, already sliced"},
        {"%\nG21\nG0 X1\nM30\n", "G-code, already sliced"},
        {"400 0 1 0\n16 Some Modeller\n", "an ACIS SAT file"},
        {"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1rest",
         "an OLE document (a SolidWorks or Inventor file?)"},
        {"\xFF\xFEI\0S\0O\0"s, "UTF-16 text (save it as UTF-8 or ASCII)"},
        {"ply\nformat ascii 1.0\n", "a PLY mesh"},
        {"OFF\n8 6 0\n", "an OFF mesh"},
        {"DBRep_DrawableShape\n", "an OpenCASCADE BREP file"},
        {"\nDBRep_DrawableShape\n", "an OpenCASCADE BREP file"},
        {"<!DOCTYPE html>\n<html>", "a web page (was the file itself downloaded?)"},
        {"<?xml version=\"1.0\"?>\n<amf unit=\"millimeter\">", "an AMF mesh"},
        {"<?xml version=\"1.0\"?>\n<iso_10303_28>",
         "STEP in XML (ISO 10303-28); export it as Part 21"},
        {"<?xml version=\"1.0\"?>\n<x>", "an XML file"},
        {"version https://git-lfs.github.com/spec/v1\noid sha256:00\n",
         "a Git LFS pointer (the file itself was not fetched)"},
        {"LYR\x1A\x01", "a .lyr file, already sliced"},
        {"%PDF-1.4\n", "a PDF document"},
        {"{\"asset\":1}", "a JSON file"},
        {"\x01\x02\x03\x04", "a binary file"},
        {"Dear reader,\nthis is a letter.\n", "a text file of another kind"},
        {"ISO-10303-22;\n", "a text file of another kind"},
        {"\xEF\xBB\xBFhello", "a text file of another kind"},
    };
    for (const auto& [text, name] : cases) {
        CAPTURE(name);
        const auto file = File::parse("x", text);
        REQUIRE_FALSE(file.ok());
        CHECK(file.error().message ==
              "this is " + std::string(name) +
                  "; expected a STEP file, which starts with ISO-10303-21;");
        CHECK(file.error().status == ExitStatus::input);
    }
}

TEST_CASE("each start of every kind of file is refused without harm") {
    for (const std::string& text :
         {binary_stl("solid x", 2), padded("iges", 'S', 1) + padded("g", 'G', 1),
          std::string("  0\nSECTION\n  2\nHEADER\n"), std::string("PK\x03\x04 3D/")}) {
        for (std::size_t size = 0; size <= text.size(); ++size) {
            CHECK_FALSE(File::parse("x", text.substr(0, size)).ok());
        }
    }
}

}  // namespace
}  // namespace lyr::part21
