// How far bodies have gone in a stage, the mean of it and what is left. See README.md.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "../profile.hpp"
#include "grit/probe.hpp"

namespace grit {

class Displacements final : public Probe {
 public:
  std::string along = "x";
  Profile profile;

  void declare(Parameters& parameters) override;
  StateRequest needs() const override { return BodyState::displacement; }
  void prepare(const World& world) override { profile.prepare(world, "probe displacements"); }
  std::vector<Channel> channels() const override;
  void sample(const World& world, std::span<const std::span<double>> values) override;
  std::vector<Field> fields(const World& world) override;

 private:
  /// Of each body, less the profile, which is linear between places; NaN where that is unknown.
  std::vector<Vec3> fluctuations(const World& world) const;
};

}  // namespace grit
