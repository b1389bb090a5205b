#include "contact/critical_step.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace grit {
namespace {

/// What the springs of one contact ask of one of its bodies, 1/s².
double demand(const Stiffness& k, const Bodies& bodies, std::size_t i) {
  const double radius = bodies.position[i].w, inverse_mass = bodies.velocity[i].w, inverse_inertia = bodies.spin[i].w;
  const double sliding = k.shear * (inverse_mass + radius * radius * inverse_inertia) + k.rolling * inverse_inertia;
  return std::max({k.normal * inverse_mass, sliding, k.twisting * inverse_inertia});
}

/// What dashpots ask of a body, 1/s, by direction: of its velocity, of its spin times √(I/m), and of both together.
struct Dashpots {
  Mat3 velocity = Mat3::Zero(), spin = Mat3::Zero();
  Vec3 both = Vec3::Zero();

  /// One contact, whose normal points out of the body; of two bodies, each bears what both together are worth.
  void add(const Stiffness& k, const Vec3& normal, double inverse_mass) {
    const double along = 2 * k.damping_ratio * std::sqrt(k.normal * inverse_mass);
    const double across = 2 * k.shear_damping_ratio * std::sqrt(k.shear * inverse_mass / slide);
    const Mat3 line = normal * normal.transpose(), plane = across * (Mat3::Identity() - line);
    velocity += along * line + plane;
    spin += (slide - 1) * plane;
    both += std::sqrt(slide - 1) * across * normal;
  }
  /// An upper bound of the largest eigenvalue of the whole; nothing new if it can't be more than `so_far`.
  double largest(double so_far) const {
    if (velocity.trace() + spin.trace() <= so_far) return so_far;
    const double a = eigenvalue(velocity), b = eigenvalue(spin);
    return 0.5 * (a + b) + std::sqrt(0.25 * (a - b) * (a - b) + both.squaredNorm());
  }

 private:
  static constexpr double slide = 3.5;  // 1 + m r²/I of a solid sphere
  static double eigenvalue(const Mat3& symmetric) {
    return Eigen::SelfAdjointEigenSolver<Mat3>().computeDirect(symmetric, Eigen::EigenvaluesOnly).eigenvalues()[2];
  }
};

}  // namespace

Demand CriticalStep::find(const Instant& at, Team& team) {
  demand_.resize(at.bodies.count());
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

Demand CriticalStep::renew(const Instant& at, double way, Team& team) {
  if (at.skins.walls_walked() > walls_walked_ + way) return find(at, team);
  std::vector<std::size_t> chunks;
  for (std::size_t chunk = 0; chunk < chunk_.size(); ++chunk)
    if (at.skins.walked(chunk) > chunk_[chunk].walked + way) chunks.push_back(chunk);
  return look(chunks, at, team);
}

Demand CriticalStep::look(const std::vector<std::size_t>& chunks, const Instant& at, Team& team) {
  team.each(chunks.size(), [&](std::size_t k) { ask(chunks[k], at); });
  team.each(chunks.size(), [&](std::size_t k) { compare(chunks[k], at.pairs); });
  Demand all;
  for (const Chunk& chunk : chunk_)
    all = {std::max(all.spring, chunk.demand.spring), std::max(all.dashpot, chunk.demand.dashpot)};
  return all;
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
  std::array<double, chunk_bodies> springs{};
  std::array<Dashpots, chunk_bodies> damped;
  at.pairs.each_near(chunk, bodies, at.shifts, at.skins, at.near, [&](std::size_t c, double distance) {
    const std::uint32_t a = at.pairs.a(c), b = at.pairs.b(c);
    const double overlap = std::max(bodies.position[a].w + bodies.position[b].w - distance, 0.0);
    const Stiffness k = at.law.stiffness(size_of(a, b, overlap), bodies.material[a], bodies.material[b]);
    const bool dashpots = k.damping_ratio > 0 || k.shear_damping_ratio > 0;
    const Vec3 normal = dashpots ? at.pairs.branch(c, bodies, at.shifts).normalized() : Vec3::Zero();
    const auto ask = [&](std::uint32_t i, const Vec3& out) {
      if (i < first || i >= last) return;
      springs[i - first] += demand(k, bodies, i);
      if (dashpots) damped[i - first].add(k, out, bodies.velocity[a].w + bodies.velocity[b].w);
    };
    ask(a, normal), ask(b, -normal);
    own.near.push_back(static_cast<std::uint32_t>(c));
  });
  at.walls.each_near(chunk, bodies, at.surfaces, at.near, [&](const Touch& touch, const WallSurface& wall) {
    const std::uint32_t a = touch.body;
    PairSize size = size_of(a, a, std::max(touch.overlap - at.near, 0.0));
    size.inverse_mass_b = 0, size.wall = true;
    const Stiffness k = at.law.stiffness(size, bodies.material[a], wall.material);
    springs[a - first] += demand(k, bodies, a);
    damped[a - first].add(k, touch.normal, bodies.velocity[a].w);
  });
  own.demand = {};
  for (std::size_t i = first; i < last; ++i) {
    const Stiffness k = at.law.stiffness(size_of(i, i, 0), bodies.material[i], bodies.material[i]);
    const double alone = demand(k, bodies, i);
    demand_[i] = std::max(springs[i - first], alone);
    own.demand.spring = std::max({own.demand.spring, 2 * alone, demand_[i]});
    Dashpots pair;
    pair.add(k, Vec3::UnitX(), 2 * bodies.velocity[i].w);
    double& dashpot = own.demand.dashpot;
    dashpot = std::max(dashpot, damped[i - first].largest(dashpot));
    dashpot = std::max(dashpot, pair.largest(dashpot));
  }
}

/// What they ask of the two of a pair.
void CriticalStep::compare(std::size_t chunk, const ContactTable& pairs) {
  double& spring = chunk_[chunk].demand.spring;
  for (const std::uint32_t c : chunk_[chunk].near) spring = std::max(spring, demand_[pairs.a(c)] + demand_[pairs.b(c)]);
}

}  // namespace grit
