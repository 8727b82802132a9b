# Every library that the build looks for, in one place. tools/dependencies.txt has the Debian packages;
# footfallConfig.cmake.in names again what the installed libraries need.
find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # What ccache asks for to serve files compiled with a precompiled header.
  set(CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE_PROGRAM})
endif()

find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)   # Eigen3::Eigen
find_package(mujoco REQUIRED)                 # mujoco::mujoco (wants libqhull-dev, libgl-dev, libopengl-dev)
find_package(yaml-cpp REQUIRED)               # target `yaml-cpp`
find_package(fmt REQUIRED)                    # fmt::fmt
find_package(nlohmann_json REQUIRED)          # nlohmann_json::nlohmann_json
find_package(Protobuf REQUIRED)               # protobuf::libprotobuf
find_package(SQLite3 REQUIRED)                # SQLite::SQLite3
find_package(CLI11 REQUIRED)                  # CLI11::CLI11

include(FootfallZstd)                         # footfall_zstd
include(FootfallLua)                          # footfall_lua
include(FootfallLcm)                          # footfall_lcm, footfall_sodium
find_program(LCM_GEN lcm-gen REQUIRED)        # makes engine/lcm/messages/*.lcm into headers
set(CURSES_NEED_WIDE TRUE)
find_package(Curses REQUIRED)                 # CURSES_LIBRARIES, CURSES_INCLUDE_DIRS

find_library(EGL_LIBRARY EGL REQUIRED)
find_path(STB_INCLUDE_DIR stb/stb_image_write.h REQUIRED)
find_program(NPM_PROGRAM npm)                 # optional: the report's plots; without it, SVG
