// Contacts by code for one law, one material and spheres only. The cost of generality is the time of
// contacts/linear-frictional over that of the faster of two forms. One evaluates pair by pair; the other is written for
// wide registers. Both keep constants of a pair in its list.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "bare_rows.hpp"
#include "dense.hpp"
#include "grit/contact/restitution.hpp"

namespace grit::bench {
namespace {

struct Ball {
  Four position, velocity, spin;  // the fourth: radius, unused, 1
};
struct Pair {
  unsigned a, b;
  double stiffness, dashpot;
};
struct Sum {
  Four force, moment;
};

/// A pair in contact and its history.
struct Meeting {
  Triple branch, velocity;  // of b relative to a
  Triple arms, spins;       // sum of radii times spins; of spins
  double radii;             // their sum
  double stiffness, dashpot;
  Triple shear;
};
struct Answer {
  Triple force, lever, shear;  // on b; of moments; history
};

constexpr double modulus = 300e6, shear_ratio = 0.3;  // as in the material of dense.hpp
const double friction = std::tan(18 * std::numbers::pi / 180), damping = damping_of_restitution(0.85);

/// Two reciprocals by one division, which is slower than several multiplications. Always inlined: otherwise compilers
/// leave the loop in stages scalar.
[[gnu::always_inline]] inline Answer law(const Meeting& m) {
  const Triple branch_before = m.branch - time_step * m.velocity;
  const double distance = std::sqrt(dot(m.branch, m.branch)), overlap = m.radii - distance;
  const double distance_before = std::sqrt(dot(branch_before, branch_before));
  const double per_area = 1 / (distance * distance_before);
  const double per_distance = per_area * distance_before, fraction = distance / m.radii;
  const Triple normal = per_distance * m.branch, before = (per_area * distance) * branch_before;
  const Triple bisector = normal + before;
  const Triple slip =
      m.velocity - cross(m.arms, 0.5 * bisector) + ((m.radii - distance_before) * (1 / time_step)) * (normal - before);
  const double closing = dot(slip, normal);
  const double force = std::max(0.0, m.stiffness * overlap - m.dashpot * closing);

  const double half = 0.25 * time_step * dot(m.spins, normal), secant = 1 + half * half;  // squared
  const double along = dot(bisector, normal), per_both = 1 / (secant * along);
  const double scale = per_both * along, over = per_both * secant;
  const Triple carried = m.shear - (dot(m.shear, normal) * over) * bisector;
  const Triple turned = ((1 - half * half) * scale) * carried + (2 * half * scale) * cross(normal, carried);
  const Triple trial = turned - (shear_ratio * time_step * m.stiffness) * (slip - closing * normal);
  const double length = std::sqrt(dot(trial, trial)), limit = friction * force * fraction;
  const Triple shear = (length > limit ? limit / length : 1.0) * trial;
  return {force * normal + (m.radii * per_distance) * shear, cross(normal, shear), shear};
}

/// The dense grains in the order of a space-filling curve, with neighbour lists of the same skin as in Dense.
class Bare {
 public:
  explicit Bare(std::size_t about) {
    Bodies bodies;
    for (const test::Grain& g : grains(about)) bodies.add(g.position, g.radius, 1, 1, 0, g.velocity, g.spin);
    bodies.finish({});
    const Vec3 open = Vec3::Constant(std::numeric_limits<double>::infinity());
    Team team(1);
    bodies.reorder(spatial_order(bodies, {-open, open}, team), team);
    const auto four = [](const Row& r, double w) { return Four{r.x, r.y, r.z, w}; };
    std::vector<double> mass;
    for (std::size_t i = 0; i < bodies.count(); ++i) {
      const double r = bodies.position[i].w;
      balls_.push_back({four(bodies.position[i], r), four(bodies.velocity[i], 0), four(bodies.spin[i], 1)});
      mass.push_back(2600 * 4 / 3 * std::numbers::pi * r * r * r);
    }
    for (unsigned a = 0; a < balls_.size(); ++a)
      for (unsigned b = a + 1; b < balls_.size(); ++b) {
        const Triple apart = three(balls_[b].position - balls_[a].position);
        const double ra = balls_[a].position[3], rb = balls_[b].position[3], reach = ra + rb + 2 * 0.03 * spacing;
        if (dot(apart, apart) >= reach * reach) continue;
        const double stiffness = 2 * modulus * ra * rb / (ra + rb);
        pairs_.push_back({a, b, stiffness, 2 * damping * std::sqrt(stiffness / (1 / mass[a] + 1 / mass[b]))});
      }
    // Padding: a pair without contact.
    const auto nobody = static_cast<unsigned>(balls_.size());
    balls_.resize(balls_.size() + 2);
    balls_.back().position[0] = 1;
    pairs_.push_back({nobody, nobody + 1, 0, 0});
    memory_.resize(pairs_.size());
    sums_.resize(balls_.size());
  }

  /// Forces and moments of all pairs, one by one; returns the number of contacts.
  std::size_t one_by_one() {
    std::fill(sums_.begin(), sums_.end(), Sum{});
    std::size_t touching = 0;
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      const Pair& pair = pairs_[p];
      const Ball &a = balls_[pair.a], &b = balls_[pair.b];
      const Triple branch = three(b.position - a.position);
      const double ra = a.position[3], rb = b.position[3];
      if (dot(branch, branch) >= (ra + rb) * (ra + rb)) {
        memory_[p] = Four{};
        continue;
      }
      ++touching;
      const auto [force, lever, shear] =
          law({branch, three(b.velocity - a.velocity), three(ra * a.spin + rb * b.spin), three(a.spin + b.spin),
               ra + rb, pair.stiffness, pair.dashpot, three(memory_[p])});
      memory_[p] = Four{shear.x, shear.y, shear.z, 0};
      add(pair, Four{force.x, force.y, force.z, ra}, Four{lever.x, lever.y, lever.z, rb});
    }
    return touching;
  }

