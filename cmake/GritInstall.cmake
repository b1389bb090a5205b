# Installation: <prefix>/lib/grit/<arch> with the library, the program and, by GritPlugin.cmake, the plugins; the launcher as
# <prefix>/bin/grit; its manual pages and completions; the SDK headers, its CMake package and the documentation. Builds for
# several instruction sets can share a prefix: only this folder and the targets of the package are separate. The package is
# also written to the build folder, for plugins that are built against it.
include(CMakePackageConfigHelpers)
set(own ${CMAKE_INSTALL_LIBDIR}/grit/${GRIT_ARCH})
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/grit)
set(build_package ${PROJECT_BINARY_DIR}/lib/cmake/grit)

set_target_properties(grit_sdk PROPERTIES EXPORT_NAME sdk)
install(TARGETS grit grit_sdk EXPORT grit LIBRARY DESTINATION ${own})
install(DIRECTORY ${PROJECT_BINARY_DIR}/lib/grit/studies DESTINATION ${own} OPTIONAL)
install(DIRECTORY python/grit DESTINATION ${GRIT_PYTHON_DIR} COMPONENT python3-grit FILES_MATCHING PATTERN *.py)
install(DIRECTORY core/include/grit DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT grit-dev FILES_MATCHING PATTERN *.hpp)
# In the places that they have here, so that links between pages hold.
set(documentation ${CMAKE_INSTALL_DATADIR}/doc/grit)
install(FILES LICENSE DESTINATION ${documentation} COMPONENT licence)  # packages have it in their file copyright
install(FILES README.md CONTRIBUTING.md CHANGELOG.md CITATION.cff DESTINATION ${documentation} COMPONENT grit-doc)
install(DIRECTORY docs sims DESTINATION ${documentation} COMPONENT grit-doc PATTERN Doxyfile EXCLUDE PATTERN site EXCLUDE)
install(FILES bench/README.md DESTINATION ${documentation}/bench COMPONENT grit-doc)
install(DIRECTORY plugins DESTINATION ${documentation} COMPONENT grit-doc
        FILES_MATCHING PATTERN *.md PATTERN *.png PATTERN *.svg)
install(DIRECTORY python/examples DESTINATION ${documentation}/python COMPONENT grit-doc FILES_MATCHING PATTERN *.py)
install(CODE "set(SOURCE \"${PROJECT_SOURCE_DIR}\")
  set(DOCUMENTATION \"${documentation}\")
  set(HEADERS \"${CMAKE_INSTALL_INCLUDEDIR}\")
  set(PYTHON \"${GRIT_PYTHON_DIR}\")
  include(\"${PROJECT_SOURCE_DIR}/cmake/InstalledDocs.cmake\")" COMPONENT grit-doc)
if(TARGET grit_mpi)
  install(TARGETS grit_mpi LIBRARY DESTINATION ${own} COMPONENT grit-mpi)
endif()
if(TARGET grit_cuda)
  set_target_properties(grit_cuda PROPERTIES INSTALL_RPATH "$ORIGIN")
  install(TARGETS grit_cuda LIBRARY DESTINATION ${own})
endif()
if(TARGET grit_app)
  set_target_properties(grit_app PROPERTIES INSTALL_RPATH "$ORIGIN")
  install(TARGETS grit_app RUNTIME DESTINATION ${own})
  install(TARGETS grit_launcher RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(DIRECTORY ${PROJECT_BINARY_DIR}/share/man/man1 DESTINATION ${CMAKE_INSTALL_MANDIR})
  install(FILES core/src/app/completion/grit.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME grit)
  install(FILES core/src/app/completion/_grit DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
endif()

file(REMOVE_RECURSE ${build_package})  # removes targets of an earlier GRIT_ARCH
write_basic_package_version_file(${build_package}/grit-config-version.cmake COMPATIBILITY SameMinorVersion)
string(REGEX MATCH "^[0-9]+" major "${CMAKE_CXX_COMPILER_VERSION}")
file(WRITE ${build_package}/${GRIT_ARCH}/grit-compiler.cmake
     "set(grit_COMPILER \"${CMAKE_CXX_COMPILER_ID} ${major}\")\nset(grit_CXX_COMPILER \"${CMAKE_CXX_COMPILER}\")\n")
file(RELATIVE_PATH grit_command /${package} /${CMAKE_INSTALL_BINDIR}/grit)
configure_file(cmake/grit-config.cmake.in ${build_package}/grit-config.cmake @ONLY)
configure_file(cmake/GritPlugin.cmake ${build_package}/GritPlugin.cmake COPYONLY)
configure_file(cmake/GritPtx.cmake ${build_package}/GritPtx.cmake COPYONLY)
file(GLOB contracts CONFIGURE_DEPENDS ${grit_TESTING_SOURCES}/*.cpp)
foreach(contract ${contracts})
  cmake_path(GET contract FILENAME file)
  configure_file(${contract} ${build_package}/testing/${file} COPYONLY)
endforeach()
install(FILES ${contracts} DESTINATION ${package}/testing COMPONENT grit-dev)
install(FILES ${build_package}/grit-config.cmake cmake/GritPlugin.cmake cmake/GritPtx.cmake ${build_package}/grit-config-version.cmake
        DESTINATION ${package} COMPONENT grit-dev)
install(FILES ${build_package}/${GRIT_ARCH}/grit-compiler.cmake DESTINATION ${package}/${GRIT_ARCH} COMPONENT grit-dev)
install(EXPORT grit NAMESPACE grit:: FILE grit-targets.cmake DESTINATION ${package}/${GRIT_ARCH} COMPONENT grit-dev)
export(EXPORT grit NAMESPACE grit:: FILE ${build_package}/${GRIT_ARCH}/grit-targets.cmake)
