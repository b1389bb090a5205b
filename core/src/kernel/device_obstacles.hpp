// What a device cannot do yet.
#pragma once

#include <string>
#include <vector>

#include "description/placed_error.hpp"
#include "kernel/state.hpp"

namespace grit {

/// What of these settings, and of bodies with this state, a device cannot step, with the place of each in the
/// description.
std::vector<PlacedError::Fault> device_obstacles(const Settings& settings, const std::vector<std::string>& walls,
                                                 const StateRequest& bodies);
/// Throws PlacedError if there is any now.
void refuse_obstacles(const State& state);

}  // namespace grit
