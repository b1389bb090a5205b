# find_package(grit): the targets grit::sdk (to compile against) and grit::grit (to link), and the function grit_plugin.
include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(Eigen3 3.4)
find_dependency(nlohmann_json 3.11)
include(${CMAKE_CURRENT_LIST_DIR}/grit-targets.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/GritPlugin.cmake)
