// Values of materials and interfaces that change no contact.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "input/scene.hpp"

namespace grit {

/// One line each, with the pointer and why: with a little more and a little less of it all contacts that may be have
/// the same numbers, in all stages. Of those that `is_written(pointer)`.
std::vector<std::string> unused_materials(const Scene& scene,
                                          const std::function<bool(const std::string&)>& is_written);

}  // namespace grit
