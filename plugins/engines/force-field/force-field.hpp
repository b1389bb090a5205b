// A force on each body as formulas of its position, velocity and time.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "grit/engine.hpp"

namespace grit {

class ForceField final : public Engine {
 public:
  struct Constant {
    double value = 0;
    std::string doc;
    void declare(Parameters& parameters);
  };
  std::array<std::string, 3> formulas{"0", "0", "0"};
  std::string per = "mass";
  std::map<std::string, Constant> constants;

  ForceField();
  ~ForceField() override;
  void declare(Parameters& parameters) override;
  Phase phase() const override { return Phase::forces; }
  void forces(const World& world, std::span<Row> force, std::span<Row> moment) const override;
  /// By differences over small displacements and changes of velocity of the bodies where they are.
  EngineRates rates(const World& world) const override;

 private:
  struct Evaluation;
  /// The compiled formulas, with the present values of the constants.
  Evaluation& evaluation() const;

  mutable std::unique_ptr<Evaluation> evaluation_;
};

}  // namespace grit
