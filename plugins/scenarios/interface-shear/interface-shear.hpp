// Interface shear test: a box of sand moves over a flat, saw-tooth or sinusoidal surface under a constant normal
// stress.
#pragma once

#include <optional>
#include <string>

#include "grit/toolkit/preparation.hpp"

namespace grit {

class InterfaceShear final : public Scenario {
 public:
  void declare(Parameters& parameters) override;
  Description expand() const override;

  /// Void ratios that can be prepared; measured, see plugins/scenarios/README.md.
  VoidRatioRange reachable() const;
  /// Velocity of the box during shear [m/s].
  double shear_velocity() const;

 private:
  /// From tips to valleys [m]; 0 if the surface is flat.
  double groove_depth() const;
  /// Angle of the flanks of a saw-tooth surface [rad].
  double groove_inclination() const;
  /// Period of the grooves [m].
  double groove_spacing() const;
  /// Volume below the tips per area of the surface [m].
  double groove_volume() const;
  Description surface(double reach) const;

  Preparation preparation_;
  double width_ = 100e-3, height_ = 20e-3, depth_ = 5e-3;
  std::string depth_boundary_ = "walls", surface_ = "saw-tooth";
  double roughness_ = 1;
  std::optional<double> groove_inclination_, groove_spacing_;
  double depth_over_wavelength_ = 0.24, wavelength_ = 15e-3;
  double surface_friction_angle_ = 18 * degree, local_damping_ = 0.08;
  std::optional<double> internal_friction_angle_;
  double gap_ = 0, normal_stress_ = 100e3, shear_displacement_ = 7e-3, inertial_number_ = 1e-3;
};

}  // namespace grit
