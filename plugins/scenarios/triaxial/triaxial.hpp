// Triaxial test: six smooth walls compress a specimen isotropically; then top and bottom close.
#pragma once

#include <optional>
#include <string>

#include "grit/toolkit/preparation.hpp"

namespace grit {

class Triaxial final : public Scenario {
 public:
  Triaxial();
  void declare(Parameters& parameters) override;
  Description expand() const override;

  /// Void ratios that can be prepared; measured, see plugins/scenarios/README.md.
  VoidRatioRange reachable() const;
  /// Rate of axial strain during compression [1/s].
  double strain_rate() const;

 private:
  Preparation preparation_;
  Vec3 size_ = Vec3::Constant(100e-3);
  double confining_stress_ = 200e3, axial_strain_ = 0.3, inertial_number_ = 1e-4, local_damping_ = 0.08;
  std::string front_and_back_ = "confining-stress";
  std::optional<double> intermediate_stress_, internal_friction_angle_;
};

}  // namespace grit
