# Debian's zstd has no CMake package: defines the target footfall_zstd, for the build and for find_package(footfall).
if(NOT TARGET footfall_zstd)
  find_path(ZSTD_INCLUDE_DIR zstd.h REQUIRED)
  find_library(ZSTD_LIBRARY zstd REQUIRED)
  add_library(footfall_zstd INTERFACE IMPORTED GLOBAL)
  target_include_directories(footfall_zstd INTERFACE ${ZSTD_INCLUDE_DIR})
  target_link_libraries(footfall_zstd INTERFACE ${ZSTD_LIBRARY})
endif()
