// How a guard stops a simulation.
#pragma once

#include <string>

#include "grit/error.hpp"
#include "kernel/state.hpp"

namespace grit {

/// Throws NumericsError: step, time and stage, what was found, what to do.
[[noreturn]] void fail(const State& state, Guard guard, const std::string& what, const std::string& advice);
/// The same for the body with this index, with its id and place.
[[noreturn]] void fail_at_body(const State& state, Guard guard, std::size_t body, const std::string& what,
                               const std::string& advice);

}  // namespace grit
