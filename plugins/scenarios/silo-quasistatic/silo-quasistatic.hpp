// Silo whose bottom is lowered: forces on bottom and walls at rest and while wall friction is mobilised.
#pragma once

#include "grit/toolkit/silo.hpp"

namespace grit {

class SiloQuasistatic final : public Scenario {
 public:
  void declare(Parameters& parameters) override;
  Description expand() const override;

 private:
  Silo silo_;
  double settlement_ = 30e-3, velocity_ = 10e-3;
};

}  // namespace grit
