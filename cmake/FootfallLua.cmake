# Debian's Lua has no CMake package: defines the target footfall_lua, for the build and for find_package(footfall). It
# is the C++ build of Lua 5.4, which raises errors as exceptions.
if(NOT TARGET footfall_lua)
  find_path(LUA54_INCLUDE_DIR lua.hpp PATH_SUFFIXES lua5.4 REQUIRED)
  find_library(LUA54_LIBRARY lua5.4-c++ REQUIRED)
  add_library(footfall_lua INTERFACE IMPORTED GLOBAL)
  target_include_directories(footfall_lua INTERFACE ${LUA54_INCLUDE_DIR})
  target_link_libraries(footfall_lua INTERFACE ${LUA54_LIBRARY})
endif()
