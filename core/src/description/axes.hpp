// Names of the axes.
#pragma once

#include <string>
#include <vector>

namespace grit {

inline const std::vector<std::string> one_axis{"x", "y", "z"};

}  // namespace grit
