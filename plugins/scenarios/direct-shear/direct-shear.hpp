// Direct shear test: sand between two frames; the upper one moves horizontally under a constant normal stress.
#pragma once

#include <string>

#include "grit/toolkit/preparation.hpp"

namespace grit {

class DirectShear final : public Scenario {
 public:
  void declare(Parameters& parameters) override;
  Description expand() const override;

  /// Void ratios that can be prepared; measured, see plugins/scenarios/README.md.
  VoidRatioRange reachable() const;
  /// Velocity of the upper frame during shear [m/s].
  double shear_velocity() const;

 private:
  Preparation preparation_;
  double width_ = 60e-3, height_ = 25e-3, depth_ = 5e-3;
  std::string depth_boundary_ = "walls";
  double wall_friction_angle_ = 0, local_damping_ = 0.08, normal_stress_ = 200e3;
  double shear_displacement_ = 6e-3, inertial_number_ = 1e-3, velocity_ = 0;
};

}  // namespace grit
