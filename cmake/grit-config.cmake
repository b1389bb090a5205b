# find_package(grit): the targets grit::sdk (to compile against) and grit::grit (to link), and the function grit_plugin;
# if GTest was found before, grit::testing (contracts for a plugin's tests).
# GRIT_ARCH selects one of the installed instruction sets; it may be omitted if only one is installed.
file(GLOB installed RELATIVE ${CMAKE_CURRENT_LIST_DIR} ${CMAKE_CURRENT_LIST_DIR}/*/grit-targets.cmake)
list(TRANSFORM installed REPLACE "/.*" "")
list(LENGTH installed count)
if(NOT GRIT_ARCH AND count EQUAL 1)
  set(GRIT_ARCH ${installed})
endif()
if(NOT GRIT_ARCH IN_LIST installed)
  list(JOIN installed ", " installed)
  set(grit_FOUND FALSE)
  set(grit_NOT_FOUND_MESSAGE "GRIT_ARCH is \"${GRIT_ARCH}\"; select an installed instruction set with -DGRIT_ARCH=: \
${installed}")
  return()
endif()

include(${CMAKE_CURRENT_LIST_DIR}/${GRIT_ARCH}/grit-compiler.cmake)
string(REGEX MATCH "^[0-9]+" major "${CMAKE_CXX_COMPILER_VERSION}")
if(NOT "${CMAKE_CXX_COMPILER_ID} ${major}" STREQUAL grit_COMPILER)
  set(grit_FOUND FALSE)
  set(grit_NOT_FOUND_MESSAGE "grit was built with ${grit_COMPILER}, but the compiler is ${CMAKE_CXX_COMPILER_ID} ${major}; \
configure again with cmake --fresh … -DCMAKE_CXX_COMPILER=${grit_CXX_COMPILER}")
  return()
endif()

include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(Eigen3 3.4)
find_dependency(nlohmann_json 3.11)
include(${CMAKE_CURRENT_LIST_DIR}/${GRIT_ARCH}/grit-targets.cmake)
set(grit_TESTING_SOURCES ${CMAKE_CURRENT_LIST_DIR}/testing)
include(${CMAKE_CURRENT_LIST_DIR}/GritPlugin.cmake)
grit_testing()
