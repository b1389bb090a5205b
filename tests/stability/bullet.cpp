// A grain shot through a packing, at speeds up to the limit of the guard: no contact is missed, and neighbours are
// searched as often as its speed requires.
#include <gtest/gtest.h>

#include <cmath>

#include "support/mapped.hpp"
#include "support/packing.hpp"
#include "support/touching.hpp"

namespace grit::test::bullet_tests {
namespace {

constexpr double spacing = 1e-3, dt = 2e-7;
/// Target duration of a skin in steps, and its minimum and maximum in mean diameters.
constexpr double steps_of_skin = 100, least_skin = 0.03, most_skin = 1.3;

/// A block of grains at rest that just touch, and one grain that flies through it or past it with `travel` radii per
/// step.
Description shot(double travel, bool past = false) {
  auto grains = jumble({7, 7, 7}, spacing, 0, 4);
  const double radius = 0.4 * spacing;
  grains.push_back({spacing * Vec3(past ? -4 : 3.6, 3.4, -1), radius, {0, 0, travel * radius / dt}});
  Description d = description("linear-frictional", {{"contact_modulus", 1e7}, {"restitution", 0.3}}, grains);
  d["time_step"] = {{"value", dt}};
  d["guards"] = {{"overlap", 1e9}, {"travel", 0.2}, {"energy", 10}};
  return d;
}

TEST(Bullet, MeetsAllGrainsOnItsWayAndHasNeighboursSoughtInTime) {
  const auto& map = "steps between two searches|way of the fastest grain in a step, in radii";
  for (const double travel : {1e-3, 3e-3, 1e-2, 3e-2, 0.05, 0.1, 0.19}) {
    Trial t(shot(travel));
    const int steps = static_cast<int>(std::min(2000.0, 25 / travel));
    const int look = std::max(1, steps / 100);
    std::size_t compared = 0, missed = 0;
    for (int i = 0; i < steps; ++i, t.step()) {
      if (i % look != 0) continue;
      const Touching all = there(t.world());
      compared += all.size(), missed += all == found(t.kernel()) ? 0 : 1;
    }
    EXPECT_EQ(missed, 0u) << travel;
    EXPECT_GT(compared, 5000u);
    // The last twentieth of a skin is a reserve.
    Trial flight(shot(travel, true));
    const double mean = flight.world().mean_diameter(), way = travel * 0.4 * spacing;
    const double skin = std::clamp(steps_of_skin * way, least_skin * mean, most_skin * mean);
    flight.step(static_cast<std::size_t>(20.5 * skin / way));
    const double between = 20.5 * skin / way / static_cast<double>(flight.kernel().state().lists.rebuilds() - 1);
    EXPECT_GT(between, 0.9 * (skin / way - 2)) << travel;
    EXPECT_LT(between, 1.05 * (skin / way + 1)) << travel;
    map_point(map, "found", travel, between);
    map_point(map, "predicted", travel, skin / way);
  }
  figure("steps that a skin lasts", steps_of_skin);
  figure("least skin, in mean diameters", least_skin);
  figure("most skin, in mean diameters", most_skin);
}

}  // namespace
}  // namespace grit::test::bullet_tests
