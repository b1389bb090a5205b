#include "contact/critical_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace grit {
namespace {

/// What one contact asks of one of its bodies, 1/s².
double demand(const Stiffness& k, double radius, double inverse_mass, double inverse_inertia) {
  const double sliding = k.shear * (inverse_mass + radius * radius * inverse_inertia) + k.rolling * inverse_inertia;
  return std::max({k.normal * inverse_mass, sliding, k.twisting * inverse_inertia});
}

}  // namespace

double CriticalStep::find(const Instant& at, Team& team) {
  demand_.assign(at.bodies.count(), 0.0);
  chunk_.resize(chunks_of(at.bodies.count()));
  walls_walked_ = at.skins.walls_walked();
  std::vector<std::size_t> all(chunk_.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return look(all, at, team);
}

bool CriticalStep::due(const Skins& skins, double way) const {
  if (skins.walls_walked() > walls_walked_ + way) return true;
  for (std::size_t chunk = 0; chunk < chunk_.size(); ++chunk)
    if (skins.walked(chunk) > chunk_[chunk].walked + way) return true;
  return false;
}

double CriticalStep::renew(const Instant& at, double way, Team& team) {
  if (at.skins.walls_walked() > walls_walked_ + way) return find(at, team);
  std::vector<std::size_t> chunks;
  for (std::size_t chunk = 0; chunk < chunk_.size(); ++chunk)
    if (at.skins.walked(chunk) > chunk_[chunk].walked + way) chunks.push_back(chunk);
  return look(chunks, at, team);
}

double CriticalStep::look(const std::vector<std::size_t>& chunks, const Instant& at, Team& team) {
  team.each(chunks.size(), [&](std::size_t k) { ask(chunks[k], at); });
  team.each(chunks.size(), [&](std::size_t k) { compare(chunks[k]); });
  double largest = 0, damping = 0;
  for (const Chunk& chunk : chunk_)
    largest = std::max(largest, chunk.largest), damping = std::max(damping, chunk.damping);
  if (chunk_.empty()) return std::numeric_limits<double>::infinity();
  return 2 / std::sqrt(largest) * (std::sqrt(1 + damping * damping) - damping);
}

/// What contacts ask of the bodies of a chunk.
void CriticalStep::ask(std::size_t chunk, const Instant& at) {
  const Bodies& bodies = at.bodies;
  Chunk& own = chunk_[chunk];
  own.walked = at.skins.walked(chunk);
  own.near.clear();
  const std::size_t first = chunk * chunk_bodies, last = std::min(bodies.count(), first + chunk_bodies);
  const auto size_of = [&](std::size_t a, std::size_t b, double overlap) {
    return PairSize{.radius_a = bodies.position[a].w,
                    .radius_b = bodies.position[b].w,
                    .inverse_mass_a = bodies.velocity[a].w,
                    .inverse_mass_b = bodies.velocity[b].w,
                    .overlap = overlap};
  };
  double damping = 0;
  const auto own_demand = [&](const Stiffness& k, std::size_t i) {
    damping = std::max(damping, k.damping_ratio);
    return demand(k, bodies.position[i].w, bodies.velocity[i].w, bodies.spin[i].w);
  };
  std::array<double, chunk_bodies> asked{};
  at.pairs.each_near(chunk, bodies, at.shifts, at.skins, at.near, [&](std::size_t c, double distance) {
    const std::uint32_t a = at.pairs.a(c), b = at.pairs.b(c);
    const double overlap = std::max(bodies.position[a].w + bodies.position[b].w - distance, 0.0);
    const Stiffness k = at.law.stiffness(size_of(a, b, overlap), bodies.material[a], bodies.material[b]);
    for (const std::uint32_t i : {a, b})
      if (first <= i && i < last) asked[i - first] += own_demand(k, i);
    own.near.push_back({a, b});
  });
  at.walls.each(chunk, [&](const WallContacts::Touching& t) {
    const std::uint32_t a = t.touch->body;
    PairSize size = size_of(a, a, t.touch->overlap);
    size.inverse_mass_b = 0, size.wall = true;
    asked[a - first] += own_demand(at.law.stiffness(size, bodies.material[a], t.touch->material), a);
  });
  own.largest = 0;
  for (std::size_t i = first; i < last; ++i) {
    const double alone = own_demand(at.law.stiffness(size_of(i, i, 0), bodies.material[i], bodies.material[i]), i);
    demand_[i] = std::max(asked[i - first], alone);
    own.largest = std::max({own.largest, 2 * alone, demand_[i]});
  }
  own.damping = damping;
}

void CriticalStep::compare(std::size_t chunk) {
  for (const auto& [a, b] : chunk_[chunk].near)
    chunk_[chunk].largest = std::max(chunk_[chunk].largest, demand_[a] + demand_[b]);
}

}  // namespace grit
