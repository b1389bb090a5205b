#include "kernel/state.hpp"

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

std::size_t State::bytes() const {
  const std::size_t per_body = 4 * sizeof(Row) + sizeof(BodySum) + 5 + (bodies.rotation.empty() ? 0 : sizeof(Vec3)) +
                               (bodies.origin.empty() ? 0 : sizeof(Vec3));
  const Clumps& clumps = bodies.clumps;
  return bodies.count() * per_body + pairs.bytes() + clumps.clump.size() * sizeof(Clump) +
         clumps.of_body.size() * (sizeof(ClumpSphere) + sizeof(std::uint32_t) + sizeof(double));
}

}  // namespace grit
