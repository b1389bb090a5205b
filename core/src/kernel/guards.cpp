#include "kernel/guards.hpp"

#include <algorithm>

#include "format/number.hpp"
#include "kernel/failure.hpp"

namespace grit {

void check_overlap(const State& state, const World& world) {
  if (state.overlap <= state.settings.guards.overlap) return;
  // Bodies may have moved since, so the deepest contact is named, not the first that is too deep.
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
               "the contact modulus may be too low for this load, or bodies began inside each other");
}

void check_periods(const State& state) {
  const double shortest = NeighbourLists::shortest_period(state.bodies, state.statistics);
  for (int k = 0; k < 3; ++k)
    if (const double period = state.cell.lengths()[k]; state.cell.cell().periodic[k] && period < shortest)
      fail(state, Guard::period, {"domain"},
           "/domain is " + number(period) + " m long along " + "xyz"[k] +
               ", where it repeats; a body would meet another one twice in less than " + number(shortest) +
               " m, twice the reach of the largest",
           "make the domain longer along this axis, bound it by walls, or compress it less");
}

void check_growth(const State& state, double distance) {
  const double smallest = state.statistics.smallest_radius, most = state.settings.guards.travel;
  if (distance <= most * smallest) return;
  fail(state, Guard::travel, {"stages"},
       "the largest body grows by " + number(distance / smallest) +
           " of the smallest radius in one step, more than /guards/travel " + number(most),
       "let bodies grow more slowly, by a smaller rate of the stage's growth");
}

}  // namespace grit
