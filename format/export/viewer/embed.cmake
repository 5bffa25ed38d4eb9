# Writes OUTPUT, a C++ source with the text of each of FILES: cmake -DFILES=a;b -DOUTPUT=c.cpp -P embed.cmake
set(entries "")
foreach(path IN LISTS FILES)
  get_filename_component(name ${path} NAME)
  file(READ ${path} text)
  string(FIND "${text}" ")~lyr~\"" end)
  if(NOT end EQUAL -1)
    message(FATAL_ERROR "${path} holds the mark that ends its text in C++")
  endif()
  string(APPEND entries "    {\"${name}\", R\"~lyr~(${text})~lyr~\"},\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"format/export/viewer/viewer_files.h\"

namespace lyr::format {
namespace {

constexpr ViewerFile files[] = {
${entries}};

}  // namespace

std::span<const ViewerFile> viewer_files() {
    return files;
}

}  // namespace lyr::format
")
