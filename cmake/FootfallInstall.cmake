# `cmake --install` and an exported package: find_package(footfall) defines footfall::engine and the other libraries.
include(CMakePackageConfigHelpers)
get_property(libraries GLOBAL PROPERTY FOOTFALL_LIBRARIES)
install(TARGETS ${libraries} EXPORT footfallTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS footfall RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
foreach(folder core hal model tasks behaviors engine sim lab)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/footfall
    FILES_MATCHING PATTERN "*.h" PATTERN "allocation_count.h" EXCLUDE PATTERN "library" EXCLUDE PATTERN "scaffolds" EXCLUDE PATTERN "worlds" EXCLUDE PATTERN "web" EXCLUDE)
endforeach()
install(DIRECTORY ${PROJECT_BINARY_DIR}/messages/footfall_lcm DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/engine/lcm/messages/ DESTINATION ${CMAKE_INSTALL_DATADIR}/footfall/lcm)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/robots DESTINATION ${CMAKE_INSTALL_DATADIR}/footfall)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/behaviors/library ${PROJECT_SOURCE_DIR}/behaviors/scaffolds DESTINATION ${CMAKE_INSTALL_DATADIR}/footfall/behaviors)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/sim/worlds DESTINATION ${CMAKE_INSTALL_DATADIR}/footfall/sim)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/lab/slurm DESTINATION ${CMAKE_INSTALL_DATADIR}/footfall/lab)
install(FILES ${PROJECT_SOURCE_DIR}/tools/completion/footfall.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME footfall)
install(EXPORT footfallTargets NAMESPACE footfall:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/footfall)
set(FOOTFALL_DATA_DIR ${CMAKE_INSTALL_DATADIR}/footfall)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/footfallConfig.cmake.in
  ${PROJECT_BINARY_DIR}/footfallConfig.cmake INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/footfall
  PATH_VARS FOOTFALL_DATA_DIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/footfallConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/footfallConfig.cmake ${PROJECT_BINARY_DIR}/footfallConfigVersion.cmake
  ${PROJECT_SOURCE_DIR}/cmake/FootfallZstd.cmake ${PROJECT_SOURCE_DIR}/cmake/FootfallLua.cmake
  ${PROJECT_SOURCE_DIR}/cmake/FootfallLcm.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/footfall)
