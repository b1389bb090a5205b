// What has left through open sides of the domain: mass, number, rate, by outlet.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "grit/probe.hpp"

namespace grit {

class FlowProbe : public Probe {
 public:
  /// A range of places along the probe's axis.
  struct Outlet {
    double low = 0, high = 0;  ///< m
    void declare(Parameters& parameters);
  };
  std::string axis = "x";
  std::map<std::string, Outlet> outlets;
  double window = 0.05;  ///< s

  void declare(Parameters& parameters) override;
  std::vector<Channel> channels() const override;
  void sample(const World& world, std::span<const std::span<double>> values) override;
};

}  // namespace grit
