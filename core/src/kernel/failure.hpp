// Errors with which guards stop a simulation.
#pragma once

#include <string>

#include "grit/error.hpp"
#include "kernel/state.hpp"

namespace grit {

/// Keys from the root of the description to the part that caused a failure.
using Keys = std::vector<std::string>;

/// Throws NumericsError: step, time and stage, what was found, what to do.
[[noreturn]] void fail(const State& state, Guard guard, const Keys& keys, const std::string& what,
                       const std::string& advice);
/// The same for the body with this index, with its id and position.
[[noreturn]] void fail_at_body(const State& state, Guard guard, const Keys& keys, std::size_t body,
                               const std::string& what, const std::string& advice);
/// Keys of the group of the body with this index.
Keys group_keys(const State& state, std::size_t body);

}  // namespace grit
