#include "contact/critical_step.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace grit {
namespace {

/// Compliance of a body to a force at a contact: upper bounds of the inverse masses along and across the normal [1/kg].
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

/// Demand of the springs of one contact on one of its bodies [1/s²]; see CriticalStep.
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

/// Demand of the dashpots of one contact on its bodies if one of them is a clump [1/s].
double dashpots(const Stiffness& k, const Mobility& a, const Mobility& b, double inverse_mass) {
  const double along = 2 * k.damping_ratio * std::sqrt(k.normal / inverse_mass);
  const double across = 2 * k.shear_damping_ratio * std::sqrt(k.shear / (3.5 * inverse_mass));
  return along * (a.along + b.along) + across * (a.across + b.across);
}

constexpr double slide = 3.5;  // 1 + m r²/I of a solid sphere

/// The rates of a contact's dashpots [1/s].
struct Rates {
  double along, across;
};
Rates rates(const Stiffness& k, double inverse_mass) {
  return {2 * k.damping_ratio * std::sqrt(k.normal * inverse_mass),
          2 * k.shear_damping_ratio * std::sqrt(k.shear * inverse_mass / slide)};
}

/// Upper bound of the largest eigenvalue of a matrix of two diagonal blocks, for a body's velocity and for its spin
/// times √(I/m), and an off-diagonal block whose squared norm is `both`.
double joined(double velocity, double spin, double both) {
  return 0.5 * (velocity + spin) + std::sqrt(0.25 * (velocity - spin) * (velocity - spin) + both);
}
/// The same for a single contact.
double largest(const Rates& rates) {
  return joined(std::max(rates.along, rates.across), (slide - 1) * rates.across,
                (slide - 1) * rates.across * rates.across);
}

PairSize size_of(const Bodies& bodies, std::size_t a, std::size_t b, double overlap) {
  return {.radius_a = bodies.position[a].w,
          .radius_b = bodies.position[b].w,
          .inverse_mass_a = bodies.velocity[a].w,
          .inverse_mass_b = bodies.velocity[b].w,
          .overlap = overlap};
}

/// Demand of a body that has one contact, with a body like itself. `overlap`: over its radius.
Demand demand_alone(const Bodies& bodies, std::size_t i, const ContactLaw& law, double overlap) {
  const auto at_overlap = [&](double depth) {
    return law.stiffness(size_of(bodies, i, i, depth), bodies.material[i], bodies.material[i]);
  };
  const Stiffness k = at_overlap(overlap * bodies.position[i].w);
  const std::uint32_t clump = bodies.clumps.clump_of(i);
  Vec3 across = Vec3::UnitX();
  if (clump != no_clump && !bodies.clumps.of_body[i].place.isZero())
    across = bodies.clumps.clump[clump].axes * bodies.clumps.of_body[i].place.unitOrthogonal();
  const Mobility gives = mobility(bodies, i, across);
  const double inverse_mass = 2 * bodies.velocity[i].w;
  // Springs whose stiffness starts at 0 separate softly: the stiffness at first contact counts.
  const double first_contact = overlap > 0 ? at_overlap(0).normal : k.normal;
  return {.spring = 2 * demand(k, bodies, i, across),
          .dashpot = clump != no_clump ? dashpots(k, gives, gives, inverse_mass) : largest(rates(k, inverse_mass)),
          .impact = 2 * first_contact * gives.along};
}

/// Demand of dashpots on a body [1/s], summed over its contacts: along·n n + across·(1 − n n) for its velocity,
/// (slide − 1) across·(1 − n n) for its spin times √(I/m), and √(slide − 1) across·n that couples both. Each of the two
/// bodies of a contact takes the sum of both.
class Dashpots {
 public:
  /// A symmetric matrix: its diagonal, then xy, xz, yz.
  using Six = Eigen::Matrix<double, 6, 1>;
  static Six square(const Vec3& n) {
    return (Six() << n.x() * n.x(), n.y() * n.y(), n.z() * n.z(), n.x() * n.y(), n.x() * n.z(), n.y() * n.z())
        .finished();
  }
  /// One contact, whose normal points out of the body.
  void add(const Rates& rates, const Vec3& normal, const Six& square) {
    line_ += (rates.along - rates.across) * square;
    plane_ += rates.across * square;
    across_ += rates.across;
    both_ += rates.across * normal;
  }
  /// Upper bound of largest(), and far cheaper: the eigenvalues less their mean are the roots of x³ − 3 p² x = 2 q,
  /// which are at most 2 p.
  double at_most() const {
    const auto bound = [](const Six& m) {
      const double mean = m.head<3>().mean();
      const double spread = (m.head<3>().array() - mean).square().sum() + 2 * m.tail<3>().squaredNorm();
      return mean + 2 * std::sqrt(spread / 6);
    };
    return (1 + 1e-12) * joined(bound(velocity()), bound(spin()), both());  // above rounding error
  }
  /// An upper bound of the largest eigenvalue of the whole.
  double largest() const { return joined(eigenvalue(velocity()), eigenvalue(spin()), both()); }

