// Curves given as formulas of wall forces, displacements, void ratio and time.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "grit/probe.hpp"

namespace grit {

class FormulaProbe : public Probe {
 public:
  struct Curve {
    std::string formula, unit = "1", doc;
    void declare(Parameters& parameters);
  };
  struct Constant {
    double value = 0;
    std::string doc;
    void declare(Parameters& parameters);
  };
  std::map<std::string, Curve> curves;
  std::map<std::string, Constant> constants;

  FormulaProbe();
  ~FormulaProbe() override;
  void declare(Parameters& parameters) override;
  /// Throws ParameterError for a formula that cannot be read, and for two walls or a constant that give the same
  /// variable.
  void prepare(const World& world) override;
  std::vector<Channel> channels() const override;
  void sample(const World& world, ChannelValues& values) override;

 private:
  struct Evaluation;
  std::unique_ptr<Evaluation> evaluation_;
};

}  // namespace grit
