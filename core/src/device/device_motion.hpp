// The motion of bodies on a device.
#pragma once

#include <cstdint>

#include "grit/contact/batch.hpp"
#include "motion/body_step.hpp"

namespace grit {

/// Extremes over the bodies of a chunk.
struct DeviceChunk {
  double low[3], high[3];  ///< bounds of velocities relative to the mean flow [m/s]
  double deepest;          ///< largest overlap over the smaller radius
  double poison;           ///< 0; NaN if a velocity or spin is not finite

  static constexpr DeviceChunk join(const DeviceChunk& a, const DeviceChunk& b) {
    DeviceChunk both{};
    for (int k = 0; k < 3; ++k) {
      both.low[k] = b.low[k] < a.low[k] ? b.low[k] : a.low[k];
      both.high[k] = b.high[k] > a.high[k] ? b.high[k] : a.high[k];
    }
    both.deepest = b.deepest > a.deepest ? b.deepest : a.deepest;
    both.poison = a.poison + b.poison;
    return both;
  }
};

/// Moves all bodies by one step under the forces on them. Arrays in the memory of the device, by body.
struct DeviceMotion {
  Row* position;
  Row* velocity;
  Row* spin;
  const BodySum* sum;  ///< as DevicePairs::sum
  double* rotation;    ///< three numbers a body; null if not kept
  DeviceChunk* chunk;  ///< out: by chunk
  std::uint32_t bodies;
  double drift;  ///< time step [s]
  Kick<Four> kick;
  MeanFlowStep<Four> mean;
  bool shears;

  /// Moves one body. Returns the extremes of it alone.
  constexpr DeviceChunk operator()(std::uint32_t i) const { return shears ? move<true>(i) : move<false>(i); }

 private:
  static constexpr Four four(const Row& row) { return {{row.x, row.y, row.z, 0}}; }

  template <bool Shears>
  constexpr DeviceChunk move(std::uint32_t i) const {
    const BodySum& acting = sum[i];
    const Four x = four(position[i]), before = four(velocity[i]), w = four(spin[i]);
    const double radius = position[i].w, inverse_mass = velocity[i].w, inverse_inertia = spin[i].w;
    const BodyStep<Four> step =
        step_of_body<Shears>(x, before, w, four(acting.force), four(acting.moment), inverse_mass, inverse_inertia,
                             weighing_share(radius, kick.scaled_radius), kick, mean);
    const Four v = step.free + step.pushed, turning = w + step.twisted, there = x + v * drift, against = v - step.flow;
    position[i] = {there[0], there[1], there[2], radius};
    velocity[i] = {v[0], v[1], v[2], inverse_mass};
    spin[i] = {turning[0], turning[1], turning[2], inverse_inertia};
    if (rotation != nullptr)
      for (std::uint32_t k = 0; k < 3; ++k) rotation[3 * i + k] += turning[static_cast<int>(k)] * drift;
    DeviceChunk alone{};
    for (int k = 0; k < 3; ++k) alone.low[k] = alone.high[k] = against[k], alone.poison += 0 * v[k] + 0 * turning[k];
    alone.deepest = acting.force.w;
    return alone;
  }
};

}  // namespace grit
