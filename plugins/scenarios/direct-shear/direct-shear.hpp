// Direct shear test: sand between two frames, the upper one driven sideways under a constant normal stress.
#pragma once

#include <cstdint>
#include <numbers>
#include <string>

#include "grit/scenario.hpp"

namespace grit {

/// Void ratios of the interior that a grading, pressure and stiffness can be brought to.
struct VoidRatioRange {
  double densest, loosest;
};

class DirectShear final : public Scenario {
 public:
  void declare(Parameters& parameters) override;
  Description expand() const override;

  /// What preparation can reach; the figures were measured, see README.md.
  VoidRatioRange reachable() const;
  double mean_diameter() const { return 0.5 * (smallest_diameter_ + largest_diameter_); }
  /// Of the upper frame while it shears [m/s].
  double shear_velocity() const;
  /// Grains that fill the box at the wanted void ratio.
  std::int64_t grains() const;

 private:
  static constexpr double degree = std::numbers::pi / 180;

  double width_ = 60e-3, height_ = 25e-3, depth_ = 5e-3;
  std::string depth_boundary_ = "walls";
  double smallest_diameter_ = 0.25e-3, largest_diameter_ = 0.75e-3;
  double density_ = 2600, friction_angle_ = 18 * degree, wall_friction_angle_ = 0, local_damping_ = 0.08;
  double normal_stress_ = 200e3, void_ratio_ = 0.6;
  double shear_displacement_ = 6e-3, inertial_number_ = 1e-3, velocity_ = 0;
  double preparation_inertial_number_ = 3e-3;
  std::int64_t seed_ = 1;
};

}  // namespace grit
