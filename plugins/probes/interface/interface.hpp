// What a wall does to the bodies next to it, as boundary conditions of a micropolar continuum. See README.md.
#pragma once

#include <string>
#include <vector>

#include "grit/probe.hpp"
#include "grit/toolkit/wall_layer.hpp"

namespace grit {

class Interface final : public Probe {
 public:
  WallLayer layer;

  void declare(Parameters& parameters) override { layer.declare(parameters); }
  StateRequest needs() const override { return BodyState::displacement | BodyState::rotation; }
  void prepare(const World& world) override { layer.prepare(world); }
  std::vector<Channel> channels() const override;
  void sample(const World& world, ChannelValues& values) override;

 private:
  /// Mean of the layer in the stage [rad].
  double rotation(const World& world, const Vec3& about) const;
};

}  // namespace grit
