// Closed ways of two spheres leave no shear force behind: there and back, around a square, around each other.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "grit/plugin.hpp"
#include "support/scene.hpp"
#include "support/verified.hpp"

namespace grit::test {
namespace {

using std::numbers::pi;

struct Place {
  Vec3 position;
  double angle = 0;  ///< turned about z
};
/// Where body `id` is to be at a share 0 … 1 of the way.
using Way = std::function<Place(std::uint32_t id, double share)>;

/// Leads bodies along a way: each is so heavy that nothing else moves it. Forces give it the velocity of the coming
/// step.
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
  double most = 0, left = 0, radial = 0;  ///< shear force: the largest, and what is left [N]; of the last force [N]
  Vec3 force = Vec3::Zero();              ///< the last shear force on the second body
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
  Course course;
  for (int i = 0; i < steps; ++i) {
    t.step();
    const auto contacts = t.world().contacts();
    if (contacts.empty()) return course;
    const Contact& c = contacts.front();
    const double sign = t.world().ids()[c.a] == 0 ? 1 : -1;
    course.force = sign * (c.force - c.normal_force * c.normal);
    course.left = course.force.norm(), course.most = std::max(course.most, course.left);
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
    // Round-off of places of 3 mm against ways of 1 µm.
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

TEST(ClosedCycle, PairThatTurnsAsOneStoresNothing) {
  const Course course = lead(
      [](std::uint32_t id, double share) {
        const double angle = 2 * pi * share;
        return id == 0 ? Place{Vec3::Zero(), angle} : Place{reach * Vec3(std::cos(angle), std::sin(angle), 0), angle};
      },
      1000);
  // Against the spring of one radius of slip. The chord of a step is shorter than its arc by (2 π/1000)²/24.
  verify("shear force in a pair that turns as one, over that of a radius of slip",
         course.most / (modulus * radius_a * radius_a), 0, 1e-4, 1);
}

TEST(ClosedCycle, StoredForceTurnsWithThePairAndComesBack) {
  // Sheared a little, then around each other once, then sheared back.
  const auto way = [](std::uint32_t id, double share) {
    const double turn = 2 * pi * std::clamp(2 * share - 0.5, 0.0, 1.0);
    const double shear = 2e-4 * (std::clamp(4 * share, 0.0, 1.0) - std::clamp(4 * share - 3, 0.0, 1.0));
    const double angle = turn + shear;
    return id == 0 ? Place{Vec3::Zero(), turn} : Place{reach * Vec3(std::cos(angle), std::sin(angle), 0), turn};
  };
  const Course whole = lead(way, 16000);
  const Course coarse = lead(way, 8000);
  ASSERT_GT(whole.most, 1e-3);
  // The chord of a step is shorter than its arc: in all 2 π · 3 mm · (2 π/8000)²/24, beside 0.6 µm of shear.
  verify("shear force left after a turn of a sheared pair, over the largest", whole.left / whole.most, 0, 2e-3, 1);
  EXPECT_LT(whole.left, 0.3 * coarse.left) << "of second order in the step";
}

}  // namespace
}  // namespace grit::test
