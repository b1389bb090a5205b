// Slip of a specimen along a wall. See README.md.
#pragma once

#include <vector>

#include "grit/probe.hpp"
#include "grit/toolkit/wall_layer.hpp"

namespace grit {

class Slip final : public Probe {
 public:
  WallLayer layer;

  void declare(Parameters& parameters) override { layer.declare(parameters); }
  StateRequest needs() const override { return BodyState::displacement; }
  void prepare(const World& world) override { layer.prepare(world); }
  std::vector<Channel> channels() const override;
  void sample(const World& world, ChannelValues& values) override;
};

}  // namespace grit
