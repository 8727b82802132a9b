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

# footfall_add_library(NAME SOURCES ... PUBLIC ... PRIVATE ...): footfall_NAME with alias footfall::NAME.
function(footfall_add_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(footfall_${name} STATIC ${ARG_SOURCES})
  add_library(footfall::${name} ALIAS footfall_${name})
  target_include_directories(footfall_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/footfall>)
  target_link_libraries(footfall_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  target_compile_features(footfall_${name} PUBLIC cxx_std_20)
  set_target_properties(footfall_${name} PROPERTIES EXPORT_NAME ${name})
  footfall_set_warnings(footfall_${name})
  footfall_set_sanitizers(footfall_${name})
  set_property(GLOBAL APPEND PROPERTY FOOTFALL_LIBRARIES footfall_${name})
endfunction()
