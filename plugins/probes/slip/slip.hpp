// Slip of a specimen along a wall. See README.md.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "grit/probe.hpp"

namespace grit {

class Slip final : public Probe {
 public:
  std::string wall, driven_by, axis = "x";
  double thickness = 0.5;  ///< of the layer at the wall, mean diameters

  void declare(Parameters& parameters) override;
  StateRequest needs() const override { return BodyState::displacement; }
  /// Throws Error for a wall that does not exist, that is not perpendicular to an axis, or along whose normal the slip
  /// would be.
  void prepare(const World& world) override;
  std::vector<Channel> channels() const override;
  void sample(const World& world, std::span<const std::span<double>> values) override;

 private:
  std::size_t wall_ = 0, driver_ = 0;
  int axis_ = 0, across_ = 2;
};

}  // namespace grit
