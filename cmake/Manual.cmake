# Writes the manual pages of the program, compressed.
#   cmake -DPROGRAM=grit -DFOLDER=DIR -P Manual.cmake
# A program of an instruction set that this processor lacks writes none: they are those of any other.
file(REMOVE_RECURSE ${FOLDER})
execute_process(COMMAND ${CMAKE_COMMAND} -E env --unset=GRIT_ISA ${PROGRAM} manual --out ${FOLDER} RESULT_VARIABLE result)
if(result MATCHES "Illegal instruction|^132$")
  message(STATUS "no manual pages, as this processor cannot run the program")
elseif(NOT result EQUAL 0)
  message(FATAL_ERROR "${PROGRAM} manual: ${result}")
endif()
file(GLOB pages ${FOLDER}/*.1)
if(pages)
  execute_process(COMMAND gzip -9n ${pages} COMMAND_ERROR_IS_FATAL ANY)
endif()
file(MAKE_DIRECTORY ${FOLDER})
file(TOUCH ${FOLDER}.written)
