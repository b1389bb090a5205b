#include "kernel/stiffening.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grit {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// The time step is set again whenever the largest overlap has grown so much, or something moves so fast that an impact
// would go as much deeper.
constexpr double overlap_growth = 1.2, shallowest = 1e-6;
// A packing of particles with many contacts each may be pressed to this share of the overlap that an impact would
// reach, at the step that is set for a pair: 20 k_s/m of a cubic packing with friction, against 7 k_s/m of a pair. At
// 0.8 of the pair's step it begins to oscillate at (7 / 20 / 0.8²)² = 0.3 of that overlap, so from a share of 0.3 / 1.2
// = 0.25 on. Where dashpots shorten the step it is later: the packing of tests/stability holds at 0.4 and fails at 0.5.
// Not covered, whatever the share: a packing that is pressed less deep than some contact was before. A face-centred one
// has 40 k_s/m and then oscillates at 0.8 of the step.
constexpr double packing_share = 0.15;

/// Normal stiffness of two bodies of the smallest radius, or of one and a wall, at this overlap over a radius [N/m].
double stiffness_of_smallest(const State& state, std::size_t a, std::size_t b, bool wall, double overlap) {
  const double r = state.statistics.smallest_radius, per_mass = 1 / (state.statistics.heaviest * r * r * r);
  return state.settings.law
      ->stiffness({.radius_a = r,
                   .radius_b = r,
                   .inverse_mass_a = per_mass,
                   .inverse_mass_b = wall ? 0 : per_mass,
                   .overlap = overlap * r,
                   .wall = wall},
                  a, b)
      .normal;
}

/// Calls use(a, b, wall) for all pairs of materials.
template <class Use>
void each_pair_of_materials(const State& state, Use use) {
  for (std::size_t a = 0; a < state.materials.size(); ++a)
    for (std::size_t b = 0; b < state.materials.size(); ++b)
      for (const bool wall : {false, true}) use(a, b, wall);
}

/// The smallest speed whose impact reaches this overlap: ½ m* v² = 4/15 k δ², which is Hertz's [m/s]. The ratio of
/// overlap and radius is then that of all sizes.
double speed_of_impact(const State& state, double overlap) {
  const double r = state.statistics.smallest_radius, mass = state.statistics.heaviest * r * r * r;
  double least = infinity;
  each_pair_of_materials(state, [&](std::size_t a, std::size_t b, bool wall) {
    const double stiffness = stiffness_of_smallest(state, a, b, wall, overlap), moved = wall ? mass : 0.5 * mass;
    least = std::min(least, overlap * r * std::sqrt(8.0 / 15 * stiffness / moved));
  });
  return least;
}

}  // namespace

bool Stiffening::is_there() const { return std::isfinite(linear_until_); }

void Stiffening::update(const State& state) {
  double linear = infinity;
  each_pair_of_materials(state, [&](std::size_t a, std::size_t b, bool wall) {
    const double at_rest = stiffness_of_smallest(state, a, b, wall, 0);
    for (double overlap = shallowest; overlap < std::min(1.0, linear); overlap *= overlap_growth)
      if (stiffness_of_smallest(state, a, b, wall, overlap) != at_rest)
        linear = std::max(shallowest, overlap / overlap_growth);
  });
  linear_until_ = linear;
}

bool Stiffening::exceeds(double overlap, const State& state, const DisplacementBounds& bounds) const {
  const double pressed = std::max(pressed_, packing_share * expected_);
  return is_there() &&
         (overlap > overlap_growth * pressed || bounds.closing_speed(state.time.previous_dt) > expected_speed_);
}

bool Stiffening::may_exceed(const State& state, const DisplacementBounds& bounds) const {
  return exceeds(state.overlap + bounds.last_approach() / state.statistics.smallest_radius, state, bounds);
}

void Stiffening::expect(const State& state, const DisplacementBounds& bounds) {
  if (!is_there()) return;
  // Bodies that begin or appear with a velocity have not made a step with it yet.
  const Vec3 rate = state.cell.cell().strain_rate, middle = state.cell.flow_centre();
  double fastest = 0;
  for (std::size_t i = 0; i < state.bodies.count(); ++i)
    fastest = std::max(
        fastest,
        (xyz(state.bodies.velocity[i]) - rate.cwiseProduct(xyz(state.bodies.position[i]) - middle)).squaredNorm());
  fastest = std::sqrt(fastest);
  const double speed =
      std::max({2 * fastest, fastest + bounds.wall_closing_speed(), bounds.closing_speed(state.time.previous_dt)});
  const double deepest = std::min(1.0, state.settings.guards.overlap);
  double overlap = pressed_ = std::max(state.overlap, linear_until_);
  while (overlap < deepest && speed_of_impact(state, overlap) < speed) overlap *= overlap_growth;
  expected_ = overlap;
  expected_speed_ = overlap < deepest ? speed_of_impact(state, overlap_growth * overlap) : infinity;
}

}  // namespace grit
