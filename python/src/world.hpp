// The state of a simulation for Python.
#pragma once

#include <pybind11/pybind11.h>

#include "driver.hpp"

namespace grit::python {

/// Adds what reads the state to the class of simulations.
void bind_world(py::class_<Driver>& simulation);

}  // namespace grit::python
