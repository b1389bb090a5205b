# Included before project(): selects clang 16 or newer, if installed, unless a compiler is named. Its contact loops take four
# fifths of the time of those of g++ 12, which keeps fewer values in registers (docs/evidence/performance.md).
if(NOT CMAKE_CXX_COMPILER AND NOT DEFINED ENV{CXX})
  function(grit_new_enough result compiler)
    execute_process(COMMAND ${compiler} --version OUTPUT_VARIABLE says ERROR_QUIET)
    if(NOT says MATCHES "clang version ([0-9]+)" OR CMAKE_MATCH_1 LESS 16)
      set(${result} FALSE PARENT_SCOPE)
    endif()
  endfunction()
  find_program(GRIT_CLANG NAMES clang++ clang++-19 clang++-18 clang++-17 clang++-16 VALIDATOR grit_new_enough
               DOC "The compiler, unless CMAKE_CXX_COMPILER or CXX names one")
  mark_as_advanced(GRIT_CLANG)
  if(GRIT_CLANG)
    set(CMAKE_CXX_COMPILER ${GRIT_CLANG})
  else()
    message(STATUS "clang 16 or newer not found: contact loops will be slower")
  endif()
endif()
