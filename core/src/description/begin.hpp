// The prepared sample from which a run begins.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "grit/parameters.hpp"

namespace grit {

/// A prepared sample from which a run begins: the state of another run.
struct BeginDescription {
  std::string from;  ///< its folder of results
  std::string at = "end";
  std::int64_t frame = -1;     ///< below 0: the last one
  std::optional<double> time;  ///< of the frame [s]
  std::string springs = "keep";
  void declare(Parameters& p);
};

}  // namespace grit
