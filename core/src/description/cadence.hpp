// When samples and frames are taken.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "grit/parameters.hpp"

namespace grit {

/// Due each time a wall has moved by `value`, in either direction, since the last time.
struct DisplacementCadence {
  std::string wall, axis = "x";
  double value = 0;  ///< m, above 0
  void declare(Parameters& p);
};
/// Interval of a repeated event. None given: never.
struct Cadence {
  std::optional<double> every_time;
  std::int64_t every_steps = 0;
  std::optional<DisplacementCadence> every_displacement;
  std::optional<double> every_discharged;  ///< fraction of the mass of all bodies so far
  bool never() const { return !every_time && every_steps == 0 && !every_displacement && !every_discharged; }
  void declare(Parameters& p);
};

}  // namespace grit
