# Refuses code for GPUs from which nvcc has left out functions: it puts a trap in place of a call that a GPU cannot make.
#   cmake -DPTX=FILE -DSOURCE=FILE -P GritPtx.cmake
file(READ ${PTX} code)
string(FIND "${code}" "trap;" place)
if(NOT place EQUAL -1)
  file(REMOVE ${PTX})
  message(FATAL_ERROR "${SOURCE}: a function that evaluate() or reach() of the law calls is not constexpr, so that GPUs cannot run it; "
                      "make it constexpr, or set GRIT_CUDA to OFF")
endif()
