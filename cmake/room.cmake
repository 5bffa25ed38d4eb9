# A room is one folder, one static library and one purpose. The link graph keeps the design's arrows:
# a room sees the headers of the rooms that it links and of no other.

add_library(lyr_flags INTERFACE)
# Contraction is off so that results do not depend on the processor's fused multiply-add. Nobody asks errno about roots,
# nor the processor's flags about traps: the compiler need not keep them, and results are the same.
# What no program calls is left out of it, function by function.
target_compile_options(lyr_flags INTERFACE -Wall -Wextra -Wconversion -ffp-contract=off -fno-math-errno -fno-trapping-math
                       -ffunction-sections -fdata-sections)
target_link_options(lyr_flags INTERFACE -Wl,--gc-sections)
# Files of more than 2 GiB on 32-bit processors too.
target_compile_definitions(lyr_flags INTERFACE _FILE_OFFSET_BITS=64)
# A name of one source may be a constant of another that is compiled with it.
target_compile_options(lyr_flags INTERFACE $<IF:$<BOOL:${LYR_UNITY}>,-Wshadow=local,-Wshadow>)
if(LYR_SANITIZE STREQUAL thread)
  target_compile_options(lyr_flags INTERFACE -fsanitize=thread)
  target_link_options(lyr_flags INTERFACE -fsanitize=thread)
elseif(LYR_SANITIZE)
  target_compile_options(lyr_flags INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all)
  target_link_options(lyr_flags INTERFACE -fsanitize=address,undefined)
endif()

# Tests are built to be built quickly: most of their time is the compiler's.
add_library(lyr_test_flags INTERFACE)
target_compile_options(lyr_test_flags INTERFACE -Og)

# lyr_precompile(<name> <library>...): headers that many sources read, read once. A folder whose CMakeLists.txt sets
# LYR_HEADERS to the name has them; no source may rely on it, and -DLYR_PRECOMPILE=OFF builds without. Options that
# change code have to be those of the sources.
function(lyr_precompile name)
  if(LYR_PRECOMPILE)
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/${name}.cpp CONTENT "")
    add_library(${name} OBJECT ${PROJECT_BINARY_DIR}/${name}.cpp)
    target_link_libraries(${name} PRIVATE lyr_flags ${ARGN})
    target_precompile_headers(${name} PRIVATE <algorithm> <array> <cmath> <fstream> <functional> <map>
      <optional> <random> <sstream> <string> <unordered_map> <variant> <vector>)
  endif()
endfunction()

function(lyr_use_headers target)
  if(LYR_HEADERS AND TARGET ${LYR_HEADERS})
    target_precompile_headers(${target} REUSE_FROM ${LYR_HEADERS})
  endif()
endfunction()

