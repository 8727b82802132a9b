# Functions for libraries (one a folder), warnings and sanitizers.

# Warnings for our own code only (never global, never exported).
function(footfall_set_warnings target)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wshadow -Wconversion -Wdouble-promotion -Wold-style-cast
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>  # false positive of g++ 12 for std::string operator+ (GCC bug 105651)
    # Unity builds: a hidden class with a member of an unnamed namespace still belongs to one file only.
    $<$<AND:$<BOOL:${CMAKE_UNITY_BUILD}>,$<CXX_COMPILER_ID:GNU>>:-Wno-subobject-linkage>
    $<$<BOOL:${FOOTFALL_WERROR}>:-Werror>)
endfunction()

# AddressSanitizer or UndefinedBehaviorSanitizer according to FOOTFALL_SANITIZE; for fuzzing both, and coverage.
function(footfall_set_sanitizers target)
  if(FOOTFALL_SANITIZE)
    set(kinds ${FOOTFALL_SANITIZE})
    if(FOOTFALL_FUZZ)
      string(APPEND kinds ",undefined,fuzzer-no-link")
    endif()
    target_compile_options(${target} PRIVATE -fsanitize=${kinds} -fno-omit-frame-pointer
      -fno-sanitize-recover=all)
    target_link_options(${target} PUBLIC -fsanitize=${kinds})
  endif()
endfunction()

# Precompiled headers, a set for each level of optimisation: g++ takes one only with the flags that made it. Each set is
# made once, by a target of its own, and serves every target of that level. FOOTFALL_PCH is on where time counts
# (preset release); the other presets see that each file includes what it uses.
set(FOOTFALL_PCH_offline <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream> <functional> <map> <memory>
  <optional> <set> <span> <string> <string_view> <utility> <vector> <fmt/format.h>)
set(FOOTFALL_PCH_offline_libraries fmt::fmt)
set(FOOTFALL_PCH_tick <algorithm> <array> <cmath> <cstdint> <functional> <memory> <optional> <span> <string>
  <string_view> <utility> <vector> <Eigen/Dense> <fmt/format.h>)
set(FOOTFALL_PCH_tick_libraries fmt::fmt Eigen3::Eigen)
set(FOOTFALL_PCH_tests <gmock/gmock.h> <gtest/gtest.h> <algorithm> <array> <cmath> <filesystem> <fstream> <functional>
  <map> <memory> <optional> <string> <vector>)
set(FOOTFALL_PCH_tests_libraries GTest::gtest GTest::gmock fmt::fmt)

# Garbage collection takes a sixth of g++'s time by default; with 1 GB before the first one a compiler needs 1.2 GB.
cmake_host_system_information(RESULT memory QUERY TOTAL_PHYSICAL_MEMORY)
cmake_host_system_information(RESULT cores QUERY NUMBER_OF_LOGICAL_CORES)
math(EXPR memory_per_core "${memory} / ${cores}")
if(FOOTFALL_PCH AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND memory_per_core GREATER 2000)
  add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:--param=ggc-min-heapsize=1000000>")
endif()

# footfall_set_level(TARGET tick|offline|tests): -O3 for what runs in the tick, -O1 outside it, -O0 for the code of the
# tests; all in Release only. NDEBUG and every other flag are the same everywhere, because inline functions are shared.
# Of what runs outside the tick more files compile together, because there templates of libraries take most of the time.
function(footfall_set_level target level)
  set(flag_tick -O3)
  set(flag_offline -O1)
  set(flag_tests -O0)
  if(level STREQUAL "offline")
    set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE 20)
  endif()
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:${flag_${level}}>)
  if(NOT FOOTFALL_PCH)
    return()
  endif()
  set(source footfall_pch_${level})
  if(NOT TARGET ${source})
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/${source}.cc CONTENT "// Only its precompiled header is used.\n")
    add_library(${source} OBJECT EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/${source}.cc)
    target_link_libraries(${source} PRIVATE ${FOOTFALL_PCH_${level}_libraries})
    target_compile_features(${source} PRIVATE cxx_std_20)
    set_target_properties(${source} PROPERTIES UNITY_BUILD OFF)
    target_compile_options(${source} PRIVATE $<$<CONFIG:Release>:${flag_${level}}>)
    footfall_set_warnings(${source})
    footfall_set_sanitizers(${source})
    target_precompile_headers(${source} PRIVATE ${FOOTFALL_PCH_${level}})
  endif()
  target_compile_options(${target} PRIVATE -fPIC)  # as the header's, also in programs
  target_precompile_headers(${target} REUSE_FROM ${source})
endfunction()

# footfall_add_library(NAME SOURCES ... PUBLIC ... PRIVATE ... [OFFLINE ...|ALL_OFFLINE]): footfall_NAME with alias
# footfall::NAME. OFFLINE: how the paths of those sources begin that no tick runs, see footfall_set_level.
function(footfall_add_library name)
  cmake_parse_arguments(ARG "ALL_OFFLINE" "" "SOURCES;PUBLIC;PRIVATE;OFFLINE" ${ARGN})
  set(offline)
  foreach(prefix IN LISTS ARG_OFFLINE)
    set(matches ${ARG_SOURCES})
    list(FILTER matches INCLUDE REGEX "^${prefix}")
    if(NOT matches)
      message(FATAL_ERROR "footfall_${name}: no source begins with '${prefix}'")
    endif()
    list(APPEND offline ${matches})
    list(REMOVE_ITEM ARG_SOURCES ${matches})
  endforeach()
  add_library(footfall_${name} STATIC ${ARG_SOURCES})
  add_library(footfall::${name} ALIAS footfall_${name})
  target_include_directories(footfall_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/footfall>)
  target_link_libraries(footfall_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  target_compile_features(footfall_${name} PUBLIC cxx_std_20)
  set_target_properties(footfall_${name} PROPERTIES EXPORT_NAME ${name})
  footfall_set_warnings(footfall_${name})
  footfall_set_sanitizers(footfall_${name})
  if(ARG_ALL_OFFLINE)
    footfall_set_level(footfall_${name} offline)
  else()
    footfall_set_level(footfall_${name} tick)
  endif()
  set_property(GLOBAL APPEND PROPERTY FOOTFALL_LIBRARIES footfall_${name})
  if(offline)
    set(part footfall_${name}_offline)
    add_library(${part} OBJECT ${offline})
    target_include_directories(${part} PRIVATE $<TARGET_PROPERTY:footfall_${name},INCLUDE_DIRECTORIES>)
    target_link_libraries(${part} PRIVATE ${ARG_PUBLIC} ${ARG_PRIVATE})
    target_compile_definitions(${part} PRIVATE $<TARGET_PROPERTY:footfall_${name},COMPILE_DEFINITIONS>)
    footfall_set_warnings(${part})
    footfall_set_sanitizers(${part})
    footfall_set_level(${part} offline)
    target_sources(footfall_${name} PRIVATE $<TARGET_OBJECTS:${part}>)
  endif()
endfunction()
