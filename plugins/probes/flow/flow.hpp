// What has left through open sides of the domain: mass, number, rate, by outlet; and how the rest flows.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "grit/probe.hpp"
#include "grit/toolkit/averaging_cells.hpp"
#include "grit/toolkit/limited_fields.hpp"

namespace grit {

/// How what is still there flows, seen across the axis of the outlets.
struct FlowPattern : Averaging {
  double wall_zone = 2;          ///< mean diameters
  double moving_fraction = 0.1;  ///< of the mean speed of a slice
  void declare(Parameters& parameters);
};

class FlowProbe : public Probe, public LimitedFields {
 public:
  /// A range of places along the probe's axis.
  struct Outlet {
    double low = 0, high = 0;  ///< m
    void declare(Parameters& parameters);
  };
  std::string axis = "x";
  std::map<std::string, Outlet> outlets;
  double window = 0.05;  ///< s
  std::optional<FlowPattern> pattern;

  void declare(Parameters& parameters) override;
  std::vector<Channel> channels() const override;
  void sample(const World& world, ChannelValues& values) override;
  std::vector<Field> fields(const World& world) override;
  void check_fields(const World& world) const override;

 private:
  void sample_pattern(const World& world, bool flows, ChannelValues& values) const;
};

}  // namespace grit
