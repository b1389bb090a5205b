#include "kernel/arrivals.hpp"

#include <algorithm>
#include <iterator>

#include "format/number.hpp"
#include "kernel/body_groups.hpp"
#include "kernel/failure.hpp"

namespace grit {
namespace {

struct Overlap {
  double share = 0;  // over the smaller radius
  std::uint32_t body = 0, other = 0;
  bool with_wall = false;
};

/// Calls use(Overlap) for every overlap of a new body with an old one or a wall.
template <class IsNew, class Use>
void each_overlap(const State& state, const World& world, IsNew is_new, Use use) {
  const Bodies& bodies = state.bodies;
  Skins none;
  none.reset(std::vector<double>(chunks_of(bodies.count()), 0.0), 0, 0);
  NeighbourSearch search;
  Team alone(1);
  search.build(bodies, state.cell.cell(), none, alone);
  std::vector<Candidate> found;
  for (std::uint32_t body = 0; body < bodies.count(); ++body) {
    found.clear();
    search.neighbours(bodies, body, found);
    for (const Candidate& c : found) {
      if (!c.touching() || is_new(c.a) == is_new(c.b)) continue;
      const Row &a = bodies.position[c.a], &b = bodies.position[c.b];
      const double distance = (xyz(b) - xyz(a) + xyz(state.cell.images()[c.image].position)).norm();
      const double share = (a.w + b.w - distance) / std::min(a.w, b.w);
      use(Overlap{share, is_new(c.a) ? c.a : c.b, is_new(c.a) ? c.b : c.a, false});
    }
    if (!is_new(body)) continue;
    const Row& x = bodies.position[body];
    for (std::uint32_t wall = 0; wall < state.walls.size(); ++wall) {
      if (!state.surfaces[wall].acts_on(state.group, body)) continue;
      if (const auto near = world.clearance(wall, xyz(x), x.w))
        use(Overlap{(x.w - near->distance) / x.w, body, wall, true});
    }
  }
}

/// Gravity on new bodies.
class Weights {
 public:
  Weights(const Bodies& arriving, const State& state)
      : arriving_(arriving), state_(state), group_(groups_of(arriving, state.settings.groups)) {}

  Vec3 gravity(std::size_t body, double radius) const {
    return state_.settings.motion_of(group_[body]).gravity_on(radius);
  }
  /// Change of velocity in half a step.
  Vec3 fall(std::size_t body, double radius) const {
    const MotionSettings& motion = state_.settings.motion_of(group_[body]);
    return 0.5 * state_.time.previous_dt * motion.free_translation().cwiseProduct(motion.gravity_on(radius));
  }
  /// A sphere of a clump.
  std::size_t body_of(const Clump& clump) const { return arriving_.clumps.spheres[clump.first]; }

 private:
  const Bodies& arriving_;
  const State& state_;
  std::vector<std::uint16_t> group_;
};

}  // namespace

EnteredEnergy energy_of(const Bodies& arriving, const State& state) {
  const Weights weights(arriving, state);
  EnteredEnergy all;
  const auto add = [&](std::size_t body, double radius, const Vec3& centre, const Vec3& velocity, double inverse_mass) {
    all.kinetic += 0.5 * (velocity + weights.fall(body, radius)).squaredNorm() / inverse_mass;
    all.potential -= weights.gravity(body, radius).dot(centre) / inverse_mass;
  };
  for (std::size_t i = 0; i < arriving.count(); ++i)
    if (arriving.clumps.clump_of(i) == no_clump)
      add(i, arriving.position[i].w, xyz(arriving.position[i]), xyz(arriving.velocity[i]), arriving.velocity[i].w);
  for (const Clump& clump : arriving.clumps.clump)
    add(weights.body_of(clump), clump.radius, clump.centre, clump.velocity, clump.inverse_mass);
  return all;
}

void match_velocities(Bodies& arriving, const State& state) {
  const Weights weights(arriving, state);
  const auto change = [&](std::size_t body, double radius, const Vec3& place) -> Vec3 {
    const Vec3 fall = weights.fall(body, radius);
    return state.cell.deforms() ? Vec3(state.cell.mean_flow(place) - fall) : Vec3(-fall);
  };
  for (std::size_t i = 0; i < arriving.count(); ++i) {
    const std::uint32_t c = arriving.clumps.clump_of(i);
    const Clump* const clump = c == no_clump ? nullptr : &arriving.clumps.clump[c];
    const Vec3 v = clump == nullptr ? change(i, arriving.position[i].w, xyz(arriving.position[i]))
                                    : change(i, clump->radius, clump->centre);
    arriving.velocity[i] += Row{v.x(), v.y(), v.z(), 0};
  }
  for (Clump& clump : arriving.clumps.clump)
    clump.velocity += change(weights.body_of(clump), clump.radius, clump.centre);
}

void check_arrivals(const State& state, const World& world, const std::vector<Newcomers::Group>& groups) {
  const Bodies& bodies = state.bodies;
  const auto group_of = [&](std::uint32_t body) -> const Newcomers::Group& {
    const auto next = std::ranges::upper_bound(groups, bodies.id[body], {}, &Newcomers::Group::first_id);
    return *std::prev(next);
  };
  Overlap deepest;
  std::size_t count = 0;
  each_overlap(
      state, world, [&](std::uint32_t body) { return bodies.id[body] >= groups.front().first_id; },
      [&](const Overlap& one) {
        if (!(one.share > group_of(one.body).overlap)) return;
        ++count;
        if (one.share > deepest.share) deepest = one;
      });
  if (count == 0) return;
  const Newcomers::Group& group = group_of(deepest.body);
  fail_at_body(state, Guard::arrival, {"bodies", group.name}, deepest.body,
               "of group \"" + group.name + "\" appears inside " +
                   (deepest.with_wall ? "wall \"" + state.walls.name(deepest.other) + "\""
                                      : "body " + std::to_string(bodies.id[deepest.other])) +
                   ": they overlap by " + number(deepest.share) + " of " + (deepest.with_wall ? "its" : "the smaller") +
                   " radius, more than /bodies/" + group.name + "/overlap " + number(group.overlap) +
                   (count > 1 ? ", the deepest of " + std::to_string(count) + " such pairs" : ""),
               deepest.with_wall
                   ? "place it in front of the wall; the box of a cloud must not contain walls"
                   : "place it in free space, insert it in another stage, or use a cloud, which avoids other bodies");
}

}  // namespace grit
