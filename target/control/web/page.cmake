# Writes OUTPUT, a C++ source with the page as one HTML file, compressed: PAGE with the text of STYLES and SCRIPTS in its
# places: cmake -DPAGE=page.html -DSTYLES=a.css;b.css -DSCRIPTS=a.js;b.js -DOUTPUT=page.cpp -P page.cmake
cmake_minimum_required(VERSION 3.25)
function(text_of paths out)
  set(all "")
  foreach(path IN LISTS ${paths})
    file(READ ${path} text)
    string(APPEND all "${text}")
  endforeach()
  set(${out} "${all}" PARENT_SCOPE)
endfunction()

text_of(STYLES styles)
text_of(SCRIPTS scripts)
file(READ ${PAGE} page)
string(REPLACE "@styles@" "${styles}" page "${page}")
string(REPLACE "@scripts@" "\"use strict\";\nvar lyr = {};\n${scripts}" page "${page}")
file(WRITE ${OUTPUT}.html "${page}")
execute_process(COMMAND gzip -9nc ${OUTPUT}.html OUTPUT_FILE ${OUTPUT}.gz COMMAND_ERROR_IS_FATAL ANY)
file(READ ${OUTPUT}.gz bytes HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
file(WRITE ${OUTPUT} "#include \"target/control/web/page_bytes.h\"

namespace lyr::control {

std::string_view page_bytes() {
    static constexpr unsigned char bytes[] = {${bytes}};
    return {reinterpret_cast<const char*>(bytes), sizeof bytes};
}

}  // namespace lyr::control
")
