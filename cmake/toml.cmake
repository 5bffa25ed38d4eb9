find_path(TOMLPLUSPLUS_INCLUDE toml++/toml.h)
if(NOT TOMLPLUSPLUS_INCLUDE)
  message(FATAL_ERROR "toml++ is missing: install Debian's libtomlplusplus-dev")
endif()
# Errors as values, and nothing to install beside the program.
add_library(lyr_toml INTERFACE)
target_include_directories(lyr_toml SYSTEM INTERFACE ${TOMLPLUSPLUS_INCLUDE})
target_compile_definitions(lyr_toml INTERFACE TOML_EXCEPTIONS=0 TOML_HEADER_ONLY=1
  TOML_MAX_NESTED_VALUES=16)
