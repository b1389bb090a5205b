#include "kernel/guards.hpp"

#include <algorithm>
#include <span>
#include <string>

#include "format/number.hpp"
#include "kernel/failure.hpp"

namespace grit {
namespace {

/// Reports the deepest contact, which is with a wall.
[[noreturn]] void fail_at_wall(const State& state, const Contact& contact, std::span<const Contact> all) {
  const Bodies& bodies = state.bodies;
  const std::string wall = "wall \"" + state.walls.name(contact.b) + '"',
                    allowed = number(state.settings.guards.overlap);
  const bool starts = state.time.step == 0;
  const auto behind = static_cast<std::size_t>(std::ranges::count_if(all, [&](const Contact& one) {
    return one.with_wall && one.b == contact.b && one.overlap > bodies.position[one.a].w;
  }));
  const std::string deep = number(state.overlap) + " of its radius";
  if (starts && 2 * behind > bodies.count())
    fail(state, Guard::overlap, {"walls", state.walls.name(contact.b)},
         wall + " faces away from the bodies: " + std::to_string(behind) + " of " + std::to_string(bodies.count()) +
             " have their centres behind it, the deepest by an overlap of " + deep,
         "reverse its normal or the order of its corners, or move it to the other side of the bodies");
  fail_at_body(state, Guard::overlap,
               starts ? group_keys(state, contact.a) : Keys{"walls", state.walls.name(contact.b)}, contact.a,
               (starts ? "appears inside " + wall + ": they overlap by " : "overlaps " + wall + " by ") + deep +
                   ", more than /guards/overlap " + allowed,
               starts ? "place it in front of the wall; the box of a cloud must not contain walls"
                      : "the wall may face away from the bodies, the contact modulus be too low for this load, or the "
                        "wall too fast");
}

}  // namespace

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
  if (contact.with_wall) fail_at_wall(state, contact, all);
  const bool starts = state.time.step == 0;
  fail_at_body(state, Guard::overlap, group_keys(state, contact.a), contact.a,
               "overlaps body " + std::to_string(bodies.id[contact.b]) + " by " + number(state.overlap) +
                   " of its radius, more than /guards/overlap " + number(state.settings.guards.overlap),
               starts ? "place the bodies apart; a cloud avoids overlaps"
                      : "the contact modulus may be too low for this load, or bodies overlapped at the start");
}

void check_periods(const State& state) {
  const double shortest = NeighbourLists::shortest_period(state.bodies, state.statistics, state.reaches());
  for (int k = 0; k < 3; ++k)
    if (const double period = state.cell.lengths()[k]; state.cell.cell().periodic[as_index(k)] && period < shortest)
      fail(
          state, Guard::period, {"domain"},
          "/domain has a period of " + number(period) + " m along " + "xyz"[k] + ", below the minimum of " +
              number(shortest) + " m, twice the reach of the largest body",
          std::string("make the domain longer along this axis, use walls instead, or compress it less") +
              (state.settings.cell_servo && state.time.step > 0
                   ? "; the target of /domain/servo may be beyond what the bodies can bear, or its max_strain_rate too "
                     "large"
                   : ""));
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
