// Test of a representative volume: sand in a periodic cell is compressed isotropically; then it is compressed along one
// axis, or sheared.
#pragma once

#include <string>

#include "grit/toolkit/preparation.hpp"

namespace grit {

class RepresentativeVolume final : public Scenario {
 public:
  RepresentativeVolume();
  void declare(Parameters& parameters) override;
  Description expand() const override;

  /// Rate of axial or shear strain during the test [1/s].
  double strain_rate() const { return inertial_number_ / preparation_.inertial_time(confining_stress_); }
  /// Strain rate during isotropic compression [1/s].
  double compression_rate() const {
    return preparation_.inertial_number / preparation_.inertial_time(confining_stress_);
  }

 private:
  bool shears() const { return test_ == "simple-shear"; }
  Description test_stage(double duration) const;
  void add_curves(Description& d, double duration) const;

  Preparation preparation_;
  std::int64_t grains_ = 2000;
  std::string test_ = "triaxial";
  double confining_stress_ = 200e3, strain_ = 0.3, inertial_number_ = 1e-3, local_damping_ = 0.08;
  double preparation_friction_angle_ = 2 * degree;
};

}  // namespace grit
