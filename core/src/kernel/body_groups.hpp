// Groups of bodies, where engines or walls act on some groups only.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernel/state.hpp"

namespace grit {

/// Names of the groups of bodies of a scene, ascending.
std::vector<std::string> group_names(const SceneDescription& scene);
/// The groups that `chosen` names; none chosen: an empty mask, for all.
GroupMask group_mask(const std::vector<std::string>& chosen, const std::vector<std::string>& names);
/// Finds the group of each body, if anything depends on it: after a change of settings, bodies or their order.
void find_groups(State& state);
/// Index of the group of each body.
std::vector<std::uint16_t> groups_of(const Bodies& bodies, const std::vector<std::string>& names);
/// Imposes planar and prescribed motions on the velocities of bodies. Throws Error for planar motion of clumps.
void constrain(Bodies& bodies, const Settings& settings);

}  // namespace grit
