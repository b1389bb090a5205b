// The surface of a conical heap and its angle of repose. See README.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grit/probe.hpp"

namespace grit {

class Heap final : public Probe {
 public:
  Vec3 base = Vec3::Zero();  ///< m
  std::int64_t sectors = 8;
  double lower = 0.2, upper = 0.8;

  void declare(Parameters& parameters) override;
  std::vector<Channel> channels() const override;
  void sample(const World& world, ChannelValues& values) override;
};

}  // namespace grit
