// A servo-controlled wall on a stack of grains: the gain and the step at which oscillations start to grow, found from
// both sides; and its force on few or stiff grains that it approaches at any speed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <utility>

#include "grit/contact/restitution.hpp"
#include "grit/error.hpp"
#include "motion/walls.hpp"
#include "support/growth.hpp"
#include "support/mapped.hpp"

namespace grit::test::servo_tests {
namespace {

constexpr double radius = 1e-3, density = 2500, modulus = 1e8, stiffness = modulus * radius;
const double mass = density * 4 / 3 * std::numbers::pi * radius * radius * radius;
constexpr double squeeze = 1e-3;                          // of the radius
constexpr double habit_steps = 30, dashpots_counted = 3;  // as in core/src/motion/walls.cpp

/// A stack of grains between the floor and a lid that compresses them by `squeeze`.
Description stack(int grains, double gain, double restitution = 1) {
  const Description m{
      {"density", density}, {"contact_modulus", modulus}, {"friction_angle", 0}, {"restitution", restitution}};
  const double speed = 1e-9 * squeeze * radius * std::sqrt(2 * stiffness / mass);
  constexpr double pressed = squeeze * radius;
  std::vector<Grain> list;
  for (int i = 0; i < grains; ++i)
    list.push_back({Vec3(0, 0, radius - pressed + i * (2 * radius - pressed)), radius, {0, 0, i % 2 ? -speed : speed}});
  Description d = description("linear-frictional", m, list);
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  const double top = list.back().position.z() + radius - pressed;
  d["walls"]["lid"] = {{"type", "rectangle"},
                       {"corner", {-radius, radius, top}},
                       {"edge_a", {2 * radius, 0, 0}},
                       {"edge_b", {0, -2 * radius, 0}},
                       {"material", "grain"}};
  d["walls"]["lid"]["motion"]["servo"] = {{"axis", "z"},
                                          {"pressure", stiffness * squeeze * radius / (4 * radius * radius)},
                                          {"max_velocity", 1e3},
                                          {"gain", gain}};
  return d;
}

/// Spectral radius of one step of grains, wall and its mean velocity, with the same rules.
double spectral_radius(int grains, double gain, double dt, double restitution) {
  const int n = grains, size = 2 * n + 3;
  const double turn = dt * dt * stiffness / mass, ratio = damping_of_restitution(restitution),
               at_wall = 2 * ratio / std::sqrt(turn), between = at_wall / std::sqrt(2);  // c / (k dt)
  Eigen::MatrixXd step(size, size);
  for (int column = 0; column < size; ++column) {
    // Positions and dt · velocities of the grains; position, dt · mean velocity and dt · velocity of the wall.
    Eigen::VectorXd s = Eigen::VectorXd::Unit(size, column);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n + 2), u = x;
    x.segment(1, n) = s.head(n), x[n + 1] = s[2 * n];
    u.segment(1, n) = s.segment(n, n), u[n + 1] = s[2 * n + 2];
    Eigen::VectorXd pushes(n + 1);  // force over k of the contact below each grain, and of that with the lid
    for (int i = 0; i <= n; ++i)
      pushes[i] = x[i] - x[i + 1] + (i == 0 || i == n ? at_wall : between) * (u[i] - u[i + 1]);
    for (int i = 0; i < n; ++i) s[n + i] += turn * (pushes[i] - pushes[i + 1]);
    s.head(n) += s.segment(n, n);
    const double moved = s[2 * n + 1] + gain * pushes[n] / (1 + dashpots_counted * at_wall);
    s[2 * n + 1] += gain / habit_steps * (moved - s[2 * n + 1]);
    s[2 * n] += moved, s[2 * n + 2] = moved;
    step.col(column) = s;
  }
  return step.eigenvalues().cwiseAbs().maxCoeff();
}

/// The smallest unstable step [s]; small growth is round-off of an eigenvalue of 1.
double predicted_limit(int grains, double gain, double restitution = 1) {
  double low = 0, high = 2.5 * std::sqrt(mass / stiffness);
  for (int halving = 0; halving < 40; ++halving) {
    const double middle = 0.5 * (low + high);
    (spectral_radius(grains, gain, middle, restitution) > 1 + 1e-7 ? high : low) = middle;
  }
  return low;
}

TEST(Servo, OnAStackStartsToGrowWhereItsEigenvaluesSay) {
  const auto& map = "longest stable step of a servo over the critical one|gain of the servo";
  for (const int grains : {1, 3, 10}) {
    const std::string name = grains == 1 ? "lone grain" : "stack of " + std::to_string(grains);
    for (const double gain : {0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.7, 1.0}) {
      SCOPED_TRACE(name + ", gain " + std::to_string(gain));
      const double limit = predicted_limit(grains, gain), said = critical(stack(grains, gain));
      const double found = found_limit(stack(grains, gain), limit);
      EXPECT_NEAR(found / limit, 1, 1e-2);
      EXPECT_LT(growth(stack(grains, gain), 0.8 * said, 4000), 20) << "stable at the default step";
      map_point(map, name, gain, found / said);
      map_point(map, "predicted, " + name, gain, limit / said);
      if (grains == 1 && gain == 0.3) figure("stable step over the critical one, of a servo of gain 0.3", found / said);
      if (grains == 1 && gain == 1) figure("stable step over the critical one, of a servo of gain 1", found / said);
    }
  }
}

TEST(Servo, OnDashpotsStartsToGrowWhereItsEigenvaluesSay) {
  const auto& map = "longest stable step of a servo on dashpots over the critical one|restitution";
  double least = 1;
  for (const int grains : {1, 3})
    for (const double gain : {0.3, 1.0}) {
      const std::string name =
          (grains == 1 ? "lone grain" : "stack of 3") + std::string(", gain ") + (gain < 1 ? "0.3" : "1");
      for (const double restitution : {0.95, 0.8, 0.6, 0.4, 0.2, 0.05}) {
        SCOPED_TRACE(name + ", restitution " + std::to_string(restitution));
        const Description d = stack(grains, gain, restitution);
        const double limit = predicted_limit(grains, gain, restitution), said = critical(d);
        const double found = found_limit(d, limit);
        EXPECT_NEAR(found / limit, 1, 1e-2);
        least = std::min(least, found / said);
        map_point(map, name, restitution, found / said);
        map_point(map, "predicted, " + name, restitution, limit / said);
      }
    }
  EXPECT_GT(least, 0.8) << "stable at the default step";
  figure("stable step over the critical one, of a servo on dashpots", least);
}

TEST(Servo, KeepsItsForceOnDashpotsAtAnyStep) {
  for (const double restitution : {0.9, 0.5, 0.1})
    for (const double gain : {0.3, 1.0})
      for (const double safety : {0.8, 0.2, 0.05}) {
        SCOPED_TRACE(testing::Message() << "restitution " << restitution << ", gain " << gain << ", safety " << safety);
        Description d = stack(3, gain, restitution);
        d["walls"]["lid"]["motion"]["servo"]["pressure"] =
            1.1 * d["walls"]["lid"]["motion"]["servo"]["pressure"].get<double>();
        d["time_step"] = {{"safety", safety}};
        Trial t(d);
        t.step(static_cast<std::size_t>(12000 / safety));
        const double wanted = d["walls"]["lid"]["motion"]["servo"]["pressure"].get<double>();
        double worst = 0;
        for (int step = 0; step < 100; ++step) {
          t.step(1);
          worst = std::max(worst, std::abs(t.world().walls()[1].pressure / wanted - 1));
        }
        EXPECT_LT(worst, 1e-6);
      }
}

/// A wall of one square metre.
struct Plate : Geometry {
  void declare(Parameters&) override {}
  Bounds bounds() const override { return {Vec3::Zero(), Vec3(1, 1, 0)}; }
  double area() const override { return 1; }
  Vec3 normal() const override { return -Vec3::UnitZ(); }
  void find_contacts(const Pose&, std::span<const Sphere>, std::vector<SurfaceContact>&) const override {}
  bool near(const Pose&, const Vec3&, double) const override { return false; }
  std::vector<Vec3> triangles() const override { return {}; }
};

/// Fraction of the force error left after a number of steps, on a massless spring.
double left(double gain, int steps) {
  constexpr double spring = 1e4, pressure = 100, dt = 1e-3;
  Walls walls;
  MotionDescription motion;
  motion.servo = ServoDescription{.axis = "z", .pressure = pressure, .max_velocity = 1e9, .gain = gain};
  walls.apply({{"lid", std::make_shared<Plate>(), motion}});
  double error = 1e-6, most = 0;
  for (int i = 0; i < steps; ++i) {
    walls.clear_forces();
    walls.add(0, {Vec3(0, 0, pressure * (1 + error)), Vec3::Zero(), spring, 1});
    const double before = walls.pose(0).shift.z();
    walls.drive(dt), walls.move(dt);
    error -= spring * (walls.pose(0).shift.z() - before) / pressure;
    if (i > steps - 10) most = std::max(most, std::abs(error));
  }
  return most / 1e-6;
}

TEST(Servo, OnAHeavySpecimenStartsToGrowJustAboveTwiceTheErrorAStep) {
  // e' = (1 − g) e + H, H' = H − g²/30 e: an eigenvalue of −1 where 4 − 2 g + g²/30 = 0.
  const double limit = habit_steps * (1 - std::sqrt(1 - 4 / habit_steps));
  EXPECT_LT(left(0.995 * limit, 4000), 1e-3);
  EXPECT_GT(left(1.005 * limit, 4000), 1e3);
  figure("gain that a servo on a heavy specimen may have", limit);
  constexpr double most = 1;
  EXPECT_NO_THROW(Trial{stack(1, most)});
  EXPECT_THROW(Trial{stack(1, 1.0001 * most)}, Error) << "half of that is the maximum allowed";
  figure("gain of a servo that is taken", most);
}

TEST(Servo, GuardTripsWhereAnUnstableStepWasAskedFor) {
  Description d = stack(1, 1);
  d["time_step"] = {{"value", 0.98 * critical(d)}, {"allow_unstable", true}};
  ASSERT_GT(d["time_step"]["value"].get<double>(), predicted_limit(1, 1));
  Trial t(d);
  EXPECT_THROW(t.step(100000), NumericsError);
}

// Force of an approaching lid over its target. Displacements per step are relative to the overlap of one grain under
// the target force: with linear springs max_velocity · dt · k / F.
const std::string closing_map =
    "peak of the force of a servo that closes, over the one that it keeps|"
    "way in a step at max_velocity over the overlap under that force";
constexpr double overlap_kept = 1e-4 * radius, force_kept = stiffness * overlap_kept;
/// Fraction of the lid's last displacement before first contact.
constexpr auto starts = {0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.99};

/// On massless springs of equal height.
double peak_on_springs(int springs, double way, double start, bool brakes) {
  constexpr double dt = 1e-3;
  Walls walls;
  MotionDescription motion;
  motion.servo =
      ServoDescription{.axis = "z", .force = -force_kept, .max_velocity = way * overlap_kept / dt, .gain = 0.3};
  walls.apply({{"lid", std::make_shared<Plate>(), motion}});
  const double gap = (1 + start) * way * overlap_kept;
  const auto force = [&](const Pose& there) { return springs * stiffness * std::max(0.0, -there.shift.z() - gap); };
  const Walls::Ahead ahead = [&](std::size_t, const Pose& there, const Vec3&, double) { return force(there); };
  double peak = 0;
  for (int step = 0; step < 1000; ++step) {
    const double now = force(walls.pose(0));
    peak = std::max(peak, now / force_kept);
    walls.clear_forces();
    if (now > 0) walls.add(0, {Vec3(0, 0, now), Vec3::Zero(), springs * stiffness, std::uint32_t(springs)});
    walls.drive(dt, brakes ? ahead : nullptr), walls.move(dt);
  }
  if (brakes) EXPECT_NEAR(force(walls.pose(0)) / force_kept, 1, 1e-2);
  return peak;
}

TEST(Servo, WouldBearAWholeStepsWayIfItDidNotBrake) {
  for (const int springs : {1, 16}) {
    const std::string name = (springs == 1 ? "a spring" : "16 springs") + std::string(", if it did not brake");
    for (const double way : {0.03, 0.1, 0.3, 0.99, 1.01, 3.0, 10.0, 30.0, 100.0, 300.0}) {
      SCOPED_TRACE(testing::Message() << springs << " springs, " << way);
      double found = 0;
      for (const double start : starts) {
        found = std::max(found, peak_on_springs(springs, way, start, false));
        EXPECT_LT(peak_on_springs(springs, way, start, true), 1.05);
      }
      const double predicted = std::max(1.0, springs * way);
      EXPECT_NEAR(found / predicted, 1, 0.03);
      map_point(closing_map, name, way, found);
      map_point(closing_map, "predicted, " + name, way, predicted);
    }
  }
}

/// Rows of grains on the floor, and an approaching lid.
struct Layer {
  std::string law = "linear-frictional";
  int a_side = 1;
  double uneven = 0;            ///< height difference over the overlap of one grain under the target force
  bool one_stands_out = false;  ///< one grain is the highest; all others are the lowest
  double restitution = 1;
  double gain = 0.3;
};
/// `way`: displacement per step over the overlap under the target force.
Description closing(const Layer& layer, double way, double start) {
  const double reach = way * overlap_kept, dt = 0.5 * std::sqrt(mass / stiffness);
  Description m{{"density", density}, {"friction_angle", 0}, {"restitution", layer.restitution}};
  // Hertzian contact of two equal bodies with the same overlap under the target force.
  if (layer.law == "hertz-mindlin")
    m["young_modulus"] = 1.5 * force_kept / std::sqrt(radius * std::pow(overlap_kept, 3)), m["poisson_ratio"] = 0;
  else m["contact_modulus"] = modulus;
  std::vector<Grain> grains;
  const int count = layer.a_side * layer.a_side;
  for (int i = 0; i < count; ++i) {
    const double low = layer.one_stands_out ? i > 0 : double(i) / std::max(1, count - 1);
    const double r = radius - 0.5 * layer.uneven * overlap_kept * low;
    grains.push_back({2.5 * radius * Vec3(i % layer.a_side, i / layer.a_side, 0) + r * Vec3::UnitZ(), r});
  }
  Description d = description(layer.law, m, grains);
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  const double side = 2.5 * radius * (layer.a_side - 1) + 2 * radius;
  d["walls"]["lid"] = {{"type", "rectangle"},
                       {"corner", {-radius, side - radius, 2 * radius + (2 + start) * reach}},
                       {"edge_a", {side, 0, 0}},
                       {"edge_b", {0, -side, 0}},
                       {"material", "grain"}};
  d["walls"]["lid"]["motion"]["servo"] = {
      {"axis", "z"}, {"force", -force_kept}, {"max_velocity", reach / dt}, {"gain", layer.gain}};
  d["time_step"] = {{"value", dt}, {"allow_unstable", true}};  // for Hertz, the critical step depends on the overlap
  return d;
}
/// Maximum force on the lid over the target.
double peak_on(const Description& d, int steps = 600) {
  Trial t(d);
  double peak = 0;
  for (int step = 0; step < steps; ++step) {
    t.step();
    peak = std::max(peak, t.world().walls()[1].force.z() / force_kept);
  }
  return peak;
}

TEST(Servo, BrakesBeforeGrainsThatItClosesOn) {
  const std::pair<const char*, Layer> layers[] = {
      {"a grain", {}},
      {"a grain, gain 1", {.gain = 1}},
      {"a grain, Hertz", {.law = "hertz-mindlin"}},
      {"a grain, restitution 0.3", {.restitution = 0.3}},
      {"16 grains", {.a_side = 4}},
      {"16 grains, uneven", {.a_side = 4, .uneven = 1}},
      {"25 grains, one stands out", {.a_side = 5, .uneven = 0.5, .one_stands_out = true}},
  };
  double largest = 0;
  for (const auto& [name, layer] : layers)
    for (const double way : {0.03, 0.1, 0.3, 0.99, 1.01, 3.0, 10.0, 30.0, 100.0, 300.0}) {
      SCOPED_TRACE(testing::Message() << name << ", " << way);
      double found = 0;
      for (const double start : starts) {
        const double peak = peak_on(closing(layer, way, start));
        EXPECT_GT(peak, 0.9) << "it reaches the grains";
        found = std::max(found, peak);
      }
      EXPECT_LT(found, 1.6);
      map_point(closing_map, name, way, found);
      largest = std::max(largest, found);
    }
  figure("peak of the force of a servo that closes, over the one that it keeps", largest);
}

TEST(Servo, ClosesAsFastAsItMayWhereNothingWouldBearTooMuch) {
  const Layer layer{.a_side = 4};
  for (const double way : {0.9 / 16, 1.8 / 16}) {
    Trial t(closing(layer, way, 0.1));
    const double fastest = t.scene().description->walls.at("lid").motion.servo->max_velocity;
    bool braked = false;
    while (t.world().walls()[1].contacts == 0) {
      t.step();
      braked = braked || t.world().walls()[1].velocity.z() != -fastest;
    }
    EXPECT_EQ(braked, way > 1.0 / 16);
  }
}

TEST(Servo, BrakesBeforeDampedGrainsByHowFastItNearsThem) {
  for (const double share : {0.0, 0.9}) {  // speed of the grains over that of the lid
    Description d = closing({.a_side = 4, .restitution = 0.3}, 0.05, 0.1);
    const double fastest = d["walls"]["lid"]["motion"]["servo"]["max_velocity"];
    for (Description& grain : d["bodies"]["grains"]["source"]["bodies"])
      grain["velocity"] = vector({0, 0, -share * fastest});
    d["walls"].erase("floor");
    Trial t(d);
    bool braked = false;
    for (int step = 0; step < 100 && t.world().walls()[0].contacts == 0; ++step) {
      t.step();
      braked = braked || t.world().walls()[0].velocity.z() != -fastest;
    }
    EXPECT_GT(t.world().walls()[0].contacts, 0);
    EXPECT_EQ(braked, share == 0) << "of the speed: " << share;
  }
}

// If a lid slows down in every other step, dashpots, which use velocities half a step old, dissipate more than its
// work.
TEST(Servo, DrivesACloudOfDampedGrainsBeforeItSteadily) {
  Description d = description("linear-frictional", {{"restitution", 0.4}, {"contact_modulus", 2e7}}, {});
  d["bodies"]["grains"]["source"] = {
      {"type", "cloud"}, {"low", {0, 0, 0}}, {"high", {0.012, 0.008, 0.024}}, {"count", 300}};
  d["bodies"]["grains"]["source"]["sizes"] = {{"type", "uniform"}, {"smallest", 1.2e-3}, {"largest", 2e-3}};
  d["domain"] = {{"low", {0, 0, -5e-3}}, {"high", {0.012, 0.008, 0.035}}, {"periodic", {true, true, false}}};
  d["walls"]["lid"] = {{"type", "rectangle"},
                       {"corner", {0, 8e-3, 0.025}},
                       {"edge_a", {0.012, 0, 0}},
                       {"edge_b", {0, -8e-3, 0}},
                       {"material", "grain"}};
  d["walls"]["lid"]["motion"]["servo"] = {{"pressure", 5e3}, {"max_velocity", 0.5}};
  Trial t(d, 1, BodyState::energy);
  t.world().energies();
  double jumps = 0, before = 0;
  constexpr int steps = 3000;
  for (int step = 0; step < steps; ++step) {
    t.step();
    const double now = t.world().walls()[0].velocity.z();
    jumps += std::abs(now - std::exchange(before, now)) / 0.5;
  }
  const Energies now = t.world().energies();
  EXPECT_LT(jumps / steps, 0.02) << "change per step over max_velocity";
  EXPECT_NEAR(now.closure_error / now.walls, 0, 0.02);
}

TEST(Servo, GuardStopsALidThatGoesTooFarInAStep) {
  const double travel = 0.05 * radius / overlap_kept;
  for (const double start : {0.0, 0.5, 0.9}) {
    EXPECT_LT(peak_on(closing({}, 0.99 * travel, start)), 1.3);
    // It may also brake before it is near enough for the guard.
    try {
      EXPECT_LT(peak_on(closing({}, 1.01 * travel, start)), 1.3);
      EXPECT_GT(start, 0);
    } catch (const NumericsError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("wall \"lid\" moves 0.0505 of a radius towards a body in one step"));
      EXPECT_THAT(error.what(), testing::HasSubstr("reduce its velocity"));
    }
    // If the displacement may exceed the skin, it searches neighbours.
    Description far = closing({}, 10 * travel, start);
    far["guards"]["travel"] = 1;
    EXPECT_LT(peak_on(far), 1.3);
  }
}

TEST(Servo, BrakesTheSameOnAnyNumberOfThreads) {
  const Description d = closing({.a_side = 20, .uneven = 30}, 100, 0.3);
  Trial one(d), two(d, 2);
  for (int times = 0; times < 30; ++times) {
    one.step(10), two.step_on(10);
    const WallView &a = one.world().walls()[1], &b = two.world().walls()[1];
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.force, b.force);
  }
  EXPECT_GT(one.world().walls()[1].contacts, 1);
}

}  // namespace
}  // namespace grit::test::servo_tests
