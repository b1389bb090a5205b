// How far bodies have turned in a stage, and the shear zone that shows. See README.md.
#pragma once

#include <string>
#include <vector>

#include "grit/probe.hpp"
#include "grit/toolkit/profile.hpp"

namespace grit {

class Rotations final : public Probe {
 public:
  std::string about = "y";
  Profile profile;

  void declare(Parameters& parameters) override;
  StateRequest needs() const override { return BodyState::rotation; }
  void prepare(const World& world) override { profile.prepare(world); }
  std::vector<Channel> channels() const override;
  void sample(const World& world, ChannelValues& values) override;
};

}  // namespace grit
