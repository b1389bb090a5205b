# Debian packages, made by `scripts/package.sh --deb` with CPack: grit, grit-mpi, grit-dev, python3-grit and grit-doc. A component is a
# package; `cmake --install` installs all of them, without what only packages have.
set(CPACK_COMPONENTS_ALL grit grit-dev python3-grit grit-doc)
if(TARGET grit_mpi)
  list(APPEND CPACK_COMPONENTS_ALL grit-mpi)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_GENERATOR DEB)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

# The version of a package: a release's if its commit has the tag, else earlier than that, in the order of commits.
set(maintainer "The grit authors <grit@localhost>")
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
set(version ${PROJECT_VERSION})
find_package(Git QUIET)
if(Git_FOUND)
  function(git_says result)
    execute_process(COMMAND ${GIT_EXECUTABLE} ${ARGN} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
                    OUTPUT_VARIABLE says OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed ERROR_QUIET)
    if(NOT failed)
      set(${result} "${says}" PARENT_SCOPE)
    endif()
  endfunction()
  git_says(maintainer log -1 "--format=%an <%ae>")
  git_says(date log -1 --format=%cD)
  git_says(tag describe --tags --exact-match --match v${PROJECT_VERSION})
  git_says(commit log -1 --abbrev=8 --date=format:%Y%m%d%H%M "--format=%cd.%h")
  if(commit AND NOT tag)
    set(version ${version}~git${commit})
  endif()
endif()
set(CPACK_DEBIAN_PACKAGE_VERSION ${version})
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(version ${version}-1)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "${maintainer}")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/lib/grit)

# package(NAME SECTION SUMMARY TEXT FIELD VALUE…): what dpkg shows, and other fields of its control file. SHLIBDEPS ON for those with
# programs: CPack looks into each file.
function(package name section summary text)
  string(TOUPPER ${name} upper)
  set(prefix CPACK_DEBIAN_${upper}_)
  set(${prefix}PACKAGE_NAME ${name} PARENT_SCOPE)
  set(${prefix}PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(${prefix}DESCRIPTION "${summary}\n${text}" PARENT_SCOPE)
  while(ARGN)
    list(POP_FRONT ARGN field value)
    set(${prefix}PACKAGE_${field} "${value}" PARENT_SCOPE)
  endwhile()
  # EXCLUDE_FROM_ALL: in packages only.
  set(own ${PROJECT_BINARY_DIR}/packages)
  install(FILES ${own}/copyright ${own}/changelog.Debian.gz ${own}/changelog.gz
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${name} EXCLUDE_FROM_ALL)
endfunction()
string(REGEX MATCH "^[0-9]+" major "${CMAKE_CXX_COMPILER_VERSION}")
string(TOLOWER "${CMAKE_CXX_COMPILER_ID}-${major}" compiler)
string(REPLACE "gnu-" "g++-" compiler ${compiler})
set(about "A JSON file describes a test of granular mechanics; one program runs it and
writes curves, maps and pictures of the grains. Contact laws, wall geometries,
probes and scenarios are plugins.
")
package(grit science "discrete element method for sand, shear zones and silos"
  "${about}
This package has the program and its plugins for several instruction sets,
of which it takes the best that the processor has."
  SHLIBDEPS ON RECOMMENDS "librsvg2-bin" SUGGESTS "grit-doc, python3-grit, grit-mpi")
if(TARGET grit_mpi)
  package(grit-mpi science "discrete element method - runs in several processes"
    "${about}
This package has what grit needs when mpirun or srun starts it."
    SHLIBDEPS ON DEPENDS "grit (= ${version}), openmpi-bin")
endif()
package(grit-dev libdevel "discrete element method - headers for plugins and programs"
  "${about}
This package has the headers, the CMake package and the contracts that test
a plugin."
  DEPENDS "grit (= ${version}), cmake, ${compiler}, libboost-dev, libeigen3-dev, nlohmann-json3-dev"
  RECOMMENDS "libgtest-dev, libgmock-dev" SUGGESTS "grit-doc")
set(python_depends "python3")
if(TARGET grit_python)
  get_target_property(python grit_python GRIT_PYTHON_VERSION)
  string(REGEX MATCH "^([0-9]+)\\.([0-9]+)" python ${python})
  math(EXPR next "${CMAKE_MATCH_2} + 1")
  set(python_depends "python3 (>= ${python}), python3 (<< ${CMAKE_MATCH_1}.${next})")
endif()
package(python3-grit python "discrete element method - Python module"
  "${about}
This package has the Python module, which drives simulations and reads results."
  SHLIBDEPS ON DEPENDS "grit (= ${version}), ${python_depends}, python3-numpy, python3-h5py"
  SUGGESTS "python3-matplotlib")
package(grit-doc doc "discrete element method - documentation"
  "${about}
This package has the documentation, and descriptions of tests as examples."
  ARCHITECTURE all)

# Files of packages. Scripts as dh_python3 writes them.
set(own ${PROJECT_BINARY_DIR}/packages)
set(CPACK_DEBIAN_PYTHON3-GRIT_PACKAGE_CONTROL_EXTRA "${own}/postinst;${own}/prerm")
file(READ LICENSE licence)
file(READ ${VEGA_LICENCE} vega)
file(WRITE ${own}/copyright "grit\n\n${licence}\n\nThe library contains parts of Vega, of which this is the file of copyrights:\n\n${vega}")
file(WRITE ${own}/changelog.Debian "grit (${version}) unstable; urgency=medium\n\n  * See changelog.gz.\n\n -- ${maintainer}  ${date}\n")
file(COPY_FILE CHANGELOG.md ${own}/changelog)
execute_process(COMMAND gzip -9nf ${own}/changelog.Debian ${own}/changelog COMMAND_ERROR_IS_FATAL ANY)
file(WRITE ${own}/postinst "#!/bin/sh\nset -e\nif [ \"$1\" = configure ] && command -v py3compile > /dev/null; then\n  py3compile -p python3-grit\nfi\n")
file(WRITE ${own}/prerm "#!/bin/sh\nset -e\nif command -v py3clean > /dev/null; then\n  py3clean -p python3-grit\nfi\n")
file(CHMOD ${own}/postinst ${own}/prerm PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
include(CPack)
