// Measurements.
#pragma once

#include <string>
#include <vector>

#include "description/cadence.hpp"
#include "grit/parameters.hpp"
#include "plugins/component.hpp"

namespace grit {

struct ProbeDescription {
  Component<Probe> probe;
  Cadence cadence;
  std::vector<std::string> groups;  ///< of bodies that it samples; empty: all
  std::vector<std::string> stages;  ///< empty: all
  bool frames = true;               ///< whether its fields are written to frames
  explicit ProbeDescription(const Registry& registry) : probe(registry) {}
  void declare(Parameters& p);
};

}  // namespace grit