 private:
  Six velocity() const {
    Six m = line_;
    m.head<3>().array() += across_;
    return m;
  }
  Six spin() const {
    Six m = -(slide - 1) * plane_;
    m.head<3>().array() += (slide - 1) * across_;
    return m;
  }
  double both() const { return (slide - 1) * both_.squaredNorm(); }
  static double eigenvalue(const Six& m) {
    const Mat3 full{{m[0], m[3], m[4]}, {m[3], m[1], m[5]}, {m[4], m[5], m[2]}};
    return Eigen::SelfAdjointEigenSolver<Mat3>().computeDirect(full, Eigen::EigenvaluesOnly).eigenvalues()[2];
  }

  Six line_ = Six::Zero(), plane_ = Six::Zero();
  double across_ = 0;
  Vec3 both_ = Vec3::Zero();
};

PairSize size_at_wall(const Bodies& bodies, std::size_t i, double overlap) {
  PairSize size = size_of(bodies, i, i, overlap);
  size.inverse_mass_b = 0, size.wall = true;
  return size;
}

/// Calls `use` with the contacts of a body of the chunk with facets of one mesh, if its radius were larger by `ahead`
/// [m] and there were more than one.
template <class Use>
void each_group_of_facets(std::size_t chunk, const CriticalStep::Instant& at, double ahead, Use use) {
  std::vector<SurfaceContact> found;
  for (std::size_t w = 0; w < at.surfaces.size(); ++w) {
    const WallSurface& wall = at.surfaces[w];
    if (!wall.geometry->is_triangulated()) continue;
    found.clear();
    at.walls.each_near(chunk, at.bodies, wall, w, ahead, [&](const SurfaceContact& one) { found.push_back(one); });
    for (std::size_t begin = 0, end = 0; begin < found.size(); begin = end) {
      while (end < found.size() && found[end].body == found[begin].body) ++end;
      if (end - begin > 1) use(std::span<const SurfaceContact>(found).subspan(begin, end - begin), wall);
    }
  }
}

/// (π / duration)² of the impact of a body on facets that it hits at once [1/s²]; at most that of their springs along
/// one direction.
double impact_on(std::span<const SurfaceContact> facets, const WallSurface& wall, const CriticalStep::Instant& at) {
  Mat3 springs = Mat3::Zero();
  for (const SurfaceContact& contact : facets) {
    const std::uint32_t i = contact.body;
    const double stiffness =
        at.law.stiffness(size_at_wall(at.bodies, i, 0), at.bodies.material[i], wall.material).normal;
    springs += stiffness * mobility(at.bodies, i, contact.normal).along * contact.normal * contact.normal.transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Mat3>().computeDirect(springs, Eigen::EigenvaluesOnly).eigenvalues()[2];
}

}  // namespace

Demand demand_without_contacts(const Bodies& bodies, const ContactLaw& law) {
  Demand all;
  for (std::size_t i = 0; i < bodies.count(); ++i) all = larger(all, demand_alone(bodies, i, law, 0));
  return all;
}

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
  for (const Chunk& chunk : chunk_) all = larger(all, larger(chunk.demand, chunk.together));
  return all;
}

