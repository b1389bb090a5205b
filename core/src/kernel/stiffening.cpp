#include "kernel/stiffening.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grit {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// The time step is set again when the largest overlap has grown by this factor, or when an impact at the present speeds
// would reach as much.
constexpr double overlap_growth = 1.2, shallowest = 1e-6;
// Fraction of the overlap that an impact would reach to which a packing with many contacts per body may be compressed
// at the step set for a pair: 20 k_s/m for a cubic packing with friction, 7 k_s/m for a pair. At 0.8 of the step of the
// pair it starts to oscillate at (7 / 20 / 0.8²)² = 0.3 of that overlap, that is from a fraction of 0.3 / 1.2 = 0.25
// on. A face-centred packing has 40 k_s/m, and oscillates from a quarter of that on. Where dashpots shorten the step
// the limit is higher: the packing of tests/stability is stable at 0.4 and unstable at 0.5.
constexpr double packing_fraction = 0.06;
// Overlap over a radius up to which impacts are expected. The guard does not enter: it only decides where a run stops.
constexpr double deepest_impact = 1;

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

/// The smallest speed whose impact reaches this overlap [m/s]: ½ m* v² = 4/15 k δ² (Hertz). The ratio of overlap and
/// radius is then the same for all sizes.
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

double Stiffening::least_overlap() const {
  return is_there() ? overlap_growth * packing_fraction * expected_ : infinity;
}

bool Stiffening::exceeds(double overlap, const State& state, const DisplacementBounds& bounds) const {
  return is_there() &&
         (overlap > overlap_growth * expected_ || bounds.closing_speed(state.time.previous_dt) > expected_speed_);
}

bool Stiffening::may_exceed(const State& state, const DisplacementBounds& bounds) const {
  return exceeds(state.overlap + bounds.last_approach() / state.statistics.smallest_radius, state, bounds);
}

void Stiffening::expect(const State& state, const DisplacementBounds& bounds, Passes& passes) {
  if (!is_there()) return;
  // New bodies with a velocity have not moved yet.
  const auto speeds = passes.of_chunks([&](std::size_t chunk) {
    const ChunkRange range(chunk, state.bodies.count());
    double fastest = 0;
    for (std::size_t i = range.first; i < range.last; ++i)
      fastest = std::max(
          fastest, (xyz(state.bodies.velocity[i]) - state.cell.mean_flow(xyz(state.bodies.position[i]))).squaredNorm());
    return fastest;
  });
  const double fastest = std::sqrt(speeds.empty() ? 0 : *std::ranges::max_element(speeds));
  const double speed =
      std::max({2 * fastest, fastest + bounds.wall_closing_speed(), bounds.closing_speed(state.time.previous_dt)});
  double overlap = std::max(state.overlap, linear_until_);
  while (overlap < deepest_impact && speed_of_impact(state, overlap) < speed) overlap *= overlap_growth;
  expected_ = overlap;
  expected_speed_ = overlap < deepest_impact ? speed_of_impact(state, overlap_growth * overlap) : infinity;
}

}  // namespace grit
