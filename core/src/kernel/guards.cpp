#include "kernel/guards.hpp"

#include <algorithm>

#include "format/number.hpp"
#include "kernel/failure.hpp"

namespace grit {

void check_overlap(const State& state, const World& world) {
  if (state.overlap <= state.settings.guards.overlap) return;
  // Reports the deepest contact.
  const Bodies& bodies = state.bodies;
  const auto share = [&](const Contact& c) {
    const double radius = bodies.position[c.a].w;
    return c.overlap / (c.with_wall ? radius : std::min(radius, bodies.position[c.b].w));
  };
  const auto all = world.contacts();
  const Contact& contact = *std::max_element(all.begin(), all.end(),
                                             [&](const Contact& c, const Contact& d) { return share(c) < share(d); });
  const Keys keys = contact.with_wall ? Keys{"walls", state.walls.name(contact.b)} : group_keys(state, contact.a);
  fail_at_body(state, Guard::overlap, keys, contact.a,
               "overlaps " +
                   (contact.with_wall ? "wall \"" + state.walls.name(contact.b) + "\""
                                      : "body " + std::to_string(bodies.id[contact.b])) +
                   " by " + number(state.overlap) + " of its radius, more than /guards/overlap " +
                   number(state.settings.guards.overlap),
               "the contact modulus may be too low for this load, or bodies overlapped at the start");
}

void check_periods(const State& state) {
  const double shortest = NeighbourLists::shortest_period(state.bodies, state.statistics);
  for (int k = 0; k < 3; ++k)
    if (const double period = state.cell.lengths()[k]; state.cell.cell().periodic[k] && period < shortest)
      fail(state, Guard::period, {"domain"},
           "/domain has a period of " + number(period) + " m along " + "xyz"[k] + ", below the minimum of " +
               number(shortest) + " m, twice the reach of the largest body",
           "make the domain longer along this axis, use walls instead, or compress it less");
}

void check_growth(const State& state, double distance) {
  const double smallest = state.statistics.smallest_radius, most = state.settings.guards.travel;
  if (distance <= most * smallest) return;
  fail(state, Guard::travel, {"stages"},
       "the largest body grows by " + number(distance / smallest) +
           " of the smallest radius in one step, more than /guards/travel " + number(most),
       "reduce the growth rate of the stage");
}

}  // namespace grit
