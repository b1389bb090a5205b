// Void ratio of averaging cells and slices, up to the very surface of walls. See README.md.
#pragma once

#include <vector>

#include "grit/probe.hpp"
#include "grit/toolkit/averaging_cells.hpp"

namespace grit {

class VoidRatio final : public Probe {
 public:
  Averaging averaging;

  void declare(Parameters& parameters) override;
  std::vector<Channel> channels() const override;
  void sample(const World& world, ChannelValues& values) override;
  std::vector<Field> fields(const World& world) override;
};

}  // namespace grit
