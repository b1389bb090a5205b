// Two spheres in contact: what a law sees of them, and what its response does to them.
#pragma once

#include <utility>

#include "grit/contact/contact_point.hpp"

namespace grit::detail {

/// The reciprocals of both. In double precision one division is faster; in single precision it would lose digits.
template <class L>
[[gnu::always_inline]] constexpr std::pair<L, L> inverses(const L& a, const L& b) {
  if constexpr (is_single<L>) return {L(1.0) / a, L(1.0) / b};
  const L of_product = L(1.0) / (a * b);
  return {of_product * b, of_product * a};
}

/// `turns` is 1, or 0 to omit the change of normal.
template <class L>
[[gnu::always_inline]] constexpr Turn<L> make_turn(const Vec<L>& normal, const Vec<L>& before, const Vec<L>& spin_a,
                                                   const Vec<L>& spin_b, double dt, const L& turns) {
  Turn<L> turn;
  turn.normal = normal;
  turn.bisector = normal + before;
  // Opposite normals (half a turn in one step) have no bisector; the guard on the displacement per step stops the run
  // before that.
  turn.over = turns / max(dot(turn.bisector, normal), L(1e-6));
  const L half = L(0.25 * dt) * dot(spin_a + spin_b, normal);  // tan(angle / 2), Cayley's form of a rotation
  const L scale = L(1.0) / (L(1.0) + half * half);
  turn.cosine = (L(1.0) - half * half) * scale;
  turn.sine = L(2.0) * half * scale;
  return turn;
}

/// The last step of a pair.
template <class L>
struct PairStep {
  L dt, per_dt;       ///< s, 1/s; 0 before the first step
  double history_dt;  ///< by which contact histories advance [s]; 0 if they already include this step
  L turns;            ///< as in make_turn()

  [[gnu::always_inline]] constexpr PairStep(double step, bool again)
      : dt(static_cast<typename LaneTraits<L>::Number>(step)),
        per_dt(static_cast<typename LaneTraits<L>::Number>(step > 0 ? 1 / step : 0.0)),
        history_dt(again ? 0 : step),
        turns(again ? 0.0 : 1.0) {}
};

/// A pair and what its forces depend on.
template <class L>
struct PairPoint {
  ContactPoint<L> at;
  L reach, per_distance;  ///< sum of the radii [m]; 1 / distance of the centres [1/m]
};

/// `between`, `apart`: position and velocity of b less those of a, across a periodic boundary if there is one; `square`
/// of the former. Rows as in PairBatch. `Reach`: whether overlaps may be negative.
template <bool Reach, class L>
[[gnu::always_inline]] constexpr PairPoint<L> pair_point(const Vec<Wide<L>>& between, const Vec<Wide<L>>& apart,
                                                         const Wide<L>& square, const RowLanes<Wide<L>>& pa,
                                                         const RowLanes<Wide<L>>& pb, const RowLanes<Wide<L>>& va,
                                                         const RowLanes<Wide<L>>& vb, const RowLanes<Wide<L>>& wa,
                                                         const RowLanes<Wide<L>>& wb, const PairStep<L>& step) {
  const Wide<L> radii = pa.w + pb.w;
  const L reach = in_precision<L>(radii);
  const Vec<L> branch = in_precision<L>(between), velocity = in_precision<L>(apart);
  const L distance = max(sqrt(in_precision<L>(square)), L(tiny<L>));
  const auto [per_distance, per_reach] = inverses(distance, reach);
  const Vec<L> normal = per_distance * branch;
  const Vec<L> way = step.dt * velocity, branch_before = branch - way;
  const L distance_before = max(sqrt(dot(branch_before, branch_before)), L(tiny<L>));
  L overlap, overlap_before;
  Vec<L> normal_before, change_of_normal;
  if constexpr (is_single<L>) {
    // Small differences are computed in double precision, from the difference of the squares.
    const L longer = dot(way, branch + branch_before) / (distance + distance_before);
    overlap = in_precision<L>(radii * radii - square) / (reach + distance), overlap_before = overlap + longer;
    change_of_normal = (L(1.0) / distance_before) * (way - longer * normal);
    normal_before = normal - change_of_normal;
  } else {
    overlap = reach - distance, overlap_before = reach - distance_before;
    normal_before = (L(1.0) / distance_before) * branch_before;
    change_of_normal = normal - normal_before;
  }

  ContactPoint<L> at;
  at.normal = normal;
  if constexpr (Reach) at.overlap = overlap;
  else at.overlap = max(overlap, L(0.0));
  at.branch_fraction = distance * per_reach;
  at.radius_a = in_precision<L>(pa.w), at.radius_b = in_precision<L>(pb.w);
  at.inverse_mass_a = in_precision<L>(va.w), at.inverse_mass_b = in_precision<L>(vb.w);
  at.turn = make_turn(normal, normal_before, in_precision<L>(wa.xyz()), in_precision<L>(wb.xyz()), step.history_dt,
                      step.turns);
  // The last term extends the branch to the sum of the radii; without it a pair that rotates as one body would slip.
  // The spins act on the normal at the middle of the step, the instant of the velocities.
  at.velocity = velocity - cross(in_precision<L>(pa.w * wa.xyz() + pb.w * wb.xyz()), L(0.5) * at.turn.bisector) +
                (overlap_before * step.per_dt) * change_of_normal;
  at.spin = in_precision<L>(wb.xyz() - wa.xyz());
  at.dt = L(step.history_dt);
  return {at, reach, per_distance};
}

/// The largest overlap over the smaller radius.
template <class L>
[[gnu::always_inline]] constexpr L relative_overlap(const ContactPoint<L>& at) {
  return at.overlap / max(min(at.radius_a, at.radius_b), L(tiny<L>));
}

template <class L>
struct PairForces {
  Vec<L> force;               ///< on b [N]; the opposite acts on a
  Vec<L> moment_a, moment_b;  ///< about the centres [N m]
};

/// Zero in lanes that are not in `contacts`.
template <class L>
[[gnu::always_inline]] constexpr PairForces<L> pair_forces(const PairPoint<L>& point, const Response<L>& response,
                                                           const typename LaneTraits<L>::Mask& contacts) {
  const ContactPoint<L>& at = point.at;
  const Vec<L> none{L(0.0), L(0.0), L(0.0)};
  // The shear spring acts on surfaces at the sum of the radii from each other. Centres that are nearer move less than
  // these surfaces, so that the force on them is larger; its moments are those of the spring at the radii. The work on
  // the bodies is then that on the spring in all motions, and angular momentum is conserved.
  const Vec<L> force =
      select(contacts, response.normal_force * at.normal + (point.reach * point.per_distance) * response.shear, none);
  const Vec<L> lever = cross(at.normal, select(contacts, response.shear, none));
  const Vec<L> moment = select(contacts, response.moment, none);
  return {force, -moment - at.radius_a * lever, moment - at.radius_b * lever};
}

}  // namespace grit::detail
