#include "contact/critical_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "bodies/restored.hpp"

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

/// A symmetric matrix: its diagonal, then xy, xz, yz; the fourth numbers are 0.
struct Symmetric {
  Quad diagonal{}, off{};
  Symmetric& operator+=(const Symmetric& other) { return diagonal += other.diagonal, off += other.off, *this; }
  friend Symmetric operator*(double factor, const Symmetric& m) { return {factor * m.diagonal, factor * m.off}; }
  double mean() const { return (diagonal[0] + diagonal[1] + diagonal[2]) / 3; }
};
/// n n.
Symmetric square_of(const Vec3& n) {
  return {Quad{n.x() * n.x(), n.y() * n.y(), n.z() * n.z(), 0}, Quad{n.x() * n.y(), n.x() * n.z(), n.y() * n.z(), 0}};
}

double sum_of(const Quad& q) { return q[0] + q[1] + q[2]; }

/// Sum of the squares of a symmetric matrix, less its mean on the diagonal.
double spread_of(const Symmetric& m) {
  const double mean = m.mean();
  const Quad d = m.diagonal - Quad{mean, mean, mean, 0};
  return sum_of(d * d) + 2 * sum_of(m.off * m.off);
}

constexpr double above_rounding = 1 + 1e-12;

/// Upper bound of the largest eigenvalue.
double eigenvalue_bound(const Symmetric& m) { return m.mean() + above_rounding * 2 * std::sqrt(spread_of(m) / 6); }

/// Upper bound of the largest eigenvalue, at most 0.1 % of its deviation from the mean too large.
double largest_eigenvalue(const Symmetric& m) {
  const double mean = m.mean(), spread = spread_of(m);
  if (!(spread > 0)) return mean;
  const double dx = m.diagonal[0] - mean, dy = m.diagonal[1] - mean, dz = m.diagonal[2] - mean;
  const double xy = m.off[0], xz = m.off[1], yz = m.off[2];
  // Deviations x from the mean are the roots of x³ − 3 p² x − 2 q. The largest is 2 p cos(φ/3) with cos φ = q/p³, a
  // concave function of cos(φ/2), which its tangents at both ends bound. Newton's method stays above the largest root.
  const double p = std::sqrt(spread / 6);
  const double q = 0.5 * (dx * dy * dz + 2 * xy * xz * yz - dx * yz * yz - dy * xz * xz - dz * xy * xy);
  const double half = std::sqrt(std::clamp(0.5 * (1 + q / (p * p * p)), 0.0, 1.0));
  double x = 2 * p * std::min(0.5 + half / std::numbers::sqrt3, (5 + 4 * half) / 9);
  // The derivative vanishes where the two largest roots are equal; the tangent is exact there.
  if (x > 1.001 * p) x -= (x * (x * x - 3 * p * p) - 2 * q) / (3 * (x * x - p * p));
  return mean + above_rounding * x;
}

/// Demand of springs [1/s²] or dashpots [1/s] on a body, summed over its contacts as tensors: along·n n + across·(1 − n
/// n) for its velocity, twisting·n n + rolling·(1 − n n) for its spin times √(I/m), and coupling·n between both.
class Tensors {
 public:
  struct Contact {
    double along, across, twisting, rolling, coupling;
  };
  /// `normal` points out of the body; `square`: square_of() it.
  void add(const Contact& one, const Vec3& normal, const Symmetric& square) {
    line_ += (one.along - one.across) * square, across_ += one.across;
    axis_ += (one.twisting - one.rolling) * square, rolling_ += one.rolling;
    coupling_ += one.coupling * Quad{normal.x(), normal.y(), normal.z(), 0};
  }
  /// Upper bound of the largest eigenvalue of the whole.
  double largest() const { return whole(largest_eigenvalue(line_), largest_eigenvalue(axis_)); }
  /// One that costs less and is no lower.
  double bound() const { return whole(eigenvalue_bound(line_), eigenvalue_bound(axis_)); }

 private:
  double whole(double line, double axis) const {
    return joined(across_ + line, rolling_ + axis, sum_of(coupling_ * coupling_));
  }

  Symmetric line_, axis_;
  Quad coupling_{};
  double across_ = 0, rolling_ = 0;
};

