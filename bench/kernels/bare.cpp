// Contacts by a loop that knows one law, one material and spheres, and nothing else: what generality costs is the time
// of contacts/linear-frictional over that of this. Pair by pair, as one writes it down; the compiler may do what it
// can.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "dense.hpp"
#include "grit/contact/restitution.hpp"

namespace grit::bench {
namespace {

struct Triple {
  double x, y, z;
};
inline Triple operator+(Triple a, Triple b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Triple operator-(Triple a, Triple b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Triple operator*(double s, Triple a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(Triple a, Triple b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Triple cross(Triple a, Triple b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

struct Ball {
  Triple position, velocity, spin;
  double radius, inverse_mass;
};
struct Neighbours {
  unsigned a, b;
};
struct Sum {
  Triple force, moment;
};

/// The dense grains, filed along a space-filling curve, with lists of neighbours as near as Dense has them.
class Bare {
 public:
  explicit Bare(std::size_t about) {
    Bodies bodies;
    for (const test::Grain& g : grains(about)) bodies.add(g.position, g.radius, 1, 1, 0, g.velocity, g.spin);
    bodies.finish({});
    const Vec3 open = Vec3::Constant(std::numeric_limits<double>::infinity());
    bodies.reorder(spatial_order(bodies, {-open, open}));
    const auto triple = [](const Row& r) { return Triple{r.x, r.y, r.z}; };
    for (std::size_t i = 0; i < bodies.count(); ++i) {
      const double r = bodies.position[i].w, mass = 2600 * 4 / 3 * std::numbers::pi * r * r * r;
      balls_.push_back({triple(bodies.position[i]), triple(bodies.velocity[i]), triple(bodies.spin[i]), r, 1 / mass});
    }
    for (unsigned a = 0; a < balls_.size(); ++a)
      for (unsigned b = a + 1; b < balls_.size(); ++b) {
        const Triple apart = balls_[b].position - balls_[a].position;
        const double reach = balls_[a].radius + balls_[b].radius + 2 * 0.03 * spacing;
        if (dot(apart, apart) < reach * reach) pairs_.push_back({a, b});
      }
    memory_.assign(pairs_.size(), {});
    sums_.resize(balls_.size());
  }

  /// Forces and moments of all; returns how many touch.
  std::size_t contacts() {
    std::fill(sums_.begin(), sums_.end(), Sum{});
    std::size_t touching = 0;
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      const auto [i, j] = pairs_[p];
      const Ball &a = balls_[i], &b = balls_[j];
      const Triple branch = b.position - a.position;
      const double square = dot(branch, branch), radii = a.radius + b.radius;
      if (square >= radii * radii) {
        memory_[p] = {};
        continue;
      }
      ++touching;
      const double distance = std::sqrt(square), overlap = radii - distance;
      const Triple normal = (1 / distance) * branch, velocity = b.velocity - a.velocity;
      const Triple branch_before = branch - time_step * velocity;
      const double distance_before = std::sqrt(dot(branch_before, branch_before));
      const Triple before = (1 / distance_before) * branch_before, bisector = normal + before;
      const Triple slip = velocity - cross(a.radius * a.spin + b.radius * b.spin, 0.5 * bisector) +
                          ((radii - distance_before) / time_step) * (normal - before);

      const double kn = 2 * modulus * a.radius * b.radius / radii, ks = shear_ratio * kn;
      const double dashpot = 2 * damping_ * std::sqrt(kn / (a.inverse_mass + b.inverse_mass));
      const double closing = dot(slip, normal), force = std::max(0.0, kn * overlap - dashpot * closing);

      const double half = 0.25 * time_step * dot(a.spin + b.spin, normal), scale = 1 / (1 + half * half);
      const Triple carried = memory_[p] - (dot(memory_[p], normal) / dot(bisector, normal)) * bisector;
      const Triple turned = (1 - half * half) * scale * carried + 2 * half * scale * cross(normal, carried);
      const Triple trial = turned - (ks * time_step) * (slip - closing * normal);
      const double length = std::sqrt(dot(trial, trial)), limit = friction_ * force;
      const Triple shear = length > limit ? (limit / length) * trial : trial;
      memory_[p] = shear;

      const Triple on_b = force * normal + shear, lever = cross(normal, shear);
      sums_[i].force = sums_[i].force - on_b, sums_[j].force = sums_[j].force + on_b;
      sums_[i].moment = sums_[i].moment - (a.radius - 0.5 * overlap) * lever;
      sums_[j].moment = sums_[j].moment - (b.radius - 0.5 * overlap) * lever;
    }
    return touching;
  }
  const std::vector<Sum>& sums() const { return sums_; }

 private:
  static constexpr double modulus = 300e6, shear_ratio = 0.3;  // as dense.hpp's material has them
  const double friction_ = std::tan(18 * std::numbers::pi / 180), damping_ = damping_of_restitution(0.85);
  std::vector<Ball> balls_;
  std::vector<Neighbours> pairs_;
  std::vector<Triple> memory_;
  std::vector<Sum> sums_;
};

void bare(benchmark::State& state) {
  static Bare grains(10000);
  const std::size_t touching = grains.contacts();
  if (const Dense same("linear-frictional", 10000); touching != same.touching()) {
    state.SkipWithError("has other contacts than grit");
    return;
  }
  for (auto _ : state) {
    grains.contacts();
    benchmark::DoNotOptimize(grains.sums().data());
  }
  state.counters["contacts_per_s"] =
      benchmark::Counter(static_cast<double>(touching), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(bare)->Name("bare/linear-frictional/10000");

}  // namespace
}  // namespace grit::bench
