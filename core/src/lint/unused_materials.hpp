// Values of materials and interfaces that change no contact.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "input/scene.hpp"

namespace grit {

/// One line each, with the pointer and why: with a little more and a little less of it whatever meets comes to the same
/// numbers, in all stages. Of those that `is_written(pointer)`; `with("/pointer=value")` reads the scene again.
std::vector<std::string> unused_materials(const Scene& scene, const std::function<bool(const std::string&)>& is_written,
                                          const std::function<Scene(const std::string&)>& with);

}  // namespace grit
