#include "kernel/state.hpp"

#include <algorithm>
#include <cmath>

#include "bodies/restored.hpp"

namespace grit {

MotionStep State::next_motion(bool energies) const {
  const double dt = time.dt;
  const Cell& box = cell.cell();
  const Vec3 period = cell.periods(), growth = period.cwiseProduct(box.strain_rate);
  const Vec3 tilt_growth = box.skewed()
                               ? DeformingCell::tilt_rate(cell.lengths(), box.tilt, box.strain_rate, box.shear_rate)
                               : Vec3(Vec3::Zero());
  return {.settings = settings.motion,
          .kick = time.previous_dt > 0 ? 0.5 * (time.previous_dt + dt) : 0.5 * dt,
          .drift = dt,
          .flowed = time.previous_dt,
          .strain_rate = box.strain_rate,
          .centre = cell.flow_centre(),
          .period = period + dt * growth,
          .period_growth = growth,
          .energies = energies,
          .by_group = settings.motion_of_groups,
          .group = group,
          .shear_rate = box.shear_rate,
          .tilt = box.tilt + dt * tilt_growth,
          .tilt_growth = tilt_growth};
}

void State::check_restored() const {
  const std::size_t count = bodies.count();
  grit::check_restored(bodies, materials.size(), settings.groups);
  // Bodies re-enter a periodic cell at each neighbour search, long before they are a period away from it.
  const Vec3 periods = cell.periods();
  for (int k = 0; k < 3; ++k)
    for (std::size_t i = 0; periods[k] > 0 && i < count; ++i)
      expect_restored(std::abs(xyz(bodies.position[i])[k] - cell.centre()[k]) <= 1.5 * periods[k],
                      "a body is far outside of the periodic cell");
  statistics.check_restored(bodies);
  lists.check_restored(count);
  expect_restored(pairs.bodies() == count, "contacts are of another number of bodies");
  wall_contacts.check_restored(count, walls.size(), materials.size());
  expect_restored(std::isfinite(time.time) && std::isfinite(time.dt) && time.dt > 0 &&
                      std::isfinite(time.previous_dt) && time.previous_dt >= 0,
                  "the time or the time step is not a number");
  for (const WallState& wall : walls.states())
    expect_restored(wall.pose.about.allFinite() && wall.pose.shift.allFinite() && wall.pose.turn.allFinite() &&
                        wall.velocity.allFinite() && wall.spin.allFinite(),
                    "the place or the motion of a wall is not a number");
  const auto has_material = [this](const Departure& one) { return one.material < materials.size(); };
  expect_restored(std::ranges::all_of(departures, has_material), "a body that left has an unknown material");
}

std::size_t State::bytes() const {
  const std::size_t per_body = 4 * sizeof(Row) + sizeof(BodySum) + 5 + (bodies.rotation.empty() ? 0 : sizeof(Vec3)) +
                               (bodies.origin.empty() ? 0 : sizeof(Vec3));
  const Clumps& clumps = bodies.clumps;
  return bodies.count() * per_body + pairs.bytes() + clumps.clump.size() * sizeof(Clump) +
         clumps.of_body.size() * (sizeof(ClumpSphere) + sizeof(std::uint32_t) + sizeof(double));
}

}  // namespace grit
