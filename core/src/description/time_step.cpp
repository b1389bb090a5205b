#include "description/time_step.hpp"

#include <algorithm>

namespace grit {

void TimeStepDescription::declare(Parameters& p) {
  p.add("safety", safety).at_least(1e-6).at_most(10).doc("time step over the critical time step");
  p.add("steps_per_impact", steps_per_impact)
      .at_least(0)
      .at_most(1e6)
      .doc("minimum number of steps in an isolated impact of two bodies; 0: no minimum");
  p.add("max_displacement", max_displacement)
      .at_least(1e-6)
      .doc(
          "the time step is so short that no body moves further than this fraction of its radius in a step, and no "
          "wall "
          "further towards a body; default: 0.8 of guards/travel, at least 0.04");
  p.add("value", value)
      .unit("s")
      .symbol("dt")
      .at_least(1e-15)
      .doc(
          "time step; default: safety times the critical time step, or less if steps_per_impact or max_displacement "
          "requires it");
  p.add("allow_unstable", allow_unstable).doc("allow a time step above the critical one");
  p.check([this](const Complain& complain) {
    if (safety > 1 && !allow_unstable)
      complain("safety", "a time step above the critical one", "at most 1, unless allow_unstable is true");
  });
}
double max_displacement(const TimeStepDescription& time_step, const GuardsDescription& guards) {
  constexpr double of_guard = 0.8, usual = 0.04;
  return time_step.max_displacement.value_or(std::max(usual, of_guard * guards.travel));
}
void GuardsDescription::declare(Parameters& p) {
  p.add("overlap", overlap).above(0).doc("maximum overlap, over the smaller radius");
  p.add("travel", travel).above(0).doc("maximum displacement per step, over the radius");
  p.add("energy", energy)
      .above(0)
      .doc(
          "maximum spurious energy gain, as a fraction of the energy; without an energy probe, dissipation may hide a "
          "gain; not checked if the domain deforms, bodies are held or engines apply forces");
}

}  // namespace grit