/// Springs of a contact on a sphere. `root`: √(1/m · 1/I) of it.
Tensors::Contact springs_on(const Stiffness& k, const Bodies& bodies, std::size_t i, double root) {
  const double radius = bodies.position[i].w, inverse_mass = bodies.velocity[i].w, inverse_inertia = bodies.spin[i].w;
  return {.along = k.normal * inverse_mass,
          .across = k.shear * inverse_mass,
          .twisting = k.twisting * inverse_inertia,
          .rolling = (k.shear * radius * radius + k.rolling) * inverse_inertia,
          .coupling = k.shear * radius * root};
}

/// Dashpots of a contact, as each of its two bodies takes the sum of both.
Tensors::Contact dashpots_on(const Rates& rates) {
  return {.along = rates.along,
          .across = rates.across,
          .twisting = 0,
          .rolling = (slide - 1) * rates.across,
          .coupling = std::sqrt(slide - 1) * rates.across};
}

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
  Symmetric springs;
  for (const SurfaceContact& contact : facets) {
    const std::uint32_t i = contact.body;
    const double stiffness =
        at.law.stiffness(size_at_wall(at.bodies, i, 0), at.bodies.material[i], wall.material).normal;
    springs += stiffness * mobility(at.bodies, i, contact.normal).along * square_of(contact.normal);
  }
  return largest_eigenvalue(springs);
}

}  // namespace

Demand demand_without_contacts(const Bodies& bodies, const ContactLaw& law) {
  Demand all;
  for (std::size_t i = 0; i < bodies.count(); ++i) all = larger(all, demand_alone(bodies, i, law, 0));
  return all;
}

// A chunk is evaluated again when the springs of one of its bodies have stiffened by this factor.
constexpr double growth_due = 1.1;
// Over the displacement after which the chunk with the shortest step is evaluated again, the demands of a chunk's
// contacts are taken to grow by this fraction, and one body to get a new contact. Over 1.1 to 1.7 times as much, those
// of 99 of 100 chunks of bench/scenes/drum-hertz.json grew by less than 0.03, and none by more than 0.1.
constexpr double usual_growth = 1.0 / 8;
constexpr double most_slack = 4, most_patience = 8;

Demand CriticalStep::find(const Instant& at, Team& team) {
  demand_.resize(at.bodies.count()), least_.resize(at.bodies.count());
  chunk_.resize(chunks_of(at.bodies.count()));
  std::vector<std::size_t> own(at.ranks.last() - at.ranks.first());
  std::iota(own.begin(), own.end(), at.ranks.first());
  team.each(own.size(), [&](std::size_t k) { evaluate_alone(own[k], at); });
  if (!at.bodies.clumps.none()) at.ranks.complete_bodies(least_, at.bodies.count());
  return evaluate(own, at, team);
}

void CriticalStep::forget(std::size_t bodies) {
  demand_.assign(bodies, 0), least_.assign(bodies, 0);
  clumps_ = {};
  chunk_.assign(chunks_of(bodies), {});
  shortest_ = 0;
}

void CriticalStep::check_restored(std::size_t bodies) const {
  expect_restored(demand_.size() == bodies && least_.size() == bodies && chunk_.size() == chunks_of(bodies),
                  "the critical time step is of another number of bodies");
}

void CriticalStep::serialize(SharedArchive& archive, const ContactTable& pairs) {
  for (auto* list : {&demand_, &least_, &clumps_.springs, &clumps_.dashpots})
    list->resize(archive.length(list->size(), sizeof(double)));
  archive(clumps_.dashpot, shortest_);
  for (auto* list : {&demand_, &least_, &clumps_.springs, &clumps_.dashpots}) archive.each_body(list->size(), *list);
  chunk_.resize(archive.length(chunk_.size(), 1));
  archive.each_chunk(chunk_.size(), [&](Archive& to, std::size_t chunk) {
    Chunk& own = chunk_[chunk];
    std::vector<std::uint32_t> places;
    if (!archive.restoring()) places = pairs.places(chunk, own.near);
    to(own, places);
    if (archive.restoring() && archive.ranks().owns(chunk)) own.near = pairs.candidates_at(chunk, places);
  });
}

double CriticalStep::slack(const Chunk& chunk) const {
  if (!std::isfinite(shortest_)) return 1;
  return std::clamp(1 / chunk.all().share(shortest_), 1.0, most_slack);
}

double CriticalStep::patience(const Chunk& chunk) const {
  if (!std::isfinite(shortest_)) return 1;
  const double own = chunk.all().share(shortest_), left = std::max(0.0, 1 - own);
  return std::min(1 + left / (usual_growth * own + chunk.fresh.share(shortest_)), most_patience);
}

