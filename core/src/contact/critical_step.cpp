#include "contact/critical_step.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace grit {
namespace {

/// How a body gives way to a push at a contact: inverse masses along and across the normal there, at most [1/kg].
struct Mobility {
  double along, across;
};
Mobility mobility(const Bodies& bodies, std::size_t i, const Vec3& normal) {
  const double radius = bodies.position[i].w, inverse_mass = bodies.velocity[i].w, inverse_inertia = bodies.spin[i].w;
  const std::uint32_t c = bodies.clumps.clump_of(i);
  if (c == no_clump) return {inverse_mass, inverse_mass + radius * radius * inverse_inertia};
  const Vec3 arm = bodies.clumps.clump[c].axes * bodies.clumps.of_body[i].place;
  const double furthest = arm.norm() + radius;
  return {inverse_mass + arm.cross(normal).squaredNorm() * inverse_inertia,
          inverse_mass + furthest * furthest * inverse_inertia};
}

/// What the springs of one contact ask of one of its bodies, 1/s².
double demand(const Stiffness& k, const Bodies& bodies, std::size_t i, const Vec3& normal) {
  const double radius = bodies.position[i].w, inverse_mass = bodies.velocity[i].w, inverse_inertia = bodies.spin[i].w;
  if (bodies.clumps.clump_of(i) == no_clump) {
    const double sliding = k.shear * (inverse_mass + radius * radius * inverse_inertia) + k.rolling * inverse_inertia;
    return std::max({k.normal * inverse_mass, sliding, k.twisting * inverse_inertia});
  }
  const Mobility gives = mobility(bodies, i, normal);
  const double apart = k.normal * gives.along + k.shear * gives.across,
               together = std::max(k.normal, k.shear) * gives.across;
  return std::min(apart, together) + std::max(k.rolling, k.twisting) * inverse_inertia;
}

/// What the dashpots of one contact ask of its bodies where a clump is one of them, 1/s.
double dashpots(const Stiffness& k, const Mobility& a, const Mobility& b, double inverse_mass) {
  const double along = 2 * k.damping_ratio * std::sqrt(k.normal / inverse_mass);
  const double across = 2 * k.shear_damping_ratio * std::sqrt(k.shear / (3.5 * inverse_mass));
  return along * (a.along + b.along) + across * (a.across + b.across);
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
    // The root of the sum of all squares, which costs far less than eigenvalues, is no less than the bound.
    if (velocity.squaredNorm() + spin.squaredNorm() + 2 * both.squaredNorm() <= so_far * so_far && so_far >= 0)
      return so_far;
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
  const Clumps& clumps = at.bodies.clumps;
  if (!clumps.none())
    for (auto* array : {&clumps_.springs, &clumps_.least, &clumps_.dashpots}) array->resize(at.bodies.count());
  team.each(chunks.size(), [&](std::size_t k) { ask(chunks[k], at); });
  if (clumps.none()) {
    team.each(chunks.size(), [&](std::size_t k) { compare(chunks[k], at); });
  } else {
    // A clump's bodies may lie in several chunks.
    clumps_.dashpot.resize(clumps.clump.size());
    for (std::size_t c = 0; c < clumps.clump.size(); ++c) gather(c, clumps);
    team.each(chunk_.size(), [&](std::size_t chunk) { compare(chunk, at); });
  }
  Demand all;
  for (const Chunk& chunk : chunk_)
    for (const Demand& one : {chunk.demand, chunk.together})
      all = {std::max(all.spring, one.spring), std::max(all.dashpot, one.dashpot)};
  return all;
}

/// What contacts ask of the bodies of a chunk.
void CriticalStep::ask(std::size_t chunk, const Instant& at) {
  const Bodies& bodies = at.bodies;
  Chunk& own = chunk_[chunk];
  own.walked = at.skins.walked(chunk);
  own.near.clear();
  const std::size_t first = chunk * chunk_bodies, last = std::min(bodies.count(), first + chunk_bodies);
  const bool clumps = !bodies.clumps.none();
  const auto size_of = [&](std::size_t a, std::size_t b, double overlap) {
    return PairSize{.radius_a = bodies.position[a].w,
                    .radius_b = bodies.position[b].w,
                    .inverse_mass_a = bodies.velocity[a].w,
                    .inverse_mass_b = bodies.velocity[b].w,
                    .overlap = overlap};
  };
  std::array<double, chunk_bodies> springs{}, clump_dashpots{};
  std::array<Dashpots, chunk_bodies> damped;
  at.pairs.each_near(chunk, bodies, at.shifts, at.skins, at.near, [&](std::size_t c, double distance) {
    const std::uint32_t a = at.pairs.a(c), b = at.pairs.b(c);
    const double overlap = std::max(bodies.position[a].w + bodies.position[b].w - distance, 0.0);
    const Stiffness k = at.law.stiffness(size_of(a, b, overlap), bodies.material[a], bodies.material[b]);
    const bool damps = k.damping_ratio > 0 || k.shear_damping_ratio > 0;
    const Vec3 normal = damps || clumps ? at.pairs.branch(c, bodies, at.shifts).normalized() : Vec3(Vec3::Zero());
    const double inverse_mass = bodies.velocity[a].w + bodies.velocity[b].w;
    const bool of_clump = bodies.clumps.clump_of(a) != no_clump || bodies.clumps.clump_of(b) != no_clump;
    const double at_arms =
        damps && of_clump ? dashpots(k, mobility(bodies, a, normal), mobility(bodies, b, normal), inverse_mass) : 0;
    const auto ask = [&](std::uint32_t i, const Vec3& out) {
      if (i < first || i >= last) return;
      springs[i - first] += demand(k, bodies, i, normal);
      if (of_clump) clump_dashpots[i - first] += at_arms;
      else if (damps) damped[i - first].add(k, out, inverse_mass);
    };
    ask(a, normal), ask(b, -normal);
    own.near.push_back(static_cast<std::uint32_t>(c));
  });
  at.walls.each_near(chunk, bodies, at.surfaces, at.near, [&](const Touch& touch, const WallSurface& wall) {
    const std::uint32_t a = touch.body;
    PairSize size = size_of(a, a, std::max(touch.overlap - at.near, 0.0));
    size.inverse_mass_b = 0, size.wall = true;
    const Stiffness k = at.law.stiffness(size, bodies.material[a], wall.material);
    springs[a - first] += demand(k, bodies, a, touch.normal);
    if (bodies.clumps.clump_of(a) != no_clump)
      clump_dashpots[a - first] += dashpots(k, mobility(bodies, a, touch.normal), {}, bodies.velocity[a].w);
    else damped[a - first].add(k, touch.normal, bodies.velocity[a].w);
  });
  own.demand = {};
  for (std::size_t i = first; i < last; ++i) {
    const Stiffness k = at.law.stiffness(size_of(i, i, 0), bodies.material[i], bodies.material[i]);
    const bool in_clump = bodies.clumps.clump_of(i) != no_clump;
    Vec3 across = Vec3::UnitX();
    if (in_clump && !bodies.clumps.of_body[i].place.isZero())
      across = bodies.clumps.clump[bodies.clumps.clump_of(i)].axes * bodies.clumps.of_body[i].place.unitOrthogonal();
    const double alone = demand(k, bodies, i, across);
    demand_[i] = std::max(springs[i - first], alone);
    own.demand.spring = std::max({own.demand.spring, 2 * alone, demand_[i]});
    if (clumps)
      clumps_.springs[i] = springs[i - first], clumps_.least[i] = alone,
      clumps_.dashpots[i] = clump_dashpots[i - first];
    if (in_clump) {
      const Mobility gives = mobility(bodies, i, across);
      own.demand.dashpot = std::max(own.demand.dashpot, dashpots(k, gives, gives, 2 * bodies.velocity[i].w));
      continue;
    }
    Dashpots pair;
    pair.add(k, Vec3::UnitX(), 2 * bodies.velocity[i].w);
    own.demand.dashpot =
        std::max(own.demand.dashpot,
                 clump_dashpots[i - first] + damped[i - first].largest(own.demand.dashpot - clump_dashpots[i - first]));
    own.demand.dashpot = std::max(own.demand.dashpot, pair.largest(own.demand.dashpot));
  }
}

void CriticalStep::gather(std::size_t c, const Clumps& clumps) {
  const Clump& clump = clumps.clump[c];
  const std::span<const std::uint32_t> bodies(clumps.spheres.data() + clump.first, clump.last - clump.first);
  double springs = 0, dashpots = 0;
  for (const std::uint32_t i : bodies) springs += clumps_.springs[i], dashpots += clumps_.dashpots[i];
  for (const std::uint32_t i : bodies) demand_[i] = std::max(clumps_.least[i], springs);
  clumps_.dashpot[c] = dashpots;
}

/// What they ask of the two of a pair, and of clumps as a whole.
void CriticalStep::compare(std::size_t chunk, const Instant& at) {
  Chunk& own = chunk_[chunk];
  own.together = {};
  for (const std::uint32_t c : own.near)
    own.together.spring = std::max(own.together.spring, demand_[at.pairs.a(c)] + demand_[at.pairs.b(c)]);
  if (at.bodies.clumps.none()) return;
  const std::size_t first = chunk * chunk_bodies, last = std::min(at.bodies.count(), first + chunk_bodies);
  for (std::size_t i = first; i < last; ++i) {
    const std::uint32_t c = at.bodies.clumps.clump_of(i);
    if (c == no_clump) continue;
    own.together.spring = std::max(own.together.spring, demand_[i]);
    own.together.dashpot = std::max(own.together.dashpot, clumps_.dashpot[c]);
  }
}

}  // namespace grit
