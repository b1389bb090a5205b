// Parameters that a plugin declares, with functions that name it when they throw.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "grit/parameters.hpp"

namespace grit {

/// Calls `declare`, and guards the functions that it leaves in `parameters`: checks, declarations of nested objects,
/// choices, and what is called when the object was read. `title`, `function`: what threw, as in at_boundary().
void guard_declared(const std::string& title, std::string_view function, Parameters& parameters,
                    const std::function<void()>& declare);

}  // namespace grit
