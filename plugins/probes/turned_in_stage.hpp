// How far bodies have turned in a stage: worlds know how far they have since the start of the run.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "grit/memory.hpp"
#include "grit/world.hpp"

namespace grit {

/// Counts about one axis, of each body from the first look at it in the stage.
class TurnedInStage {
 public:
  /// Before looking at bodies of a sample.
  void begin(const World& world) {
    if (world.stage() != stage_) stage_ = world.stage(), before_.clear();
  }
  /// Of the body at `index`, whose rotation about the axis since the start of the run is `turned` [rad].
  double operator()(const World& world, std::size_t index, double turned) {
    const std::size_t id = world.ids()[index];
    if (id >= before_.size()) before_.resize(id + 1, std::numeric_limits<double>::quiet_NaN());
    if (std::isnan(before_[id])) before_[id] = turned;
    return turned - before_[id];
  }
  void remember(Memory& memory) { memory(stage_, before_); }

 private:
  std::string stage_;
  std::vector<double> before_;  ///< rad, by id; NaN: not looked at yet
};

}  // namespace grit
