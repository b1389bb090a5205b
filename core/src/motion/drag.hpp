// Drag of a fluid on bodies.
#pragma once

#include "grit/engine.hpp"

namespace grit {

/// Drag of a fluid of uniform velocity, on bodies alone: it does not account for neighbours and does not move the
/// fluid.
class Drag final : public Engine {
 public:
  void declare(Parameters& parameters) override;
  Phase phase() const override { return Phase::forces; }
  void forces(const World& world, std::span<Row> force, std::span<Row> moment) const override;
  EngineRates rates(const World& world) const override;

  /// Drag force over velocity [N s/m] of a sphere of this diameter [m] at a relative speed [m/s].
  double coefficient(double diameter, double speed) const;

 private:
  struct Grain {
    double diameter;  ///< of a sphere of the same volume [m]
    Vec3 velocity, spin;
    double inverse_mass, inverse_inertia;
  };
  template <class Use>
  void each_grain(const World& world, Use use) const;

  double viscosity_ = 0, density_ = 0;  // Pa s, kg/m³
  Vec3 velocity_ = Vec3::Zero();        // m/s
  std::string law_ = "schiller-naumann";
};

}  // namespace grit
