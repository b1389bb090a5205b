// Density scaling: the masses and moments of inertia that MotionSettings::scaled_radius gives to small bodies.
#pragma once

#include <vector>

#include "bodies/bodies.hpp"
#include "kernel/settings.hpp"

namespace grit {

/// Mass without density scaling over mass of each body; empty if no body is scaled.
std::vector<double> unscaled_shares(const Bodies& bodies, const Settings& settings);

/// Gives bodies with masses and moments of inertia by the settings `before` those by the settings `now`; velocities and
/// spins are kept. Returns the mass gained [kg].
double scale_masses(Bodies& bodies, const Settings& before, const Settings& now);

}  // namespace grit
