#include "contact/critical_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grit {
namespace {

/// What one contact asks of one of its bodies, 1/s².
double demand(const Stiffness& k, double radius, double inverse_mass, double inverse_inertia) {
  const double sliding = k.shear * (inverse_mass + radius * radius * inverse_inertia) + k.rolling * inverse_inertia;
  return std::max({k.normal * inverse_mass, sliding, k.twisting * inverse_inertia});
}

}  // namespace

double critical_time_step(const Bodies& bodies, const ContactTable& pairs, const WallContacts& walls,
                          const ContactLaw& law, const ImageShift* shifts, double closing, double near) {
  const std::size_t count = bodies.count();
  if (count == 0) return std::numeric_limits<double>::infinity();
  std::vector<double> sum(count, 0.0);
  double damping = 0, largest = 0;

  const auto size_of = [&](std::size_t a, std::size_t b, double overlap) {
    return PairSize{.radius_a = bodies.position[a].w,
                    .radius_b = bodies.position[b].w,
                    .inverse_mass_a = bodies.velocity[a].w,
                    .inverse_mass_b = bodies.velocity[b].w,
                    .overlap = overlap};
  };
  const auto own_demand = [&](const Stiffness& k, std::size_t i) {
    return demand(k, bodies.position[i].w, bodies.velocity[i].w, bodies.spin[i].w);
  };
  struct Pair {
    std::uint32_t a, b;
  };
  std::vector<Pair> near_pairs;
  pairs.each_near(bodies, shifts, closing, near, [&](std::size_t c, double distance) {
    const std::uint32_t a = pairs.a(c), b = pairs.b(c);
    const double overlap = std::max(bodies.position[a].w + bodies.position[b].w - distance, 0.0);
    const Stiffness k = law.stiffness(size_of(a, b, overlap), bodies.material[a], bodies.material[b]);
    sum[a] += own_demand(k, a), sum[b] += own_demand(k, b);
    damping = std::max(damping, k.damping_ratio);
    near_pairs.push_back({a, b});
  });
  walls.each([&](const WallContacts::Touching& t) {
    const std::uint32_t a = t.touch->body;
    PairSize size = size_of(a, a, t.touch->overlap);
    size.inverse_mass_b = 0, size.wall = true;
    const Stiffness k = law.stiffness(size, bodies.material[a], t.touch->material);
    sum[a] += own_demand(k, a);
    damping = std::max(damping, k.damping_ratio);
  });
  for (std::size_t i = 0; i < count; ++i) {
    const Stiffness k = law.stiffness(size_of(i, i, 0), bodies.material[i], bodies.material[i]);
    sum[i] = std::max(sum[i], own_demand(k, i));
    damping = std::max(damping, k.damping_ratio);
    largest = std::max(largest, 2 * own_demand(k, i));
    largest = std::max(largest, sum[i]);
  }
  for (const auto& [a, b] : near_pairs) largest = std::max(largest, sum[a] + sum[b]);
  return 2 / std::sqrt(largest) * (std::sqrt(1 + damping * damping) - damping);
}

}  // namespace grit
