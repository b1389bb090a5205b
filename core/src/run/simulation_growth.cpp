// Bodies that grow during a stage.
#include <algorithm>
#include <cmath>

#include "engines/growth.hpp"
#include "grit/error.hpp"
#include "run/number.hpp"
#include "run/simulation.hpp"
#include "run/stopwatch.hpp"

namespace grit {

double Simulation::growth_rate_of(const std::string& stage) const {
  const auto found = std::ranges::find(scene_->stages, stage, &StageDescription::name);
  return found != scene_->stages.end() && found->growth ? found->growth->rate : 0;
}

void Simulation::grow() {
  // Half of what growth puts into springs in a step by those at its start, half by those at its end.
  const double grows = growth_rate_ * clock_.time_step, half_by_now = 0.5 * (flows_.grown + grows);
  if (flows_.begun) flows_.settings += half_by_now * elastic_by_growth();
  flows_.grown = grows;
  if (grows == 0 || bodies_.count() == 0) return;
  const double factor = std::exp(grows);
  double furthest = stock_.largest_radius;
  for (const Clump& clump : bodies_.clumps.clump) furthest = std::max(furthest, clump.furthest);
  grown_ = (factor - 1) * furthest;
  if (!(grown_ <= scene_->guards.travel * stock_.smallest_radius))
    fail("the largest body grows by " + number(grown_ / stock_.smallest_radius) +
             " of the smallest radius in one step, more than /guards/travel " + number(scene_->guards.travel),
         "let bodies grow more slowly, by a smaller rate of the stage's growth");
  const auto moving = [this] { return flows_.begun ? kinetic_energy() : 0; };
  const double before = moving();
  {
    const Stopwatch watch(phases_[motion].seconds);
    team_.each(chunk_.size(), [&](std::size_t chunk) { grow_bodies(chunk, bodies_, factor); });
    grow_clumps(bodies_, factor);
    wall_contacts_.grow(bodies_, factor);
  }
  const double gained = (factor * factor * factor - 1) * (stock_.mass - mass_left_);
  stock_.mass += gained, stock_.solids += gained / stock_.solid_density;
  stock_.diameters *= factor, stock_.mean_diameter *= factor;
  stock_.largest_radius *= factor, stock_.smallest_radius *= factor;
  forget_views();
  flows_.settings += moving() - before;
}

}  // namespace grit
