// Bodies that nothing moves.
#pragma once

#include <optional>

#include "grit/world.hpp"
#include "input/scene.hpp"
#include "lint/unused_setting.hpp"

namespace grit {

/// A message if no body can move in any stage: without contacts of bodies that are free, velocities and forces at the
/// start, without gravity and other forces, walls that move, growth, and deformation of the domain. Also if bodies have
/// velocities only, but enter in a stream, or should come to rest on each other. `world` is that of the initial scene.
std::optional<UnusedSetting> unmoved_bodies(const Scene& described, const World& world);

}  // namespace grit