/// Demands of contacts on the bodies of a chunk.
void CriticalStep::ask(std::size_t chunk, const Instant& at) {
  const Bodies& bodies = at.bodies;
  Chunk& own = chunk_[chunk];
  own.walked = at.skins.walked(chunk);
  own.near.clear();
  const std::size_t first = chunk * chunk_bodies, last = std::min(bodies.count(), first + chunk_bodies);
  const bool clumps = !bodies.clumps.none();
  std::array<double, chunk_bodies> springs{}, clump_dashpots{};
  std::array<Dashpots, chunk_bodies> damped;
  at.pairs.each_near(chunk, bodies, at.shifts, at.skins, at.near, [&](std::size_t c, double distance) {
    const std::uint32_t a = at.pairs.a(c), b = at.pairs.b(c);
    const double overlap = std::max(bodies.position[a].w + bodies.position[b].w - distance, 0.0);
    const Stiffness k = at.law.stiffness(size_of(bodies, a, b, overlap), bodies.material[a], bodies.material[b]);
    const bool damps = k.damping_ratio > 0 || k.shear_damping_ratio > 0;
    const Vec3 normal = damps || clumps ? at.pairs.branch(c, bodies, at.shifts).normalized() : Vec3(Vec3::Zero());
    const double inverse_mass = bodies.velocity[a].w + bodies.velocity[b].w;
    const bool of_clump = bodies.clumps.clump_of(a) != no_clump || bodies.clumps.clump_of(b) != no_clump;
    const double at_arms =
        damps && of_clump ? dashpots(k, mobility(bodies, a, normal), mobility(bodies, b, normal), inverse_mass) : 0;
    const Rates dashpot = damps ? rates(k, inverse_mass) : Rates{};
    const Dashpots::Six square = Dashpots::square(normal);
    const auto ask = [&](std::uint32_t i, const Vec3& out) {
      if (i < first || i >= last) return;
      springs[i - first] += demand(k, bodies, i, normal);
      if (of_clump) clump_dashpots[i - first] += at_arms;
      else if (damps) damped[i - first].add(dashpot, out, square);
    };
    ask(a, normal), ask(b, -normal);
    own.near.push_back(static_cast<std::uint32_t>(c));
  });
  const double near = at.near + at.skins.reach();
  const auto ask_wall = [&](const SurfaceContact& contact, const WallSurface& wall, double overlap) {
    const std::uint32_t a = contact.body;
    const Stiffness k = at.law.stiffness(size_at_wall(bodies, a, overlap), bodies.material[a], wall.material);
    springs[a - first] += demand(k, bodies, a, contact.normal);
    if (bodies.clumps.clump_of(a) != no_clump)
      clump_dashpots[a - first] += dashpots(k, mobility(bodies, a, contact.normal), {}, bodies.velocity[a].w);
    else damped[a - first].add(rates(k, bodies.velocity[a].w), contact.normal, Dashpots::square(contact.normal));
  };
  at.walls.each_near(chunk, bodies, at.surfaces, near, [&](const SurfaceContact& contact, const WallSurface& wall) {
    ask_wall(contact, wall, std::max(contact.overlap - near, 0.0));
  });
  own.demand = {};
  const double ahead = at.ahead + at.skins.reach();
  each_group_of_facets(chunk, at, ahead, [&](std::span<const SurfaceContact> facets, const WallSurface& wall) {
    const double impact = impact_on(facets, wall, at);
    if (impact <= demand_alone(bodies, facets.front().body, at.law, at.overlap).impact) return;
    own.demand.impact = std::max(own.demand.impact, impact);
    for (const SurfaceContact& contact : facets)
      if (contact.overlap <= ahead - near) ask_wall(contact, wall, 0);
  });
  for (std::size_t i = first; i < last; ++i) {
    const Demand alone = demand_alone(bodies, i, at.law, at.overlap);
    const double of_one = 0.5 * alone.spring;
    demand_[i] = std::max(springs[i - first], of_one);
    own.demand.spring = std::max({own.demand.spring, alone.spring, demand_[i]});
    own.demand.impact = std::max(own.demand.impact, alone.impact);
    own.demand.dashpot = std::max(own.demand.dashpot, alone.dashpot);
    if (clumps)
      clumps_.springs[i] = springs[i - first], clumps_.least[i] = of_one,
      clumps_.dashpots[i] = clump_dashpots[i - first];
  }
  // Starts with the body of the largest bound: then few others need an exact evaluation.
  std::array<double, chunk_bodies> most{};
  for (std::size_t i = first; i < last; ++i) most[i - first] = clump_dashpots[i - first] + damped[i - first].at_most();
  const auto look = [&](std::size_t i) {
    if (most[i] > own.demand.dashpot)
      own.demand.dashpot = std::max(own.demand.dashpot, clump_dashpots[i] + damped[i].largest());
  };
  look(static_cast<std::size_t>(std::ranges::max_element(most) - most.begin()));
  for (std::size_t i = 0; i < last - first; ++i) look(i);
}

void CriticalStep::gather(std::size_t c, const Clumps& clumps) {
  const Clump& clump = clumps.clump[c];
  const std::span<const std::uint32_t> bodies(clumps.spheres.data() + clump.first, clump.last - clump.first);
  double springs = 0, dashpots = 0;
  for (const std::uint32_t i : bodies) springs += clumps_.springs[i], dashpots += clumps_.dashpots[i];
  for (const std::uint32_t i : bodies) demand_[i] = std::max(clumps_.least[i], springs);
  clumps_.dashpot[c] = dashpots;
}

/// Demands on the two bodies of a pair, and on clumps as a whole.
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
