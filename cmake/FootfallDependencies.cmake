# Every library that the build looks for, in one place. tools/dependencies.txt has the Debian packages.
find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)   # Eigen3::Eigen
find_package(mujoco REQUIRED)                 # mujoco::mujoco (wants libqhull-dev, libgl-dev, libopengl-dev)
find_package(yaml-cpp REQUIRED)               # target `yaml-cpp`
find_package(fmt REQUIRED)                    # fmt::fmt
find_package(spdlog REQUIRED)                 # spdlog::spdlog
find_package(nlohmann_json REQUIRED)          # nlohmann_json::nlohmann_json
find_package(CLI11 REQUIRED)                  # CLI11::CLI11

find_path(ZSTD_INCLUDE_DIR zstd.h REQUIRED)
find_library(ZSTD_LIBRARY zstd REQUIRED)
add_library(footfall_zstd INTERFACE IMPORTED GLOBAL)
target_include_directories(footfall_zstd INTERFACE ${ZSTD_INCLUDE_DIR})
target_link_libraries(footfall_zstd INTERFACE ${ZSTD_LIBRARY})

find_library(EGL_LIBRARY EGL REQUIRED)
find_path(STB_INCLUDE_DIR stb/stb_image_write.h REQUIRED)
find_program(NPM_PROGRAM npm)                 # optional: the report's plots; without it, SVG
