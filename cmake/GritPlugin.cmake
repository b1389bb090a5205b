# grit_plugin(<kind folder> <name> [LIBRARIES …]): builds <name>.cpp of the current folder into
# <build>/lib/grit/<kind folder>/<name>.so, and test_<name>.cpp, where there is one, into a test that sees the same code.
function(grit_plugin folder name)
  cmake_parse_arguments(arg "" "" "LIBRARIES" ${ARGN})
  set(target ${folder}_${name})
  add_library(${target}_objects OBJECT ${name}.cpp)
  set_target_properties(${target}_objects PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden
                        VISIBILITY_INLINES_HIDDEN ON)
  target_compile_options(${target}_objects PRIVATE -Wall -Wextra)
  target_link_libraries(${target}_objects PUBLIC grit::grit ${arg_LIBRARIES})
  add_library(${target} MODULE)
  target_link_libraries(${target} PRIVATE ${target}_objects)
  set_target_properties(${target} PROPERTIES PREFIX "" OUTPUT_NAME ${name}
                        LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib/grit/${folder})
  if(GRIT_TESTS AND EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/test_${name}.cpp)
    add_executable(test_${target} test_${name}.cpp)
    target_compile_options(test_${target} PRIVATE -Wall -Wextra)
    target_include_directories(test_${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
    target_link_libraries(test_${target} PRIVATE ${target}_objects GTest::gtest GTest::gmock GTest::gtest_main)
    gtest_discover_tests(test_${target} TEST_PREFIX "${folder}/${name}: " DISCOVERY_MODE PRE_TEST)
  endif()
endfunction()
