// Stages of a run and what changes in them.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "description/conditions.hpp"
#include "grit/description.hpp"
#include "grit/parameters.hpp"

namespace grit {

/// A number of the description that changes during a stage, in equal increments.
struct RampDescription {
  std::string pointer;
  Description from, to;  ///< as in the description
  double duration = 0;
  std::int64_t increments = 50;
  void declare(Parameters& p);
};
/// Bodies that grow in place.
struct GrowthDescription {
  double rate = 0;  ///< 1/s, above 0
  void declare(Parameters& p);
};
struct ExpectDescription {
  std::optional<double> void_ratio;
  double within = 0.01;
  void declare(Parameters& p);
};
struct StageDescription {
  std::string name;
  Condition until;
  double limit = 0;                         ///< simulated time after which the stage fails, s
  std::optional<double> typical_time = {};  ///< simulated, for estimates, s
  Description change = Description::object();
  std::deque<RampDescription> ramps;
  std::optional<GrowthDescription> growth;
  ExpectDescription expect;
  void declare(Parameters& p);
};

}  // namespace grit
