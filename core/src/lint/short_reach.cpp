#include "lint/short_reach.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace grit {

std::optional<UnusedSetting> short_reach(const Kernel& kernel) {
  const State& state = kernel.state();
  const auto reaches = state.reaches();
  const double reach = reaches.empty() ? 0 : *std::ranges::max_element(reaches);
  const bool given = state.settings.time_step.value.has_value();
  const double most =
      given ? state.settings.guards.travel : max_displacement(state.settings.time_step, state.settings.guards);
  const double travel = most * state.statistics.largest_radius;
  if (!(reach > 0) || reach >= travel) return std::nullopt;
  return UnusedSetting{
      "/time_step", fmt::format("bodies attract each other up to {:.2g} m apart, but may move by {:.2g} m in a step: "
                                "impacts this fast pass the attraction unresolved. Shorten the step for them with {}",
                                reach, travel, given ? "/time_step/value" : "/time_step/max_displacement")};
}

}  // namespace grit
