# Debian's LCM and libsodium have no CMake packages: defines the targets footfall_lcm and footfall_sodium, for the build
# and for find_package(footfall).
if(NOT TARGET footfall_lcm)
  find_path(LCM_INCLUDE_DIR lcm/lcm-cpp.hpp REQUIRED)
  find_library(LCM_LIBRARY lcm REQUIRED)
  add_library(footfall_lcm INTERFACE IMPORTED GLOBAL)
  target_include_directories(footfall_lcm SYSTEM INTERFACE ${LCM_INCLUDE_DIR})
  target_link_libraries(footfall_lcm INTERFACE ${LCM_LIBRARY})

  find_path(SODIUM_INCLUDE_DIR sodium.h REQUIRED)
  find_library(SODIUM_LIBRARY sodium REQUIRED)
  add_library(footfall_sodium INTERFACE IMPORTED GLOBAL)
  target_include_directories(footfall_sodium SYSTEM INTERFACE ${SODIUM_INCLUDE_DIR})
  target_link_libraries(footfall_sodium INTERFACE ${SODIUM_LIBRARY})
endif()