# lyr_compile_together(<target> [<file>...]): eight sources at a time, which take little more of the compiler's time than
# one, but for those named: names that two sources of a room use for different things keep them apart. No source may rely
# on it, and -DLYR_UNITY=OFF builds them one by one.
function(lyr_compile_together target)
  if(LYR_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
    set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
endfunction()

# lyr_room(<library> [SMALL] [BARE] SOURCES <file>... [FAST <file>...] [PURE <file>...] [ALONE <file>...] [LINK <library>...] [PRIVATE <library>...])
# Headers are included by their path from the root ("kernel/brep/model.h"); each room publishes only
# its own folder, through a link in the build tree. SMALL rooms are what a board's program does now and then (options,
# settings, reports): they are built for size, but for those of their sources that are FAST, which need no room between
# their functions and jumps to be so: that would be a twentieth of them. Nor are functions of the standard library cloned for
# what one source asks of them, since each would have its own of what is one for all. BARE rooms, and PURE sources of others, hold
# nothing but memory: nothing of this project throws, and when there is no memory the program ends with its message and
# cleans up no more of it on the way; the code for that would be a tenth of them.
function(lyr_room name)
  cmake_parse_arguments(ROOM "SMALL;BARE" "" "SOURCES;FAST;PURE;ALONE;LINK;PRIVATE" ${ARGN})
  file(RELATIVE_PATH path ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  set(published ${PROJECT_BINARY_DIR}/rooms/${name})
  get_filename_component(parent ${published}/${path} DIRECTORY)
  file(MAKE_DIRECTORY ${parent})
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${published}/${path} SYMBOLIC)
  if(ROOM_SOURCES)
    add_library(${name} STATIC ${ROOM_SOURCES})
    target_link_libraries(${name} PUBLIC ${ROOM_LINK} PRIVATE lyr_flags ${ROOM_PRIVATE})
    target_include_directories(${name} PUBLIC ${published})
    if(ROOM_SMALL)
      target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-Os;-fno-ipa-sra>)
      set_property(SOURCE ${ROOM_FAST} APPEND PROPERTY COMPILE_OPTIONS
        $<$<CONFIG:Release>:-O2;-fipa-sra;-fno-align-jumps;-fno-align-functions>)
    endif()
    set(bare $<$<CONFIG:Release>:-fno-exceptions;-funwind-tables>)
    if(ROOM_BARE)
      target_compile_options(${name} PRIVATE ${bare})
    else()
      set_property(SOURCE ${ROOM_PURE} APPEND PROPERTY COMPILE_OPTIONS ${bare})
    endif()
    lyr_compile_together(${name} ${ROOM_ALONE})
    lyr_use_headers(${name})
  else()
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE ${ROOM_LINK})
    target_include_directories(${name} INTERFACE ${published})
  endif()
endfunction()

# lyr_test(<name> SOURCES <file>... [ALONE <file>...] LINK <library>...): one doctest program for one room. What its
# cases of the suite "long" look at, others look at in fewer places, or an emulator cannot: it leaves them out.
function(lyr_test name)
  cmake_parse_arguments(TEST "" "" "SOURCES;ALONE;LINK" ${ARGN})
  add_executable(${name} ${TEST_SOURCES})
  target_link_libraries(${name} PRIVATE ${TEST_LINK} lyr_flags lyr_test_flags lyr_test_main)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(${name} PRIVATE
    LYR_FIXTURES="${PROJECT_SOURCE_DIR}/fixtures" LYR_BUILD="${PROJECT_BINARY_DIR}")
  lyr_compile_together(${name} ${TEST_ALONE})
  lyr_use_headers(${name})
  add_test(NAME ${name} COMMAND ${name} $<$<BOOL:${CMAKE_CROSSCOMPILING}>:--test-suite-exclude=long>)
  if(CMAKE_CURRENT_SOURCE_DIR MATCHES "^${PROJECT_SOURCE_DIR}/tests/(base|format|target)(/|$)")
    set_property(TEST ${name} PROPERTY LABELS board)
    add_dependencies(board_tests ${name})
  endif()
endfunction()

# lyr_stands_alone(<target>...): what a printer's board runs has neither Eigen nor a model, whatever is built beside it.
# All that a source can include comes with what it links, so the links are looked at.
function(lyr_stands_alone)
  set(waiting ${ARGN})
  set(seen "")
  while(waiting)
    list(POP_FRONT waiting name)
    if(name IN_LIST seen OR NOT TARGET ${name})
      continue()
    endif()
    list(APPEND seen ${name})
    get_target_property(source ${name} SOURCE_DIR)
    if(name MATCHES "Eigen" OR source MATCHES "^${PROJECT_SOURCE_DIR}/(kernel|parser|profile|slicer)(/|$)")
      message(FATAL_ERROR "${ARGN}: no part of a board's programs may link ${name}")
    endif()
    foreach(property LINK_LIBRARIES INTERFACE_LINK_LIBRARIES)
      get_target_property(linked ${name} ${property})
      if(linked)
        list(APPEND waiting ${linked})
      endif()
    endforeach()
  endwhile()
endfunction()