bool CriticalStep::bodies_moved(std::size_t chunk, const WallContacts& walls, const Skins& skins, double way) const {
  const Chunk& own = chunk_[chunk];
  way *= patience(own);
  const bool since_search = own.evaluated_at_search();
  if ((since_search ? skins.approached(chunk) : skins.across(chunk) - own.approached) > way) return true;
  if (!own.at_walls && !walls.has_candidates(chunk)) return false;
  return (since_search ? skins.displaced(chunk) : skins.walked(chunk) - own.walked) > way;
}

bool CriticalStep::moved(std::size_t chunk, const WallContacts& walls, const Skins& skins, double way) const {
  if (bodies_moved(chunk, walls, skins, way)) return true;
  const Chunk& own = chunk_[chunk];
  if (!own.at_walls && !walls.has_candidates(chunk)) return false;
  // Candidates that a search at walls has just found may touch a wall before it has moved as far.
  return skins.walls_walked() > own.walls_walked + patience(own) * way ||
         skins.walls_walked_at_search() > own.walls_walked;
}

bool CriticalStep::pressed(std::size_t chunk, double overlap) const {
  const Chunk& own = chunk_[chunk];
  const double may_grow = slack(own);
  return own.overlap > may_grow * may_grow * std::max(growth_due * growth_due * own.least_overlap, overlap);
}

double CriticalStep::stiffness(std::size_t chunk, const Instant& at) const {
  const Bodies& bodies = at.bodies;
  const std::size_t first = chunk * chunk_bodies, last = std::min(bodies.count(), first + chunk_bodies);
  std::array<double, chunk_bodies> sums{};
  const auto add = [&](std::uint32_t i, double root) {
    if (i >= first && i < last) sums[i - first] += root * bodies.velocity[i].w;
  };
  for (const std::uint32_t c : chunk_[chunk].near) {
    const std::uint32_t a = at.pairs.a(c), b = at.pairs.b(c);
    const double r_a = bodies.position[a].w, r_b = bodies.position[b].w;
    const double overlap = r_a + r_b - at.pairs.branch(c, bodies, at.shifts).norm();
    if (overlap <= 0) continue;
    const double root = std::sqrt(r_a * r_b / (r_a + r_b) * overlap);
    add(a, root), add(b, root);
  }
  at.walls.each_near(chunk, bodies, at.surfaces, 0, [&](const SurfaceContact& contact, const WallSurface&) {
    add(contact.body, std::sqrt(bodies.position[contact.body].w * std::max(contact.overlap, 0.0)));
  });
  return *std::ranges::max_element(sums);
}

std::vector<std::size_t> CriticalStep::in_doubt(const WallContacts& walls, const Skins& skins, const Change& change,
                                                const Ranks& ranks) const {
  std::vector<std::size_t> found;
  for (std::size_t chunk = ranks.first(); chunk < ranks.last(); ++chunk)
    if (chunk_[chunk].evaluated_at_search() && bodies_moved(chunk, walls, skins, change.way)) found.push_back(chunk);
  return found;
}

bool CriticalStep::due(const WallContacts& walls, const Skins& skins, const Change& change, const Ranks& ranks) const {
  bool due = false;
  for (std::size_t chunk = ranks.first(); chunk < ranks.last() && !due; ++chunk)
    due = moved(chunk, walls, skins, change.way) || pressed(chunk, change.overlap);
  return due;
}

Demand CriticalStep::renew(const Instant& at, const Change& change, Team& team) {
  std::vector<std::uint8_t> due(chunk_.size());
  const std::size_t first = at.ranks.first();
  team.each(at.ranks.last() - first, [&](std::size_t k) {
    const std::size_t chunk = first + k;
    due[chunk] = moved(chunk, at.walls, at.skins, change.way);
    if (due[chunk] || !pressed(chunk, change.overlap)) return;
    Chunk& own = chunk_[chunk];
    own.least_overlap = own.overlap;
    due[chunk] = stiffness(chunk, at) > slack(own) * growth_due * own.stiffness;
  });
  std::vector<std::size_t> chunks;
  for (std::size_t chunk = 0; chunk < chunk_.size(); ++chunk)
    if (due[chunk]) chunks.push_back(chunk);
  return evaluate(chunks, at, team);
}

