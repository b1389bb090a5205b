// Closed paths of two spheres leave no shear force and yield no energy: back and forth, around a square, around each
// other. For springs whose stiffness grows with the overlap, the force left after a square depends on the order of its
// sides.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "bodies/random.hpp"
#include "grit/plugin.hpp"
#include "support/scene.hpp"
#include "support/verified.hpp"

namespace grit::test::closed_cycle_tests {
namespace {

using std::numbers::pi;

struct Place {
  Vec3 position;
  double angle = 0;  ///< rotation about z
};
/// Prescribed position of body `id` at a fraction 0 … 1 of the path.
using Way = std::function<Place(std::uint32_t id, double share)>;

/// Moves bodies along a path: each is so heavy that nothing else moves it. The engine's forces give it the velocity of
/// the next step.
struct Leader final : Engine {
  static inline Way way;
  static inline double steps = 0;

  void declare(Parameters&) override {}
  Phase phase() const override { return Phase::forces; }
  void forces(const World& world, std::span<Row> force, std::span<Row> moment) const override {
    const double kick = world.step() == 0 ? 0.5 * world.dt() : world.dt();
    const auto share = static_cast<double>(world.step()) / steps;
    for (std::size_t i = 0; i < force.size(); ++i) {
      const Place now = way(world.ids()[i], share), next = way(world.ids()[i], share + 1 / steps);
      const Row &v = world.velocities()[i], &w = world.spins()[i];
      const Vec3 push = ((next.position - now.position) / world.dt() - xyz(v)) / (kick * v.w);
      force[i] = {push.x(), push.y(), push.z(), 0};
      moment[i] = {0, 0, ((next.angle - now.angle) / world.dt() - w.z) / (kick * w.w), 0};
    }
  }
};

constexpr double radius_a = 1e-3, radius_b = 2e-3, modulus = 1e8;

struct Course {
  double most = 0, left = 0, radial = 0;  ///< maximum and final shear force [N]; final radial force [N]
  Vec3 force = Vec3::Zero();              ///< the last shear force on the second body
  double work = 0;                        ///< of the force on the second body as it moves [J]
};
Course lead(const Way& way, double steps, const std::string& law = "linear-rolling") {
  static const PluginInfo info = [] {
    PluginInfo leader;
    leader.kind = "engine", leader.name = "leader", leader.version = "1.0.0", leader.doc = "for tests";
    leader.make_engine = []() -> Engine* { return new Leader; };
    return leader;
  }();
  installed().add(info);
  Leader::way = way, Leader::steps = steps;
  Description d = description(law, {{"density", 1e25}, {"friction_angle", "80 deg"}},
                              {{way(0, 0).position, radius_a}, {way(1, 0).position, radius_b}});
  if (law != "hertz-mindlin") d["materials"]["grain"]["contact_modulus"] = modulus;
  d["engines"]["leader"] = {{"type", "leader"}};
  d["time_step"]["value"] = 1;
  Trial t(d);
  const auto on_second = [&](const Contact& c, const Vec3& force) -> Vec3 {
    return t.world().ids()[c.a] == 0 ? force : Vec3(-force);
  };
  Course course;
  Vec3 before = t.position(1), push = Vec3::Zero();
  if (const auto contacts = t.world().contacts(); !contacts.empty())
    push = on_second(contacts.front(), contacts.front().force);
  for (int i = 0; i < steps; ++i) {
    t.step();
    const auto contacts = t.world().contacts();
    if (contacts.empty()) return course;
    const Contact& c = contacts.front();
    course.force = on_second(c, c.force - c.normal_force * c.normal);
    course.left = course.force.norm(), course.most = std::max(course.most, course.left);
    const Vec3 now = t.position(1), pushes = on_second(c, c.force);
    course.work += 0.5 * (push + pushes).dot(now - before);
    before = now, push = pushes;
  }
  return course;
}

constexpr double reach = 0.995 * (radius_a + radius_b);
Place still() { return {Vec3::Zero(), 0}; }

TEST(ClosedCycle, ThereAndBackLeavesNothing) {
  for (const char* law : {"linear-rolling", "linear-frictional", "hertz-mindlin"}) {
    const Course course = lead(
        [](std::uint32_t id, double share) {
          const double angle = 2e-4 * std::sin(2 * pi * share);
          return id == 0 ? still() : Place{reach * Vec3(std::cos(angle), std::sin(angle), 0), -3 * angle};
        },
        400, law);
    ASSERT_GT(course.most, 1e-3) << law;
    // Round-off of positions of 3 mm, relative to displacements of 1 µm.
    verify(std::string("shear force left there and back, over the largest, ") + law, course.left / course.most, 0,
           1e-12, 1);
  }
}

TEST(ClosedCycle, PressingShearingEasingShearingBackDoesNotRatchet) {
  const auto square = [](std::uint32_t id, double share) {
    const double way = 4 * (share - std::floor(share));
    const double press = std::clamp(way, 0.0, 1.0) - std::clamp(way - 2, 0.0, 1.0);
    const double shear = std::clamp(way - 1, 0.0, 1.0) - std::clamp(way - 3, 0.0, 1.0), angle = 2e-4 * shear;
    return id == 0 ? still() : Place{(reach - 3e-6 * press) * Vec3(std::cos(angle), std::sin(angle), 0), 0};
  };
  const Course once = lead(square, 400),
               ten = lead([&](std::uint32_t id, double s) { return square(id, 10 * s); }, 4000);
  ASSERT_GT(once.most, 1e-3);
  verify("shear force left by pressing, shearing, easing, shearing back, over the largest", once.left / once.most, 0,
         1e-9, 1);
  verify("the same ten times", ten.left / ten.most, 0, 2e-8, 1);  // ten times the round-off
}

TEST(ClosedCycle, DeepContactsThatAreShearedAsTheirOverlapChangesYieldNoEnergy) {
  // The overlap changes from 2.5 to 5.5 % of the sum of the radii and back, a quarter of a cycle before or after shear.
  constexpr double sheared = 5e-3;
  for (const char* law : {"linear-rolling", "linear-frictional"})
    for (const double sense : {-1.0, 1.0}) {
      const Course course = lead(
          [&](std::uint32_t id, double share) {
            const double angle = sheared * (1 - std::cos(2 * pi * share)),
                         distance = (radius_a + radius_b) * (0.96 + sense * 0.015 * std::sin(2 * pi * share));
            return id == 0 ? still() : Place{distance * Vec3(std::cos(angle), std::sin(angle), 0), 0};
          },
          400, law);
      const std::string of = std::string(law) + (sense < 0 ? ", deeper while sheared" : ", less deep while sheared");
      const double slip = 2 * sheared * (radius_a + radius_b),
                   spring = 0.3 * 2 * modulus * radius_a * radius_b / (radius_a + radius_b);
      verify("maximum shear force in a deep contact, " + of + " [N]", course.most, spring * slip / 0.96, 1e-3);
      // The forces move even heavy bodies a little.
      verify("shear force left by a cycle of a deep contact, " + of + ", over the largest", course.left / course.most,
             0, 1e-8, 1);
      verify("energy that a cycle of a deep contact yields, " + of + ", over that of its shear spring",
             course.work / (0.5 * spring * slip * slip), 0, 1e-5, 1);
    }
}

TEST(ClosedCycle, PairThatTurnsAsOneStoresNothing) {
  const Course course = lead(
      [](std::uint32_t id, double share) {
        const double angle = 2 * pi * share;
        return id == 0 ? Place{Vec3::Zero(), angle} : Place{reach * Vec3(std::cos(angle), std::sin(angle), 0), angle};
      },
      1000);
  // Relative to the force of a slip of one radius. The chord of a step is shorter than its arc by (2 π/1000)²/24.
  verify("shear force in a pair that turns as one, over that of a radius of slip",
         course.most / (modulus * radius_a * radius_a), 0, 1e-4, 1);
}

TEST(ClosedCycle, StoredForceTurnsWithThePairAndComesBack) {
  // Slight shear, one revolution about each other, shear back.
  const auto way = [](std::uint32_t id, double share) {
    const double turn = 2 * pi * std::clamp(2 * share - 0.5, 0.0, 1.0);
    const double shear = 2e-4 * (std::clamp(4 * share, 0.0, 1.0) - std::clamp(4 * share - 3, 0.0, 1.0));
    const double angle = turn + shear;
    return id == 0 ? Place{Vec3::Zero(), turn} : Place{reach * Vec3(std::cos(angle), std::sin(angle), 0), turn};
  };
  const Course whole = lead(way, 16000);
  const Course coarse = lead(way, 8000);
  ASSERT_GT(whole.most, 1e-3);
  // The chord of a step is shorter than its arc: in total 2 π · 3 mm · (2 π/8000)²/24, for 0.6 µm of shear.
  verify("shear force left after a turn of a sheared pair, over the largest", whole.left / whole.most, 0, 2e-3, 1);
  EXPECT_LT(whole.left, 0.3 * coarse.left) << "of second order in the step";
}

/// A ball, too heavy to move, on a floor that is moved along the sides of a polygon in x (shear) and z (compression);
/// it starts at the first overlap.
struct Floor {
  static constexpr double radius = 1e-3, overlap = 1e-6, dt = 1e-3;
  static constexpr int steps = 250;  // per side

