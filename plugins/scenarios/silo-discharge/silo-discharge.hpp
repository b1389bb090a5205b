// Silo that discharges through slots in its bottom.
#pragma once

#include <vector>

#include "grit/toolkit/silo.hpp"

namespace grit {

class SiloDischarge final : public Scenario {
 public:
  void declare(Parameters& parameters) override;
  Description expand() const override;

  /// Discharge rate of all outlets by Beverloo's law for slots [kg/s].
  double expected_rate() const;

 private:
  struct Slot {
    double low, high;  ///< m, along x
  };
  /// From left to right.
  std::vector<Slot> outlets() const;

  Silo silo_;
  std::vector<double> outlet_positions_, outlet_widths_{30e-3}, discharged_fractions_{0.1, 0.25, 0.5};
};

}  // namespace grit
