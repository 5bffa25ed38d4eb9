# libgpiod 1.6 (Debian 12) and 2.x (Debian 13) have different interfaces under one header name. lyrrun speaks to the
# installed one; where 2.x was unpacked beside an installed 1.6 (tools/setup --gpiod2), LYR_GPIOD=2 takes that, and both
# are tested. Gives lyr_gpiod_1 and lyr_gpiod_2, those that were found, and LYR_GPIOD_USED, the one to build with.
set(LYR_GPIOD auto CACHE STRING "libgpiod to build with: 1 (1.6), 2 (2.x) or auto, the one that is installed")
set_property(CACHE LYR_GPIOD PROPERTY STRINGS auto 1 2)
set(LYR_GPIOD2_ROOT ${PROJECT_BINARY_DIR}/gpiod2/usr CACHE PATH "where libgpiod 2.x was unpacked, if it was")

function(lyr_add_gpiod include library)
  if(NOT include OR NOT library)
    return()
  endif()
  file(STRINGS ${include}/gpiod.h bulk REGEX "gpiod_line_set_value_bulk")
  if(bulk)
    set(version 1)
  else()
    set(version 2)
  endif()
  if(NOT TARGET lyr_gpiod_${version})
    add_library(lyr_gpiod_${version} INTERFACE)
    target_include_directories(lyr_gpiod_${version} SYSTEM INTERFACE ${include})
    target_link_libraries(lyr_gpiod_${version} INTERFACE ${library})
  endif()
  if(LYR_GPIOD STREQUAL auto AND NOT LYR_GPIOD_USED)
    set(LYR_GPIOD_USED ${version} PARENT_SCOPE)
  endif()
endfunction()

set(LYR_GPIOD_USED "")
if(NOT LYR_GPIOD STREQUAL auto)
  set(LYR_GPIOD_USED ${LYR_GPIOD})
endif()
find_path(GPIOD_INCLUDE gpiod.h)
find_library(GPIOD_LIBRARY gpiod)
lyr_add_gpiod(${GPIOD_INCLUDE} ${GPIOD_LIBRARY})
find_path(GPIOD2_INCLUDE gpiod.h PATHS ${LYR_GPIOD2_ROOT}/include NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH)
# The static one: nothing of a private folder has to be found again when the program starts.
find_library(GPIOD2_LIBRARY libgpiod.a PATHS ${LYR_GPIOD2_ROOT}/lib PATH_SUFFIXES ${CMAKE_LIBRARY_ARCHITECTURE}
             NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH)
lyr_add_gpiod(${GPIOD2_INCLUDE} ${GPIOD2_LIBRARY})
if(NOT TARGET lyr_gpiod_${LYR_GPIOD_USED})
  message(FATAL_ERROR "libgpiod (LYR_GPIOD=${LYR_GPIOD}) is missing: install Debian's libgpiod-dev, or for 2.x beside an "
                      "installed 1.6 run: tools/setup --gpiod2 ${PROJECT_BINARY_DIR}/gpiod2")
endif()
set(LYR_GPIOD_USED ${LYR_GPIOD_USED} CACHE INTERNAL "the version of libgpiod that lyrrun is built with")
