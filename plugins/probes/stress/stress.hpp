// Stress and couple stress of averaging cells, of slices and of a region. See README.md.
#pragma once

#include <vector>

#include "grit/probe.hpp"
#include "grit/toolkit/averaging_cells.hpp"
#include "grit/toolkit/limited_fields.hpp"

namespace grit {

class Stress final : public Probe, public LimitedFields {
 public:
  Averaging averaging;

  void declare(Parameters& parameters) override;
  std::vector<Channel> channels() const override;
  void sample(const World& world, ChannelValues& values) override;
  std::vector<Field> fields(const World& world) override;
  void check_fields(const World& world) const override;
};

}  // namespace grit
