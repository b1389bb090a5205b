// Parts of walls' motions that come to nothing.
#pragma once

#include <string>
#include <vector>

#include "input/scene.hpp"

namespace grit {

/// One line each, with the pointer and why.
std::vector<std::string> unused_motions(const Scene& described);

}  // namespace grit
