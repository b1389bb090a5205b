// How contact forces spread: the strong contacts, forces and contacts by direction, fabric anisotropy.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "grit/probe.hpp"

namespace grit {

class ForceChainsProbe : public Probe {
 public:
  static constexpr std::size_t bins = 36;

  std::string plane = "xz";
  bool with_walls = false;

  void declare(Parameters& parameters) override;
  std::vector<Channel> channels() const override;
  void sample(const World& world, std::span<const std::span<double>> values) override;
  /// Both ends, normal force and class of every contact.
  std::vector<Field> fields(const World& world) override;

 private:
  /// The contacts that count.
  std::vector<const Contact*> counted(const World& world) const;
};

}  // namespace grit
