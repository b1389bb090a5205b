// The time step where springs stiffen with overlap: it is set for what they will meet.
#include <algorithm>
#include <cmath>
#include <limits>

#include "run/simulation.hpp"

namespace grit {
namespace {

// Springs that stiffen with overlap, as Hertz's do: the time step is set anew whenever the largest has grown so much,
// or something moves so fast that an impact would go as much deeper.
constexpr double overlap_growth = 1.2, shallowest = 1e-6;
// Of the overlap that an impact would reach, as much as a packing of grains with many contacts each may be pressed to
// at the step that is set for two: 20 k_s/m of a cubic packing with friction, against 7 k_s/m of a pair. At 0.8 of the
// pair's step it begins to swing at (7 / 20 / 0.8²)² = 0.3 of that overlap, so from a share of 0.3 / 1.2 = 0.25 on.
// Where dashpots shorten the step it is later: the packing of tests/stability holds at 0.4 and does not at 0.5. Not
// looked at, whatever the share: a packing that is pressed less deep than some contact was before. A face-centred one
// asks for 40 k_s/m and swings then at 0.8 of the step.
constexpr double as_stiff_as_impact = 0.15;

}  // namespace

/// Asked before forces, whoever wants them, so that the time step does not depend on that.
bool Simulation::springs_may_stiffen() const {
  return stiffer_than_stepped(clock_.overlap + clock_.last_approach / stock_.smallest_radius);
}

bool Simulation::stiffer_than_stepped(double overlap) const {
  const double pressed = std::max(clock_.pressed_overlap, as_stiff_as_impact * clock_.stepped_overlap);
  return springs_stiffen() && (overlap > overlap_growth * pressed || closing_speed() > clock_.stepped_speed);
}

double Simulation::closing_speed() const {
  return clock_.last_time_step > 0 ? clock_.last_approach / clock_.last_time_step : 0;
}

/// The largest overlap now, or the one that the fastest impact will reach. Bodies that begin or come with a velocity
/// have not made a step with it yet.
void Simulation::expect_overlap() {
  if (!springs_stiffen()) return;
  const Vec3 rate = clock_.cell.strain_rate, middle = rate.isZero(0.0) ? Vec3::Zero() : centre();
  double fastest = 0;
  for (std::size_t i = 0; i < bodies_.count(); ++i)
    fastest = std::max(fastest,
                       (xyz(bodies_.velocity[i]) - rate.cwiseProduct(xyz(bodies_.position[i]) - middle)).squaredNorm());
  fastest = std::sqrt(fastest);
  const double speed = std::max({2 * fastest, fastest + clock_.wall_closing, closing_speed()});
  const double deepest = std::min(1.0, scene_->guards.overlap);
  double overlap = clock_.pressed_overlap = std::max(clock_.overlap, soft_until_);
  while (overlap < deepest && speed_of_impact(overlap) < speed) overlap *= overlap_growth;
  clock_.stepped_overlap = overlap;
  clock_.stepped_speed =
      overlap < deepest ? speed_of_impact(overlap_growth * overlap) : std::numeric_limits<double>::infinity();
}

/// ½ m* v² = 4/15 k δ², which is Hertz's; the ratio of overlap and radius is that of all sizes then.
double Simulation::speed_of_impact(double overlap) const {
  const double r = stock_.smallest_radius, mass = stock_.heaviest * r * r * r;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < material_names_.size(); ++a)
    for (std::size_t b = 0; b < material_names_.size(); ++b)
      for (const bool wall : {false, true}) {
        const double stiffness = stiffness_of_smallest(a, b, wall, overlap), moved = wall ? mass : 0.5 * mass;
        least = std::min(least, overlap * r * std::sqrt(8.0 / 15 * stiffness / moved));
      }
  return least;
}

double Simulation::stiffness_of_smallest(std::size_t a, std::size_t b, bool wall, double overlap) const {
  const double r = stock_.smallest_radius, per_mass = 1 / (stock_.heaviest * r * r * r);
  return law_
      ->stiffness({.radius_a = r,
                   .radius_b = r,
                   .inverse_mass_a = per_mass,
                   .inverse_mass_b = wall ? 0 : per_mass,
                   .overlap = overlap * r,
                   .wall = wall},
                  a, b)
      .normal;
}

double Simulation::overlap_of_soft_springs() const {
  double soft = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < material_names_.size(); ++a)
    for (std::size_t b = 0; b < material_names_.size(); ++b)
      for (const bool wall : {false, true}) {
        const double at_rest = stiffness_of_smallest(a, b, wall, 0);
        for (double overlap = shallowest; overlap < std::min(1.0, soft); overlap *= overlap_growth)
          if (stiffness_of_smallest(a, b, wall, overlap) != at_rest)
            soft = std::max(shallowest, overlap / overlap_growth);
      }
  return soft;
}

}  // namespace grit