Demand CriticalStep::evaluate(const std::vector<std::size_t>& chunks, const Instant& at, Team& team) {
  const Clumps& clumps = at.bodies.clumps;
  if (!clumps.none())
    for (auto* array : {&clumps_.springs, &clumps_.dashpots}) array->resize(at.bodies.count());
  const std::vector<double> closings = at.pairs.closings_across(at.skins);
  team.each(chunks.size(), [&](std::size_t k) {
    sum(chunks[k], at, closings);
    if (at.overlap > 0) chunk_[chunks[k]].stiffness = stiffness(chunks[k], at);
  });
  Ranks& ranks = at.ranks;
  if (clumps.none()) {
    at.halo.exchange(demand_, ranks);
    team.each(chunks.size(), [&](std::size_t k) { compare(chunks[k], at); });
  } else {
    // A clump's bodies may lie in several chunks.
    for (auto* array : {&demand_, &clumps_.springs, &clumps_.dashpots})
      ranks.complete_bodies(*array, at.bodies.count());
    clumps_.dashpot.resize(clumps.clump.size());
    for (std::size_t c = 0; c < clumps.clump.size(); ++c) gather(c, clumps);
    team.each(ranks.last() - ranks.first(), [&](std::size_t k) { compare(ranks.first() + k, at); });
  }
  Demand all;
  for (std::size_t chunk = ranks.first(); chunk < ranks.last(); ++chunk) all = larger(all, chunk_[chunk].all());
  for (const Demand& of_rank : ranks.each(all)) all = larger(all, of_rank);
  shortest_ = all.critical_time_step();
  return all;
}

/// Demands of bodies with one contact, with a body like themselves.
void CriticalStep::evaluate_alone(std::size_t chunk, const Instant& at) {
  Demand &all = chunk_[chunk].alone, &fresh = chunk_[chunk].fresh;
  all = fresh = {};
  const std::size_t first = chunk * chunk_bodies, last = std::min(at.bodies.count(), first + chunk_bodies);
  for (std::size_t i = first; i < last; ++i) {
    const Demand alone = demand_alone(at.bodies, i, at.law, at.overlap);
    least_[i] = 0.5 * alone.spring;
    all = larger(all, alone);
    fresh = larger(fresh, at.overlap > 0 ? demand_alone(at.bodies, i, at.law, 0) : alone);
  }
  fresh.spring *= 0.5;  // of one of both bodies
}