  /// The same for blocks of pairs that fit into the first cache, in stages: find contacts, gather their data, evaluate
  /// the law (packed code), add up. The loops are short and have no branches.
  std::size_t in_stages() {
    constexpr std::size_t portion = 128;
    unsigned contact[portion], apart[portion];
    Columns<portion> branch, velocity, arms, spins, memory, force, lever;
    double stiffness[portion], dashpot[portion];

    std::fill(sums_.begin(), sums_.end(), Sum{});
    std::size_t touching = 0;
    for (std::size_t first = 0; first < pairs_.size(); first += portion) {
      const std::size_t last = std::min(pairs_.size(), first + portion);
      std::size_t count = 0, gone = 0;
      for (std::size_t p = first; p < last; ++p) {
        const Four &a = balls_[pairs_[p].a].position, &b = balls_[pairs_[p].b].position;
        const Four squares = (b - a) * (b - a);
        const double radii = a[3] + b[3];
        const bool contacts = squares[0] + squares[1] + squares[2] < radii * radii;
        contact[count] = apart[gone] = static_cast<unsigned>(p);
        count += contacts, gone += !contacts;
      }
      for (std::size_t k = 0; k < gone; ++k) memory_[apart[k]] = Four{};
      touching += count;
      while (count % 8 != 0) contact[count++] = static_cast<unsigned>(pairs_.size() - 1);

      for (std::size_t k = 0; k < count; k += 4) {
        Four rows[5][4];
        for (std::size_t i = 0; i < 4; ++i) {
          const Pair& pair = pairs_[contact[k + i]];
          const Ball &a = balls_[pair.a], &b = balls_[pair.b];
          rows[0][i] = b.position - a.position, rows[1][i] = b.velocity - a.velocity;
          rows[2][i] = a.position[3] * a.spin + b.position[3] * b.spin, rows[3][i] = a.spin + b.spin;
          rows[4][i] = memory_[contact[k + i]];
          stiffness[k + i] = pair.stiffness, dashpot[k + i] = pair.dashpot;
        }
        branch.put(k, rows[0]), velocity.put(k, rows[1]), arms.put(k, rows[2]), spins.put(k, rows[3]);
        memory.put(k, rows[4]);
      }
      for (std::size_t k = 0; k < count; ++k) {
        const double radii = arms.w[k], difference = branch.w[k];
        const Answer answer =
            law({branch.at(k), velocity.at(k), arms.at(k), spins.at(k), radii, stiffness[k], dashpot[k], memory.at(k)});
        memory.set(k, answer.shear), force.set(k, answer.force), lever.set(k, answer.lever);
        force.w[k] = 0.5 * (radii - difference), lever.w[k] = 0.5 * (radii + difference);
      }
      for (std::size_t k = 0; k < count; k += 4) {
        Four rows[3][4];
        force.take(k, rows[0]), lever.take(k, rows[1]), memory.take(k, rows[2]);
        for (std::size_t i = 0; i < 4; ++i) {
          memory_[contact[k + i]] = rows[2][i];
          add(pairs_[contact[k + i]], rows[0][i], rows[1][i]);
        }
      }
    }
    return touching;
  }
  const std::vector<Sum>& sums() const { return sums_; }

 private:
  /// Force and moments of a contact; the radii of a and b in w.
  void add(const Pair& pair, const Four& force, const Four& lever) {
    Sum &a = sums_[pair.a], &b = sums_[pair.b];
    a.force -= force, b.force += force;
    a.moment -= force[3] * lever, b.moment -= lever[3] * lever;
  }

  std::vector<Ball> balls_;
  std::vector<Pair> pairs_;
  std::vector<Four> memory_;  // shear on b
  std::vector<Sum> sums_;
};

/// Whether sums of forces and moments are equal to round-off.
bool same(const std::vector<Sum>& some, const std::vector<Sum>& others) {
  double force = 0, moment = 0, force_off = 0, moment_off = 0;
  const auto square = [](const Four& f) { return dot(three(f), three(f)); };
  for (std::size_t i = 0; i < some.size(); ++i) {
    force = std::max(force, square(some[i].force)), moment = std::max(moment, square(some[i].moment));
    force_off = std::max(force_off, square(some[i].force - others[i].force));
    moment_off = std::max(moment_off, square(some[i].moment - others[i].moment));
  }
  return force_off <= 1e-24 * force && moment_off <= 1e-24 * moment && moment > 0;
}

void bare(benchmark::State& state, std::size_t (Bare::*contacts)()) {
  Bare plain(10000), grains(10000);
  const std::size_t touching = Dense("linear-frictional", 10000).touching();
  for (int step = 0; step < 3; ++step) {
    if (plain.one_by_one() != touching || (grains.*contacts)() != touching)
      return state.SkipWithError("has other contacts than grit");
    if (!same(plain.sums(), grains.sums())) return state.SkipWithError("has other forces than pair by pair");
  }
  for (auto _ : state) {
    (grains.*contacts)();
    benchmark::DoNotOptimize(grains.sums().data());
  }
  state.counters["contacts_per_s"] =
      benchmark::Counter(static_cast<double>(touching), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK_CAPTURE(bare, , &Bare::one_by_one)->Name("bare/linear-frictional/10000");
BENCHMARK_CAPTURE(bare, , &Bare::in_stages)->Name("bare-in-stages/linear-frictional/10000");

}  // namespace
}  // namespace grit::bench
