# Install rules: headers, the exported target, and the package files that let find_package(palpate) work.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(package_dir ${CMAKE_INSTALL_DATADIR}/cmake/palpate)  # share/: the headers alone do not depend on the architecture
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/palpate DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING PATTERN "*.hpp")
install(TARGETS palpate EXPORT palpate-targets INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
set(arch_independent ARCH_INDEPENDENT)
set(PALPATE_FIND_THREADS "")
if(PALPATE_INSTALL_COMPILED)
  list(TRANSFORM compiled_names PREPEND palpate_ OUTPUT_VARIABLE compiled_targets)
  install(TARGETS ${compiled_targets} EXPORT palpate-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  set(arch_independent "")
  if(TARGET Threads::Threads)
    set(PALPATE_FIND_THREADS "find_dependency(Threads)")
  endif()
endif()
install(EXPORT palpate-targets NAMESPACE palpate:: DESTINATION ${package_dir})

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/palpate-config.cmake.in
  ${PROJECT_BINARY_DIR}/palpate-config.cmake INSTALL_DESTINATION ${package_dir}
  NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
# Before 1.0 a new minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/palpate-config-version.cmake
  COMPATIBILITY SameMinorVersion ${arch_independent})
install(FILES ${PROJECT_BINARY_DIR}/palpate-config.cmake ${PROJECT_BINARY_DIR}/palpate-config-version.cmake
  DESTINATION ${package_dir})