  struct Corner {
    double force;                  ///< of the shear spring on the floor, along x [N]
    double lost, stored, elastic;  ///< by the energy balance since the start, in the shear spring, in both springs [J]
    double closure;                ///< error of the energy balance [J]
  };

  /// State at the end of each side.
  static std::vector<Corner> led(const std::string& law, const std::vector<Vec3>& sides) {
    Description d =
        description(law, {{"density", 1e30}, {"friction_angle", 1.3}}, {{{0, 0, radius - overlap}, radius}});
    d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
    d["time_step"]["value"] = dt;
    for (std::size_t i = 0; i < sides.size(); ++i)
      d["stages"].push_back(
          {{"name", "side" + std::to_string(i)},
           {"change", {{"walls", {{"floor", {{"motion", {{"velocity", vector(sides[i] / (steps * dt))}}}}}}}}},
           {"until", {{"type", "steps"}, {"value", steps}}},
           {"limit", 1}});
    Trial t(d, 1, BodyState::energy);
    t.world().energies();
    std::vector<Corner> corners;
    for (std::size_t i = 0; i < sides.size(); ++i) {
      t.begin_stage(i + 1, "side" + std::to_string(i));
      t.kernel().find_forces();
      t.step(steps);
      const Energies now = t.world().energies();
      corners.push_back({t.kernel().state().walls.states()[0].force.x(), now.friction, now.elastic_shear, now.elastic(),
                         now.closure_error});
    }
    return corners;
  }
};

const Vec3 sheared(2e-7, 0, 0), pressed(0, 0, 2e-6);
std::vector<Vec3> around(const Vec3& first, const Vec3& second, int cycles) {
  std::vector<Vec3> sides;
  for (int i = 0; i < cycles; ++i) sides.insert(sides.end(), {first, second, -first, -second});
  return sides;
}

constexpr int cycles = 6;

TEST(ClosedCycle, LinearSpringsForgetASquareInEitherOrder) {
  for (const std::string law : {"linear-rolling", "linear-frictional"})
    for (const bool press_first : {true, false}) {
      const auto corners =
          Floor::led(law, press_first ? around(pressed, sheared, cycles) : around(sheared, pressed, cycles));
      double most = 0, energy = 0;
      for (const Floor::Corner& c : corners)
        most = std::max(most, std::abs(c.force)), energy = std::max(energy, c.stored);
      ASSERT_GT(most, 0);
      verify("shear force left by six squares, " + law + (press_first ? ", pressed first" : ", sheared first") +
                 ", over the largest",
             corners.back().force / most, 0, 1e-12, 1);
      for (const Floor::Corner& c : corners) EXPECT_NEAR(c.lost, 0, 1e-9 * energy);
    }
}

// While the contact radius a grows, dF = K(a) du; while it shrinks, F is proportional to a. With r = a₁/a₂ = K₁/K₂, a
// square that is sheared first turns F into r (F + K₁ d − K₂ d), so that n of them leave −K₁ d (1 − rⁿ). A square that
// is compressed first turns F into r (F + K₂ d) − K₁ d = r F, which stays 0.
TEST(ClosedCycle, HertzAndMindlinsSpringsLeaveWhatTheirRuleSays) {
  const double poisson = 0.3, young = 70e9, way = sheared.x();
  const double shear_modulus = young / (2 * (1 + poisson)) / (2 * (2 - poisson));
  const auto spring = [&](double overlap) { return 8 * shear_modulus * std::sqrt(Floor::radius * overlap); };
  const double shallow = spring(Floor::overlap), deep = spring(Floor::overlap + pressed.z()), r = shallow / deep;

  const auto sheared_first = Floor::led("hertz-mindlin", around(sheared, pressed, cycles));
  const auto pressed_first = Floor::led("hertz-mindlin", around(pressed, sheared, cycles));
  Errors left("shear force left by one to six squares, hertz-mindlin, sheared first, error over its limit");
  Errors none("shear force left by one to six squares, hertz-mindlin, pressed first, over that limit");
  Errors lost("energy lost in each of these squares, error over that of the deep spring");
  const double whole = 0.5 * deep * way * way;
  double before[2] = {0, 0};
  for (int n = 1; n <= cycles; ++n) {
    const auto corner = static_cast<std::size_t>(4 * n - 1);
    // The floor moves along x against the friction of the ball.
    left.add(sheared_first[corner].force / (shallow * way) - (1 - std::pow(r, n)));
    none.add(pressed_first[corner].force / (shallow * way));
    // A spring with the force F loses (1 − r) of its energy in compression, and as much in unloading.
    const double held = std::pow(r, n - 1), back = 1 - std::pow(r, n);
    lost.add((sheared_first[corner].lost - before[0]) / whole - (1 - r) * (r * held * held + back * back));
    lost.add((pressed_first[corner].lost - before[1]) / whole - (1 - r));
    before[0] = sheared_first[corner].lost, before[1] = pressed_first[corner].lost;
  }
  left.verify(1e-12), none.verify(1e-12), lost.verify(1e-12);
}

TEST(ClosedCycle, NoOrderOfPressingAndShearingGainsEnergy) {
  for (const std::string law : {"linear-rolling", "linear-frictional", "hertz-mindlin"}) {
    double least = 1;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      Random random(seed);
      std::vector<Vec3> sides;
      Vec3 place = Vec3::Zero();
      for (int i = 0; i < 8; ++i) {
        const Vec3 next = i % 2 == 0 ? Vec3((2 * random.uniform() - 1) * sheared.x(), 0, place.z())
                                     : Vec3(place.x(), 0, random.uniform() * pressed.z());
        sides.push_back(next - place), place = next;
      }
      sides.push_back({-place.x(), 0, 0}), sides.push_back({0, 0, -place.z()});
      double before = 0, energy = 0, elastic = 0;
      const auto corners = Floor::led(law, sides);
      for (const Floor::Corner& c : corners)
        energy = std::max(energy, c.stored), elastic = std::max(elastic, c.elastic);
      for (const Floor::Corner& c : corners) {
        least = std::min(least, (c.lost - before) / energy), before = c.lost;
        EXPECT_NEAR(c.closure, 0, 1e-5 * elastic) << law << ' ' << seed;
      }
    }
    verify("least energy lost on a side of twenty closed ways, " + law + ", over the largest stored",
           std::min(least, 0.0), 0, 1e-9, 1);
  }
}

}  // namespace
}  // namespace grit::test::closed_cycle_tests
