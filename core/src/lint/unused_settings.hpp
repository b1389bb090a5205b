// Parts of a description that change nothing.
#pragma once

#include <string>
#include <vector>

#include "input/scene.hpp"
#include "kernel/kernel.hpp"

namespace grit {

/// One line each, with the pointer of the part and why; `components` and `kernel` are of the scene at its start.
std::vector<std::string> unused_settings(const Scene& described, const Components& components, const Kernel& kernel);

}  // namespace grit
