// Errors of grit as exceptions of Python.
#pragma once

#include <pybind11/pybind11.h>

namespace grit::python {

/// From now on errors arrive as the classes of `family`, the module grit.errors.
void translate_errors(const pybind11::module_& family);

}  // namespace grit::python
