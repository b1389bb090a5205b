// How contact forces spread: strong contacts, linear chains, forces and contacts by direction, anisotropies.
#pragma once

#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "grit/probe.hpp"
#include "linear_chains.hpp"

namespace grit {

class ForceChainsProbe : public Probe {
 public:
  static constexpr std::size_t bins = 36;

  std::string plane = "xz";
  bool include_walls = false;
  double angle = std::numbers::pi / 4;  ///< rad, between the line to the next grain of a chain and the major stress

  void declare(Parameters& parameters) override;
  std::vector<Channel> channels() const override;
  void sample(const World& world, ChannelValues& values) override;
  /// Both ends, normal force, class and chain of every contact.
  std::vector<Field> fields(const World& world) override;
  void serialize(Archive& archive) override {
    archive.part("force-chains", 1);
    archive(before_, now_, step_);
  }

 private:
  /// The contacts that count.
  std::vector<const Contact*> counted(const World& world) const;
  void sample_chains(const World& world, ChannelValues& values);

  // Chains live from sample to sample; one that is taken again at its instant is compared with the same one before.
  std::optional<LinearChains> before_, now_;
  std::uint64_t step_ = 0;  ///< of now_
};

}  // namespace grit
