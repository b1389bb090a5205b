// The energy balance.
#pragma once

#include "grit/probe.hpp"

namespace grit {

class EnergyProbe final : public Probe {
 public:
  void declare(Parameters&) override {}
  StateRequest needs() const override { return BodyState::energy; }
  std::vector<Channel> channels() const override;
  void sample(const World& world, ChannelValues& values) override;
};

}  // namespace grit
