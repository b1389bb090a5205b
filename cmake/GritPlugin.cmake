# grit_plugin(<kind folder> <name> [LIBRARIES …]): builds <name>.cpp of the current folder into
# <build>/lib/grit/<kind folder>/<name>.so, and test_<name>.cpp, if it exists and the project has found GTest, into a test
# that has access to the same code, links the contract of its kind and runs in the plugin's folder. `cmake --install` installs the plugin
# into lib/grit/<arch>, where grit of the same instruction set searches. The target grit_plugins builds all plugins of a
# project. Where nvcc is, a contact law is also compiled for GPUs. Part of the installed SDK.
include(GNUInstallDirs)
include(GoogleTest)

option(GRIT_CUDA "Compile contact laws for GPUs, too, if nvcc is found" ON)
if(GRIT_CUDA)
  find_program(GRIT_NVCC nvcc PATHS /usr/local/cuda/bin DOC "compiler of CUDA")
  if(GRIT_NVCC)
    execute_process(COMMAND ${GRIT_NVCC} --version OUTPUT_VARIABLE grit_cuda_version)
    string(REGEX MATCH "release ([0-9.]+)" grit_cuda_version "${grit_cuda_version}")
    if(CMAKE_MATCH_1 VERSION_LESS 12.8)
      message(STATUS "${GRIT_NVCC} is of CUDA ${CMAKE_MATCH_1}; needed is 12.8 or later")
      set(GRIT_NVCC "")
    endif()
  endif()
endif()
# Code for any GPU from Ampere on; the driver translates it for the one that is there.
set(grit_nvcc_flags -std=c++20 -arch=compute_80 --expt-relaxed-constexpr -O3 -diag-suppress 20012,186)

# Adds the GPU's code of a contact law to its objects, as grit_ptx.
function(grit_ptx target source)
  set(ptx ${CMAKE_CURRENT_BINARY_DIR}/${target}.ptx)
  set(embedded ${CMAKE_CURRENT_BINARY_DIR}/${target}_ptx.cpp)
  set(source ${CMAKE_CURRENT_SOURCE_DIR}/${source})
  add_custom_command(OUTPUT ${ptx} DEPENDS ${source} DEPFILE ${ptx}.d COMMAND_EXPAND_LISTS VERBATIM
    COMMENT "Compiling ${target} for GPUs"
    COMMAND ${GRIT_NVCC} ${grit_nvcc_flags} "-I$<JOIN:$<TARGET_PROPERTY:${target},INCLUDE_DIRECTORIES>,;-I>"
            -MD -MF ${ptx}.d -x cu -ptx -o ${ptx} ${source}
    COMMAND ${CMAKE_COMMAND} -DPTX=${ptx} -DSOURCE=${source} -P ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/GritPtx.cmake)
  file(CONFIGURE OUTPUT ${embedded} @ONLY CONTENT
"asm(\".pushsection .rodata\\n.globl grit_ptx, grit_ptx_end\\n.hidden grit_ptx, grit_ptx_end\\n\"
    \"grit_ptx: .incbin \\\"${ptx}\\\"\\n.byte 0\\ngrit_ptx_end:\\n.popsection\");
")
  set_source_files_properties(${embedded} PROPERTIES OBJECT_DEPENDS ${ptx} SKIP_UNITY_BUILD_INCLUSION ON)
  target_sources(${target} PRIVATE ${embedded})
endfunction()

# Contracts are tests that every plugin of a kind must pass (grit/testing): each is a library that is compiled once per project, when
# a test links it. grit::testing is all of them.
function(grit_testing)
  if(TARGET grit_testing OR NOT TARGET GTest::gtest)
    return()
  endif()
  add_library(grit_testing INTERFACE)
  add_library(grit::testing ALIAS grit_testing)
  file(GLOB sources CONFIGURE_DEPENDS ${grit_TESTING_SOURCES}/*.cpp)
  foreach(source ${sources})
    cmake_path(GET source STEM contract)
    set(target grit_testing_${contract})
    add_library(${target} STATIC EXCLUDE_FROM_ALL ${source})
    target_compile_options(${target} PRIVATE -Wall -Wextra $<$<NOT:$<CONFIG:Debug>>:-O1>)
    target_link_libraries(${target} PUBLIC grit::grit grit::sdk GTest::gtest)
    if(TARGET grit_precompiled_testing)  # within grit's own tree
      target_precompile_headers(${target} REUSE_FROM grit_precompiled_testing)
    endif()
    target_link_libraries(grit_testing INTERFACE ${target})
  endforeach()
endfunction()

function(grit_plugin folder name)
  cmake_parse_arguments(arg "" "" "LIBRARIES" ${ARGN})
  set(kinds contacts geometry probes engines scenarios bodies)
  set(contracts contact_law geometry probe engine scenario none)
  if(NOT folder IN_LIST kinds)
    list(JOIN kinds ", " allowed)
    message(FATAL_ERROR "grit_plugin(${folder} ${name}): \"${folder}\" is no kind of plugin; allowed are ${allowed}")
  endif()
  set(target ${folder}_${name})
  # A plugin is compiled against the SDK alone; only the link needs the library.
  add_library(${target}_objects OBJECT ${name}.cpp)
  set_target_properties(${target}_objects PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden
                        VISIBILITY_INLINES_HIDDEN ON)
  # Without a build type there is no optimisation, which makes a contact law slower by an order of magnitude.
  target_compile_options(${target}_objects PRIVATE -Wall -Wextra $<$<CONFIG:>:-O3>)
  target_link_libraries(${target}_objects PUBLIC grit::sdk ${arg_LIBRARIES})
  if(TARGET grit_precompiled_hidden)  # within grit's own tree
    target_precompile_headers(${target}_objects REUSE_FROM grit_precompiled_hidden)
  endif()
  if(folder STREQUAL contacts AND GRIT_NVCC)
    grit_ptx(${target}_objects ${name}.cpp)
  endif()
  add_library(${target} MODULE)
  target_link_libraries(${target} PRIVATE ${target}_objects grit::grit)
  set_target_properties(${target} PROPERTIES PREFIX "" OUTPUT_NAME ${name}
                        LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib/grit/${folder}
                        INSTALL_RPATH "$ORIGIN/..")
  install(TARGETS ${target} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/grit/${GRIT_ARCH}/${folder})
  if(NOT TARGET grit_plugins)
    add_custom_target(grit_plugins)
  endif()
  add_dependencies(grit_plugins ${target})

  if(TARGET GTest::gtest_main AND TARGET GTest::gmock AND EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/test_${name}.cpp)
    grit_testing()
    add_executable(test_${target} test_${name}.cpp)
    # Only the plugin is fully optimised; its test builds faster.
    target_compile_options(test_${target} PRIVATE -Wall -Wextra $<$<NOT:$<CONFIG:Debug>>:-O1>)
    list(FIND kinds ${folder} kind)
    list(GET contracts ${kind} contract)
    target_link_libraries(test_${target} PRIVATE ${target}_objects $<TARGET_NAME_IF_EXISTS:grit_testing_${contract}> GTest::gmock
                                                 GTest::gtest_main)
    if(TARGET grit_precompiled_testing)
      target_precompile_headers(test_${target} REUSE_FROM grit_precompiled_testing)
      target_include_directories(test_${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
    endif()
    gtest_discover_tests(test_${target} TEST_PREFIX "${folder}/${name}: " DISCOVERY_MODE PRE_TEST
                         WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
  endif()
endfunction()
