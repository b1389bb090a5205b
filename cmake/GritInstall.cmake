# What `cmake --install` gives: the library, the command, the SDK's headers and its CMake package. Plugins install
# themselves (GritPlugin.cmake). The package also stands in the build folder, for plugins that are built against that.
include(CMakePackageConfigHelpers)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/grit)
set(build_package ${PROJECT_BINARY_DIR}/lib/cmake/grit)

set_target_properties(grit_sdk PROPERTIES EXPORT_NAME sdk)
install(TARGETS grit grit_sdk EXPORT grit LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY core/include/grit DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN *.hpp)
if(TARGET grit_app)
  set_target_properties(grit_app PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
  install(TARGETS grit_app RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

# The build tag demands the same SDK, so the version has to be the same too.
write_basic_package_version_file(${build_package}/grit-config-version.cmake COMPATIBILITY ExactVersion)
configure_file(cmake/grit-config.cmake ${build_package}/grit-config.cmake COPYONLY)
configure_file(cmake/GritPlugin.cmake ${build_package}/GritPlugin.cmake COPYONLY)
install(FILES cmake/grit-config.cmake cmake/GritPlugin.cmake ${build_package}/grit-config-version.cmake
        DESTINATION ${package})
install(EXPORT grit NAMESPACE grit:: FILE grit-targets.cmake DESTINATION ${package})
export(EXPORT grit NAMESPACE grit:: FILE ${build_package}/grit-targets.cmake)