/// Demands of contacts on the bodies of a chunk.
void CriticalStep::sum(std::size_t chunk, const Instant& at, std::span<const double> closings) {
  const Bodies& bodies = at.bodies;
  Chunk& own = chunk_[chunk];
  own.at_walls = at.walls.has_candidates(chunk);
  own.approached = at.skins.across(chunk), own.walked = at.skins.walked(chunk),
  own.walls_walked = at.skins.walls_walked();
  own.overlap = 0;
  own.near.clear();
  const std::size_t first = chunk * chunk_bodies, last = std::min(bodies.count(), first + chunk_bodies);
  const bool clumps = !bodies.clumps.none();
  struct Sums {
    double springs = 0, dashpots = 0;  // of clumps, and upper bounds for spheres
    double root = 0;                   // √(1/m · 1/I)
    Tensors sphere_springs, sphere_dashpots;
  };
  std::array<Sums, chunk_bodies> sums;
  for (std::size_t i = first; i < last; ++i) sums[i - first].root = std::sqrt(bodies.velocity[i].w * bodies.spin[i].w);
  bool damped = false;
  const auto add = [&](std::uint32_t i, const Stiffness& k, const Vec3& normal, const Symmetric& square) {
    Sums& to = sums[i - first];
    to.springs += demand(k, bodies, i, normal);
    if (bodies.clumps.clump_of(i) == no_clump) to.sphere_springs.add(springs_on(k, bodies, i, to.root), normal, square);
  };
  at.pairs.each_near(chunk, bodies, at.shifts, at.skins, closings, at.near, [&](std::size_t c, double distance) {
    own.near.push_back(static_cast<std::uint32_t>(c));
    const std::uint32_t a = at.pairs.a(c), b = at.pairs.b(c);
    const double overlap = std::max(bodies.position[a].w + bodies.position[b].w - distance, 0.0);
    own.overlap = std::max(own.overlap, overlap / std::min(bodies.position[a].w, bodies.position[b].w));
    const Stiffness k = at.law.stiffness(size_of(bodies, a, b, overlap), bodies.material[a], bodies.material[b]);
    const Vec3 branch = at.pairs.branch(c, bodies, at.shifts);
    const Vec3 normal = distance > 0 ? Vec3(branch / distance) : branch;
    const Symmetric square = square_of(normal);
    const bool has_a = a >= first && a < last, has_b = b >= first && b < last;
    if (has_a) add(a, k, normal, square);
    if (has_b) add(b, k, -normal, square);
    if (k.damping_ratio <= 0 && k.shear_damping_ratio <= 0) return;
    damped = true;
    const double inverse_mass = bodies.velocity[a].w + bodies.velocity[b].w;
    if (bodies.clumps.clump_of(a) != no_clump || bodies.clumps.clump_of(b) != no_clump) {
      const double at_arms = dashpots(k, mobility(bodies, a, normal), mobility(bodies, b, normal), inverse_mass);
      if (has_a) sums[a - first].dashpots += at_arms;
      if (has_b) sums[b - first].dashpots += at_arms;
    } else {
      const Tensors::Contact dashpot = dashpots_on(rates(k, inverse_mass));
      if (has_a) sums[a - first].sphere_dashpots.add(dashpot, normal, square);
      if (has_b) sums[b - first].sphere_dashpots.add(dashpot, -normal, square);
    }
  });
  const double near = at.near + at.skins.reach();
  const auto add_wall = [&](const SurfaceContact& contact, const WallSurface& wall, double overlap) {
    const std::uint32_t a = contact.body;
    own.overlap = std::max(own.overlap, overlap / bodies.position[a].w);
    const Stiffness k = at.law.stiffness(size_at_wall(bodies, a, overlap), bodies.material[a], wall.material);
    const Symmetric square = square_of(contact.normal);
    add(a, k, contact.normal, square);
    if (k.damping_ratio <= 0 && k.shear_damping_ratio <= 0) return;
    damped = true;
    Sums& to = sums[a - first];
    if (bodies.clumps.clump_of(a) != no_clump)
      to.dashpots += dashpots(k, mobility(bodies, a, contact.normal), {}, bodies.velocity[a].w);
    else to.sphere_dashpots.add(dashpots_on(rates(k, bodies.velocity[a].w)), contact.normal, square);
  };
  at.walls.each_near(chunk, bodies, at.surfaces, near, [&](const SurfaceContact& contact, const WallSurface& wall) {
    add_wall(contact, wall, std::max(contact.overlap - near, 0.0));
  });
  own.least_overlap = own.overlap;
  own.demand = own.alone;
  const double ahead = at.ahead + at.skins.reach();
  each_group_of_facets(chunk, at, ahead, [&](std::span<const SurfaceContact> facets, const WallSurface& wall) {
    const double impact = impact_on(facets, wall, at);
    if (impact <= demand_alone(bodies, facets.front().body, at.law, at.overlap).impact) return;
    own.demand.impact = std::max(own.demand.impact, impact);
    for (const SurfaceContact& contact : facets)
      if (contact.overlap <= ahead - near) add_wall(contact, wall, 0);
  });
  for (std::size_t i = first; i < last; ++i) {
    const Sums& of = sums[i - first];
    if (clumps) clumps_.springs[i] = of.springs, clumps_.dashpots[i] = of.dashpots;
    demand_[i] = least_[i];
    if (of.springs > least_[i]) {
      const bool sphere = bodies.clumps.clump_of(i) == no_clump;
      demand_[i] = std::max(least_[i], sphere ? std::min(of.springs, of.sphere_springs.largest()) : of.springs);
    }
    own.demand.spring = std::max(own.demand.spring, demand_[i]);
    if (damped && of.dashpots + of.sphere_dashpots.bound() > own.demand.dashpot)
      own.demand.dashpot = std::max(own.demand.dashpot, of.dashpots + of.sphere_dashpots.largest());
  }
}

void CriticalStep::gather(std::size_t c, const Clumps& clumps) {
  const Clump& clump = clumps.clump[c];
  const std::span<const std::uint32_t> bodies(clumps.spheres.data() + clump.first, clump.last - clump.first);
  double springs = 0, dashpots = 0;
  for (const std::uint32_t i : bodies) springs += clumps_.springs[i], dashpots += clumps_.dashpots[i];
  for (const std::uint32_t i : bodies) demand_[i] = std::max(least_[i], springs);
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
