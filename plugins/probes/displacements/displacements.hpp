// How far bodies have gone in a stage, the mean of it and what is left. See README.md.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "grit/probe.hpp"
#include "grit/toolkit/profile.hpp"

namespace grit {

class Displacements final : public Probe {
 public:
  std::string along = "x";
  Profile profile;
  std::int64_t strips = 0;
  std::string strips_along = "x";

  void declare(Parameters& parameters) override;
  StateRequest needs() const override { return BodyState::displacement; }
  void prepare(const World& world) override { profile.prepare(world); }
  std::vector<Channel> channels() const override;
  void sample(const World& world, ChannelValues& values) override;
  std::vector<Field> fields(const World& world) override;

 private:
  using Profiles = std::array<Profile::Lines, 3>;
  Profiles profiles(const World& world) const;
  /// Of each body, less the profiles, which are linear between places; NaN where those are unknown.
  std::vector<Vec3> fluctuations(const World& world, const Profiles& mean) const;
  /// Writes the slopes at all places of each strip.
  void fill_strips(const World& world, ChannelValues& values) const;
};

}  // namespace grit
