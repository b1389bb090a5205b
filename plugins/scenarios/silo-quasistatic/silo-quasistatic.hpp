// Silo with a lowered bottom: forces on bottom and walls at rest and during mobilisation of wall friction.
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
