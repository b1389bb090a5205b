#include "motion/walls.hpp"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "grit/error.hpp"

namespace grit {
namespace {

/// A wall of which only area, normal and bounds matter.
struct Plate : Geometry {
  double surface = 2;
  Vec3 towards = -Vec3::UnitZ();
  Bounds box{Vec3(0, 0, 1), Vec3(4, 2, 1)};

  void declare(Parameters&) override {}
  Bounds bounds() const override { return box; }
  double area() const override { return surface; }
  Vec3 normal() const override { return towards; }
  void find_contacts(const Pose&, std::span<const Sphere>, std::vector<SurfaceContact>&) const override {}
  bool near(const Pose&, const Vec3&, double) const override { return false; }
  std::vector<Vec3> triangles() const override { return {}; }
};

WallSetup plate(const MotionDescription& motion, std::string name = "lid") {
  return {std::move(name), std::make_shared<Plate>(), motion};
}
void step(Walls& walls, double dt) {
  walls.drive(dt);
  walls.move(dt);
}
WallView view(const Walls& walls, std::size_t wall = 0) {
  std::vector<WallView> views;
  walls.view(views);
  return views.at(wall);
}
std::string complaint(std::vector<WallSetup> setups) {
  try {
    Walls().apply(std::move(setups));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Walls, FixedWallsStay) {
  Walls walls;
  walls.apply({plate({})});
  walls.add(0, {{1, 2, 3}, {4, 5, 6}, 7, 8});
  for (int i = 0; i < 10; ++i) step(walls, 0.1);
  EXPECT_EQ(walls.pose(0).shift, Vec3::Zero());
  EXPECT_FALSE(walls.pose(0).turned());
}

TEST(Walls, RampedVelocityCoversHalfTheDistanceDuringTheRamp) {
  Walls walls;
  walls.apply({plate({.velocity = {2, 0, -1}, .ramp_time = 0.5})});
  const double dt = 0.5 / 64;
  for (int i = 0; i < 64; ++i) {
    EXPECT_NEAR(walls.pose(0).shift.x(), std::pow(i * dt, 2) * 2, 1e-15) << "x = V t² / (2 T)";
    step(walls, dt);
    EXPECT_NEAR(view(walls).velocity.x(), 2 * (i + 0.5) / 64, 1e-15) << "at the middle of the step";
  }
  for (int i = 0; i < 64; ++i) step(walls, dt);
  EXPECT_NEAR(walls.pose(0).shift.x(), 0.5 + 1, 1e-14);
  EXPECT_NEAR(walls.pose(0).shift.z(), -0.25 - 0.5, 1e-14);
}

TEST(Walls, FreeMassFallsAsInLeapFrog) {
  const double dt = 1e-3, mass = 4, weight = 9.81 * mass;
  Walls walls;
  walls.apply(
      {plate({.velocity = {1, 0, 0}, .free = FreeDescription{.axes = "z", .mass = mass, .load = {7, 7, -weight}}})});
  const int steps = 500;
  for (int n = 0; n < steps; ++n) step(walls, dt);
  const double t = steps * dt;
  EXPECT_NEAR(walls.pose(0).shift.z(), -0.5 * 9.81 * dt * dt * steps * (steps + 1), 1e-12) << "g dt² (1 + 2 + … + n)";
  EXPECT_NEAR(walls.pose(0).shift.z(), -0.5 * 9.81 * t * t, 9.81 * t * dt);
  EXPECT_NEAR(walls.pose(0).shift.x(), t, 1e-12) << "other axes keep their velocity";
  EXPECT_EQ(walls.pose(0).shift.y(), 0);
}

TEST(Walls, FreeMassOnASpringOscillatesAtTheLeapFrogFrequency) {
  const double dt = 0.1, mass = 2, stiffness = 8, omega = std::sqrt(stiffness / mass);
  Walls walls;
  walls.apply({plate({.free = FreeDescription{.axes = "z", .mass = mass, .load = {0, 0, 1}}})});
  const double phase =
      2 * std::asin(0.5 * omega * dt);  // per step, exactly: z(n+1) − 2 z(n) + z(n−1) = −(ω dt)² (z(n) − z0)
  const double rest = 1 / stiffness;
  for (int n = 0; n < 200; ++n) {
    // z(0) = z(−1) = 0, as the velocity half a step before the start is 0
    EXPECT_NEAR(walls.pose(0).shift.z(), rest * (1 - std::cos((n + 0.5) * phase) / std::cos(0.5 * phase)), 1e-12);
    walls.clear_forces();
    walls.add(0, {{0, 0, -stiffness * walls.pose(0).shift.z()}, Vec3::Zero(), stiffness, 1});
    step(walls, dt);
  }
}

TEST(Walls, PointComesBackAfterAFullTurn) {
  const Vec3 about(1, -2, 0.5), point(3, 1, 2), spin = Vec3(1, 2, -2);  // 3 rad/s
  Walls walls;
  walls.apply({plate({.velocity = {0.1, 0, 0}, .spin = spin, .about = about})});
  const int steps = 1000;
  const double time = 2 * std::numbers::pi / 3, dt = time / steps;
  for (int n = 0; n < steps / 4; ++n) step(walls, dt);
  const Mat3 quarter = Eigen::AngleAxisd(0.5 * std::numbers::pi, spin / 3).toRotationMatrix();
  const Vec3 moved = about + quarter * (point - about) + Vec3(0.1 * time / 4, 0, 0);
  EXPECT_LT((walls.pose(0).to_world(point) - moved).norm(), 1e-12);
  EXPECT_LT((walls.point_velocity(0, moved) - (Vec3(0.1, 0, 0) + spin.cross(quarter * (point - about)))).norm(), 1e-11);
  EXPECT_LT((view(walls).pose.to_world(point) - moved).norm(), 1e-11) << "as in frames and pictures";
  for (int n = steps / 4; n < steps; ++n) step(walls, dt);
  EXPECT_LT((walls.pose(0).to_world(point) - point - Vec3(0.1 * time, 0, 0)).norm(), 1e-12);
}

TEST(Walls, TurnStaysARotation) {
  Walls walls;
  walls.apply({plate({.spin = {0.3, -1, 2}})});
  for (int n = 0; n < 100000; ++n) step(walls, 0.01);
  const Mat3& turn = walls.pose(0).turn;
  EXPECT_LT((turn * turn.transpose() - Mat3::Identity()).norm(), 3e-15);
  EXPECT_NEAR(turn.determinant(), 1, 3e-15);
}

/// Displacement of an oscillation without a ramp.
double sine(const OscillationDescription& how, double time) {
  return std::sin(2 * std::numbers::pi * how.frequency * time + how.phase) - std::sin(how.phase);
}

TEST(Walls, OscillatesAlongItsSineForAnyStep) {
  const Vec3 steady(0.3, 0, -0.1);
  for (const double phase : {0.0, 0.5 * std::numbers::pi, -2.5}) {
    const OscillationDescription how{.amplitude = {2e-3, 0, -1e-3}, .frequency = 40, .phase = phase};
    Walls walls;
    walls.apply({plate({.velocity = steady, .oscillation = how})});
    const double period = 1 / how.frequency, omega = 2 * std::numbers::pi * how.frequency;
    double time = 0;
    for (int n = 0; n < 3000; ++n) {
      const double dt = period / (n % 2 == 0 ? 750 : 375);  // pairs of 0.004 periods
      step(walls, dt);
      const double middle = time + 0.5 * dt, slow = std::sin(0.5 * omega * dt) / (0.5 * omega * dt);
      time += dt;
      const Vec3 way = time * steady + sine(how, time) * how.amplitude;
      EXPECT_LT((walls.pose(0).shift - way).norm(), 1e-15 + 1e-14 * time) << n;
      const Vec3 velocity = steady + slow * omega * std::cos(omega * middle + phase) * how.amplitude;
      EXPECT_LT((view(walls).velocity - velocity).norm(), 1e-10) << "the mean over the step";
      EXPECT_LT(std::abs(slow - 1), 1.2e-5);
    }
    EXPECT_NEAR(time, 6 * period, 1e-14);
    EXPECT_LT((walls.pose(0).shift - time * steady).norm(), 3e-15) << "back after whole periods";
    EXPECT_FALSE(walls.pose(0).turned());
  }
}

TEST(Walls, OscillatesInRotationAlongItsSine) {
  const Vec3 about(1, -2, 0.5), axis = Vec3(1, 2, -2) / 3, point(3, 1, 2);
  for (const double steady : {0.0, 4.0}) {
    const double swept = 0.7;
    const OscillationDescription how{.angle = swept * axis, .frequency = 5, .phase = 1};
    Walls walls;
    walls.apply({plate({.spin = steady * axis, .about = about, .oscillation = how})});
    const int steps = 400;
    const double dt = 1 / how.frequency / steps, omega = 2 * std::numbers::pi * how.frequency;
    for (int n = 1; n <= 3 * steps; ++n) {
      step(walls, dt);
      const double time = n * dt, angle = steady * time + swept * sine(how, time);
      const Vec3 place = about + Eigen::AngleAxisd(angle, axis) * (point - about);
      EXPECT_LT((walls.pose(0).to_world(point) - place).norm(), 1e-12) << n;
      const double spin = steady + swept * omega * std::cos(omega * (time - 0.5 * dt) + how.phase);
      EXPECT_LT((view(walls).spin - spin * axis).norm(), 1.1e-5 * omega) << "(ω dt)²/24 = 1.03e-5";
    }
    const double turned = steady * 3 / how.frequency;
    EXPECT_LT((walls.pose(0).turn - Eigen::AngleAxisd(turned, axis).toRotationMatrix()).norm(), 1e-12);
    EXPECT_EQ(walls.pose(0).shift, Vec3::Zero());
  }
}

TEST(Walls, PhasesByAxisMoveItOnACircle) {
  const double radius = 2e-3;
  const OscillationDescription how{.amplitude = {radius, 0, radius},
                                   .frequency = 40,
                                   .phase = 0.3,
                                   .amplitude_phase = {0, 0, 0.5 * std::numbers::pi}};
  Walls walls;
  walls.apply({plate({.oscillation = how})});
  const double omega = 2 * std::numbers::pi * how.frequency, dt = 1e-4;
  const Vec3 centre = -radius * Vec3(std::sin(how.phase), 0, std::cos(how.phase));
  for (int n = 1; n <= 1000; ++n) {
    step(walls, dt);
    const double angle = omega * n * dt + how.phase;
    const Vec3 place = centre + radius * Vec3(std::sin(angle), 0, std::cos(angle));
    EXPECT_LT((walls.pose(0).shift - place).norm(), 1e-15) << n;
  }
  EXPECT_FALSE(walls.pose(0).turned());
}

TEST(Walls, PhasesOfRotationAreAddedToThatOfTheDisplacement) {
  const OscillationDescription how{
      .amplitude = {1e-3, 0, 0}, .angle = {0, 0.2, 0}, .frequency = 10, .phase = 0.3, .angle_phase = {9, 1.1, 9}};
  Walls walls;
  walls.apply({plate({.oscillation = how})});
  OscillationDescription alone = how;
  alone.phase = 1.4;
  for (int n = 1; n <= 300; ++n) {
    step(walls, 1e-3);
    EXPECT_NEAR(walls.pose(0).shift.x(), 1e-3 * sine(how, n * 1e-3), 1e-15);
    const double angle = 0.2 * sine(alone, n * 1e-3);
    EXPECT_LT((walls.pose(0).turn - Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix()).norm(), 1e-13) << n;
  }
}

TEST(Walls, OscillationGrowsWithTheRampFromRest) {
  const OscillationDescription how{.amplitude = {0, 1, 0}, .frequency = 10, .phase = 2};
  Walls walls;
  walls.apply({plate({.ramp_time = 0.5, .oscillation = how})});
  const double dt = 1e-3;
  step(walls, dt);
  const double omega = 2 * std::numbers::pi * how.frequency;
  EXPECT_LT(std::abs(view(walls).velocity.y()), dt / 0.5 * omega) << "a fraction of its full speed";
  for (int n = 2; n <= 800; ++n) {
    step(walls, dt);
    EXPECT_NEAR(walls.pose(0).shift.y(), std::min(1.0, n * dt / 0.5) * sine(how, n * dt), 1e-13) << n;
  }
}

TEST(Walls, OscillationContinuesAcrossStagesAndChanges) {
  OscillationDescription how{.amplitude = {0, 0, 2}, .frequency = 3, .phase = 0.4};
  const double dt = 1e-2;
  Walls walls;
  const auto set = [&] { return std::vector{plate({.oscillation = how})}; };
  walls.apply(set());
  const auto go = [&](int steps) {
    for (int n = 0; n < steps; ++n) step(walls, dt);
    return walls.pose(0).shift.z();
  };
  go(7);
  walls.apply(set());
  EXPECT_NEAR(go(11), 2 * sine(how, 18 * dt), 1e-14) << "a stage that does not change it";
  EXPECT_NEAR(view(walls).stage_position.z(), 2 * (sine(how, 18 * dt) - sine(how, 7 * dt)), 1e-14);

  const double before = walls.pose(0).shift.z(), angle = 2 * std::numbers::pi * 3 * 18 * dt + how.phase;
  how.frequency = 5, how.amplitude = {0, 0, 1};
  walls.change(set());
  EXPECT_EQ(walls.pose(0).shift.z(), before) << "no jump";
  go(4);
  EXPECT_NEAR(walls.pose(0).shift.z() - before, std::sin(angle + 2 * std::numbers::pi * 5 * 4 * dt) - std::sin(angle),
              1e-14)
      << "the phase continues, too";

  const double later = walls.pose(0).shift.z();
  how.phase = -1;
  walls.apply(set());
  EXPECT_NEAR(go(9) - later, sine(how, 9 * dt), 1e-14) << "another phase: it starts again";
  const double shifted = walls.pose(0).shift.z();
  how.amplitude_phase.z() = 1.5;
  walls.apply(set());
  OscillationDescription together = how;
  together.phase = 0.5;
  EXPECT_NEAR(go(9) - shifted, sine(together, 9 * dt), 1e-14) << "also for a phase of one axis";
  how.amplitude_phase.setZero();

  const double last = walls.pose(0).shift.z();
  walls.apply({plate({})});
  EXPECT_EQ(go(5), last) << "it stops at its position";
  walls.apply(set());
  EXPECT_NEAR(go(6) - last, sine(how, 6 * dt), 1e-14) << "and starts again";
}

TEST(Walls, SurfaceMovesWithoutTheWall) {
  Walls walls;
  walls.apply({plate({.spin = {0, 0, 0.5 * std::numbers::pi},
                      .surface_velocity = {2, 0, 0},
                      .surface_spin = {0, 3, 0},
                      .ramp_time = 1}),
               plate({}, "side")});
  EXPECT_TRUE(walls.surface_moves(0));
  EXPECT_FALSE(walls.surface_moves(1));
  const double dt = 1.0 / 64;
  for (int n = 0; n < 96; ++n) {
    const Mat3 turn = walls.pose(0).turn;
    step(walls, dt);
    const double ramp = std::min(1.0, (n + 0.5) * dt);
    EXPECT_LT((walls.states()[0].surface_velocity - 2 * ramp * turn * Vec3::UnitX()).norm(), 1e-14) << "of the wall";
    EXPECT_LT((walls.states()[0].surface_spin - 3 * ramp * turn * Vec3::UnitY()).norm(), 1e-14);
  }
  EXPECT_EQ(walls.pose(0).shift, Vec3::Zero());
  EXPECT_EQ(walls.motion(0).velocity, Vec3::Zero());
  EXPECT_NEAR(walls.states()[0].surface_velocity.x(), 0, 0.05) << "after a quarter turn";
  EXPECT_NEAR(walls.states()[0].surface_velocity.y(), 2, 0.05);
  walls.apply({plate({}), plate({}, "side")});
  EXPECT_TRUE(walls.surface_moves(0)) << "it did in the last step";
  step(walls, dt);
  EXPECT_FALSE(walls.surface_moves(0));
  EXPECT_EQ(walls.states()[0].surface_velocity, Vec3::Zero());
}

TEST(Walls, FreeRotationSpeedsUpWithItsMoment) {
  const Vec3 axis(1, 2, -2), about(1, 0, 0.5);
  const double inertia = 4, moment = -0.6, dt = 1e-3;
  Walls walls;
  walls.apply({plate({.velocity = {0, 0.1, 0},
                      .about = about,
                      .free_rotation = FreeRotationDescription{.axis = axis, .inertia = inertia, .moment = moment}})});
  const int steps = 1000;
  for (int n = 1; n <= steps; ++n) {
    step(walls, dt);
    EXPECT_LT((view(walls).spin - moment * n * dt / inertia * axis / 3).norm(), 1e-14) << "M t / I";
  }
  const double angle = moment / inertia * dt * dt * steps * (steps + 1) / 2;
  const Mat3 turn = Eigen::AngleAxisd(angle, axis / 3).toRotationMatrix();
  EXPECT_LT((walls.pose(0).turn - turn).norm(), 1e-13);
  EXPECT_LT((walls.pose(0).shift - Vec3(0, 0.1 * steps * dt, 0)).norm(), 1e-13) << "about its reference point";
  EXPECT_EQ(walls.expected_motion(0).spin, view(walls).spin);
}

TEST(Walls, FreeRotationOnASpringOscillatesAtTheLeapFrogFrequency) {
  const double dt = 0.1, inertia = 2, stiffness = 8, omega = std::sqrt(stiffness / inertia), moment = 0.01;
  const Vec3 axis = Vec3(2, -1, 2) / 3;
  Walls walls;
  walls.apply(
      {plate({.free_rotation = FreeRotationDescription{.axis = 7 * axis, .inertia = inertia, .moment = moment}})});
  const double phase = 2 * std::asin(0.5 * omega * dt), rest = moment / stiffness;  // as of a free mass
  const auto angle = [&] {
    const Eigen::AngleAxisd turned(walls.pose(0).turn);
    return turned.angle() * turned.axis().dot(axis);
  };
  for (int n = 0; n < 200; ++n) {
    EXPECT_NEAR(angle(), rest * (1 - std::cos((n + 0.5) * phase) / std::cos(0.5 * phase)), 1e-14) << n;
    walls.clear_forces();
    // Moments about other axes are borne by the bearing.
    walls.add(0, {Vec3::Zero(), -stiffness * angle() * axis + 5 * axis.cross(Vec3::UnitX()), stiffness, 1});
    step(walls, dt);
  }
}

TEST(Walls, WallSetFreeToRotateKeepsTheSpinAlongItsAxis) {
  Walls walls;
  walls.apply({plate({.spin = {1, 0, 3}})});
  step(walls, 0.1);
  const FreeRotationDescription free{.axis = Vec3::UnitZ(), .inertia = 1};
  walls.apply({plate({.free_rotation = free})});
  EXPECT_EQ(view(walls).spin, Vec3(0, 0, 3));
  step(walls, 0.1);
  EXPECT_EQ(view(walls).spin, Vec3(0, 0, 3));
  walls.apply({plate({})});
  step(walls, 0.1);
  EXPECT_EQ(view(walls).spin, Vec3::Zero()) << "it is held again";
}

TEST(Walls, DemandOfFreeWallsIsThatOfTheirContactsOverMassAndInertia) {
  const WallLoad load{.spring = 8, .dashpot = 3, .turning_spring = 50, .turning_dashpot = 20};
  const FreeDescription free{.axes = "z", .mass = 2};
  const FreeRotationDescription rotation{.axis = Vec3::UnitX(), .inertia = 10};
  const auto demand = [&](const MotionDescription& motion) {
    Walls walls;
    walls.apply({plate({}), plate(motion, "other")});
    walls.add(0, load), walls.add(1, load);
    return walls.demand();
  };
  EXPECT_EQ(demand({}).spring, 0);
  EXPECT_EQ(demand({.free = free}).spring, 4);
  EXPECT_EQ(demand({.free = free}).dashpot, 1.5);
  EXPECT_EQ(demand({.free_rotation = rotation}).spring, 5);
  EXPECT_EQ(demand({.free_rotation = rotation}).dashpot, 2);
  EXPECT_EQ(demand({.free = free, .free_rotation = rotation}).spring, 9);
  EXPECT_EQ(demand({.free = free, .free_rotation = rotation}).dashpot, 3.5);
}

TEST(Walls, RotatesAboutTheCentreOfItsBoundsByDefault) {
  Walls walls;
  const auto endless = std::make_shared<Plate>();
  endless->box.low.x() = -std::numeric_limits<double>::infinity();
  endless->box.high.x() = std::numeric_limits<double>::infinity();
  walls.apply({plate({}), {"plane", endless, {}}, plate({.about = Vec3(9, 9, 9)}, "told")});
  EXPECT_EQ(walls.reference(0), Vec3(2, 1, 1));
  EXPECT_EQ(walls.reference(1), Vec3(0, 1, 1));
  EXPECT_EQ(walls.reference(2), Vec3(9, 9, 9));
}

/// A servo-controlled wall that presses on a spring.
struct Spring {
  explicit Spring(const ServoDescription& servo, const Vec3& towards) {
    auto geometry = std::make_shared<Plate>();
    geometry->towards = towards;
    walls.apply({{"lid", geometry, {.servo = servo}}});
    axis = servo.axis[0] - 'x';
    side = towards[axis] < 0 ? -1 : 1;
  }
  double force() const { return std::max(0.0, stiffness * (side * walls.pose(0).shift[axis] - gap)); }
  void advance() {
    walls.clear_forces();
    if (force() > 0) walls.add(0, {-side * force() * Vec3::Unit(axis), Vec3::Zero(), stiffness, 1});
    step(walls, dt);
  }
  Walls walls;
  int axis;
  double side, gap = 0, stiffness = 1e4, dt = 1e-3;
};

TEST(Walls, ServoCorrectsItsGainOfTheErrorPerStep) {
  for (const Vec3& towards : {Vec3(0, 0, -1), Vec3(0, 0, 1), Vec3(-1, 0, 0), Vec3(0, 0.6, -0.8)}) {
    const std::string axis = towards.x() != 0 ? "x" : "z";
    Spring spring({.axis = axis, .pressure = 50, .max_velocity = 1e3, .gain = 0.3}, towards);
    spring.gap = -1e-4;  // in contact from the start: no approach at full speed
    const double target = 50 * 2 * std::abs(towards[spring.axis]);
    double habit = 0;
    for (int n = 0; n < 40; ++n) {
      const double error = spring.force() - target, before = habit;
      const double velocity = habit - 0.3 * error / (spring.stiffness * spring.dt);  // towards the spring
      habit += 0.3 / 30 * (velocity - habit);
      spring.advance();
      EXPECT_NEAR(spring.force() - target, 0.7 * error + spring.stiffness * spring.dt * before, 1e-9 * target) << n;
    }
    EXPECT_LT(std::abs(spring.force() - target), 0.04 * target);
  }
}

TEST(Walls, ServoKeepsItsPressureOnASteadilyExpandingSpecimen) {
  Spring spring({.axis = "z", .pressure = 50, .max_velocity = 1, .gain = 0.3}, {0, 0, -1});
  spring.gap = -100 / spring.stiffness;
  const double swelling = 1e-3;  // m/s; an error of 1e-3 k dt / gain = 0.033 N without the mean velocity
  double largest = 0;
  for (int n = 0; n < 6000; ++n) {
    spring.advance();
    spring.gap -= swelling * spring.dt;
    if (n > 5000) largest = std::max(largest, std::abs(spring.force() - 100));
  }
  EXPECT_NEAR(view(spring.walls).velocity.z(), swelling, 1e-9);
  EXPECT_LT(largest, 1e-6);
}

TEST(Walls, ServoOverTheSpecimenPressesOnItsPresentCrossSection) {
  Spring spring({.axis = "z", .pressure = 50, .max_velocity = 1e3, .area = "specimen"}, {0, 0, -1});
  spring.gap = -1e-4;
  EXPECT_TRUE(spring.walls.presses_on_specimen());
  for (const Vec3& lengths : {Vec3(3, 5, 7), Vec3(2, 4, 100)}) {
    spring.walls.set_specimen(lengths);
    for (int n = 0; n < 2000; ++n) spring.advance();
    EXPECT_NEAR(spring.force(), 50 * lengths.x() * lengths.y(), 1e-6) << "not 50 Pa × 2 m² of the plate";
    EXPECT_EQ(view(spring.walls).area, lengths.x() * lengths.y());
  }
}

TEST(Walls, ServoOverAnOpenSpecimenIsRefused) {
  Spring spring({.axis = "z", .pressure = 50, .max_velocity = 1, .area = "specimen"}, {0, 0, -1});
  for (const Vec3& lengths : {Vec3(1, HUGE_VAL, 1), Vec3(0, 1, 1)}) {
    spring.walls.set_specimen(lengths);
    try {
      spring.advance();
      FAIL();
    } catch (const Error& error) {
      EXPECT_STREQ(
          error.what(),
          "wall \"lid\": found a servo on the cross-section of the specimen, which is open or empty; allowed is a "
          "cross-section bounded by walls of /specimen or by the domain, across z");
    }
  }
}

TEST(Walls, ServoAtItsVelocityLimitIsReported) {
  Spring spring({.axis = "z", .pressure = 50, .max_velocity = 0.2, .gain = 0.3}, {0, 0, -1});
  spring.gap = 1;
  spring.advance(), spring.advance();
  EXPECT_EQ(spring.walls.fallen_behind(), "") << "still approaching";
  spring.gap = -3 * 100 / spring.stiffness;
  const double swelling = 1;  // m/s
  for (int n = 0; n < 20; ++n) {
    spring.gap -= swelling * spring.dt;
    spring.advance();
  }
  const std::string told = spring.walls.fallen_behind(),
                    words = "servo of wall \"lid\" is limited by its max_velocity of 0.2 m/s: ";
  ASSERT_THAT(told, testing::StartsWith(words));
  EXPECT_NEAR(std::stod(told.substr(words.size())), view(spring.walls).pressure, 0.05);
  EXPECT_GT(view(spring.walls).pressure, 150);
  EXPECT_THAT(told, testing::EndsWith(" Pa, target 50"));
  for (int n = 0; n < 500; ++n) spring.advance();  // it is at rest
  EXPECT_EQ(spring.walls.fallen_behind(), "");
  Spring held({.axis = "z", .force = -100, .max_velocity = 0.2, .gain = 0.3}, {0, 0, -1});
  held.gap = -1;
  held.advance(), held.advance();
  EXPECT_THAT(held.walls.fallen_behind(), testing::HasSubstr("m/s: -9998 N"));
  EXPECT_THAT(held.walls.fallen_behind(), testing::EndsWith(" N, target -100"));
}

TEST(Walls, ServoNeverExceedsItsVelocity) {
  const ServoDescription servo{.axis = "z", .pressure = 50, .max_velocity = 0.2, .gain = 0.3};
  Spring spring(servo, {0, 0, -1});
  spring.gap = 0.0101;
  spring.advance();
  EXPECT_EQ(view(spring.walls).velocity, Vec3(0, 0, -0.2)) << "closes at full speed without contact";
  spring.gap = -1e-6;
  spring.advance();
  EXPECT_EQ(view(spring.walls).velocity, Vec3(0, 0, -0.2)) << "far too little force";
  spring.gap = -1;
  spring.advance();
  EXPECT_EQ(view(spring.walls).velocity, Vec3(0, 0, 0.2)) << "far too much force";
  Spring unloaded({.axis = "z", .pressure = 0, .max_velocity = 0.2}, {0, 0, -1});
  unloaded.gap = 1;
  unloaded.advance();
  EXPECT_EQ(view(unloaded.walls).velocity, Vec3(0, 0, 0)) << "target and pressure are 0";
}

/// A wall without area and normal, such as a closed mesh, pressed against springs along x on both sides.
TEST(Walls, ServoKeepsAForceWithoutAnArea) {
  for (const double force : {40.0, -40.0, 0.0}) {
    auto geometry = std::make_shared<Plate>();
    geometry->surface = 0, geometry->towards = Vec3::Zero();
    Walls walls;
    walls.apply({{"ram", geometry, {.servo = ServoDescription{.axis = "x", .force = force, .max_velocity = 2}}}});
    step(walls, 1e-3);
    EXPECT_EQ(view(walls).velocity.x(), force == 0 ? 0 : std::copysign(2, force)) << "closes without contact";
    const double stiffness = 1e4;
    const auto push = [&] { return -stiffness * walls.pose(0).shift.x(); };
    for (int n = 0; n < 2000; ++n) {
      walls.clear_forces();
      walls.add(0, {{push(), 7, 0}, Vec3::Zero(), stiffness, 1});
      step(walls, 1e-3);
    }
    EXPECT_NEAR(push(), -force, 1e-6);
    EXPECT_EQ(view(walls).pressure, 0);
  }
}

TEST(Walls, FollowersCopyOnlyTheirAxesInAnyOrder) {
  const auto behind = [](std::string leader, std::string axes, Vec3 own) {
    return MotionDescription{.velocity = own,
                             .follow = FollowDescription{.wall = std::move(leader), .axes = std::move(axes)}};
  };
  Walls walls;
  walls.apply({plate(behind("b", "z", {0, 9, 0}), "a"), plate(behind("c", "xz", Vec3::Zero()), "b"),
               plate({.velocity = {1, 2, 0}, .servo = ServoDescription{.pressure = 1, .max_velocity = 3}}, "c")});
  step(walls, 0.1);
  EXPECT_EQ(view(walls, 2).velocity, Vec3(1, 2, -3));
  EXPECT_EQ(view(walls, 1).velocity, Vec3(1, 0, -3));
  EXPECT_EQ(view(walls, 0).velocity, Vec3(0, 9, -3));

  const OscillationDescription swing{.amplitude = {0, 0, 1}, .frequency = 2};
  walls.apply({plate(behind("b", "z", {0, 9, 0}), "a"), plate({.oscillation = swing}, "b")});
  step(walls, 0.01);
  EXPECT_NEAR(view(walls, 0).velocity.z(), sine(swing, 0.01) / 0.01, 1e-12);
}

TEST(Walls, SumsLoadsOfBodies) {
  Walls walls;
  walls.apply({plate({})});
  walls.add(0, {{1, 2, 30}, {1, 0, 0}, 5, 2});
  walls.add(0, {{1, 1, 10}, {0, 1, 0}, 6, 1});
  EXPECT_EQ(view(walls).force, Vec3(2, 3, 40));
  EXPECT_EQ(view(walls).moment, Vec3(1, 1, 0));
  EXPECT_EQ(view(walls).pressure, 20) << "a lid pushed up is in compression";
  EXPECT_EQ(view(walls).contacts, 3u);
  EXPECT_EQ(walls.states()[0].stiffness, 11);
  walls.clear_forces();
  EXPECT_EQ(view(walls).force, Vec3::Zero());
  EXPECT_EQ(view(walls).moment, Vec3::Zero());
  EXPECT_EQ(view(walls).contacts, 0u);
  EXPECT_EQ(walls.states()[0].stiffness, 0);
}

TEST(Walls, NewStageKeepsPosesAndStartsItsOwnRampAndPosition) {
  Walls walls;
  walls.apply({plate({.velocity = {1, 0, 0}}), plate({}, "side")});
  for (int i = 0; i < 10; ++i) step(walls, 0.1);
  walls.apply({plate({}, "base"), plate({.velocity = {2, 0, 0}, .ramp_time = 0.4}), plate({}, "side")});
  ASSERT_EQ(walls.name(1), "lid");
  step(walls, 0.1);
  EXPECT_NEAR(view(walls, 1).position.x(), 1 + 0.025, 1e-15);
  EXPECT_NEAR(view(walls, 1).stage_position.x(), 0.025, 1e-15);
  EXPECT_EQ(view(walls, 0).position, Vec3::Zero()) << "a new wall";
  walls.change({plate({.velocity = {4, 0, 0}, .ramp_time = 0.4})});
  step(walls, 0.1);
  EXPECT_NEAR(view(walls).stage_position.x(), 0.025 + 0.15, 1e-15) << "a change within the stage restarts nothing";
}

TEST(Walls, WallSetFreeKeepsItsVelocity) {
  Walls walls;
  walls.apply({plate({.velocity = {0, 0, 3}})});
  step(walls, 0.1);
  walls.apply({plate({.free = FreeDescription{.axes = "z", .mass = 1}})});
  step(walls, 0.1);
  EXPECT_EQ(view(walls).velocity.z(), 3);
}

TEST(Walls, NewReferencePointMovesNothing) {
  const Vec3 point(0.3, 0.7, 1), about(5, 0, 0);
  Walls walls;
  walls.apply({plate({.velocity = {1, 0, 0}, .spin = {0, 0, 2}})});
  for (int i = 0; i < 7; ++i) step(walls, 0.1);
  walls.add(0, {{0, 0, 5}, {1, 2, 3}, 1, 1});
  const Vec3 place = walls.pose(0).to_world(point), velocity = walls.point_velocity(0, place),
             before = walls.reference(0);
  walls.apply({plate({.about = about})});
  EXPECT_LT((walls.pose(0).to_world(point) - place).norm(), 1e-14);
  EXPECT_LT((walls.point_velocity(0, place) - velocity).norm(), 1e-14);
  EXPECT_LT((walls.reference(0) - walls.pose(0).to_world(about)).norm(), 1e-14);
  EXPECT_LT((view(walls).moment - (Vec3(1, 2, 3) + (before - walls.reference(0)).cross(Vec3(0, 0, 5)))).norm(), 1e-13);
  EXPECT_EQ(view(walls).stage_position, Vec3::Zero());
}

TEST(Walls, RestoredWallsContinueIdentically) {
  std::vector<WallSetup> setups{
      plate({.velocity = {1, 0, 0},
             .spin = {0.1, 0.2, 0.3},
             .ramp_time = 0.7,
             .oscillation = OscillationDescription{.amplitude = {0, 0.2, 0},
                                                   .angle = {0.3, 0, 0},
                                                   .frequency = 0.4,
                                                   .amplitude_phase = {0, 0.3, 0},
                                                   .angle_phase = {0.7, 0, 0}},
             .free = FreeDescription{.axes = "z", .mass = 3, .load = {0, 0, 1}}}),
      plate({.free_rotation = FreeRotationDescription{.axis = {1, 2, 3}, .inertia = 3, .moment = 1}}, "rotor")};
  Walls whole, halved;
  whole.apply(setups);
  for (int i = 0; i < 5; ++i) step(whole, 0.1);
  const std::vector<WallSetup> first = setups;
  setups[0].motion.oscillation->frequency = 0.7;
  whole.change(setups);
  step(whole, 0.1);
  halved.apply(first);
  restore_state(halved, saved_state(whole));
  halved.change(setups);  // as at the increment of a ramp where it stopped
  for (int i = 0; i < 5; ++i) step(whole, 0.1), step(halved, 0.1);
  EXPECT_EQ(whole.pose(0).shift, halved.pose(0).shift);
  EXPECT_EQ(whole.pose(0).turn, halved.pose(0).turn);
  EXPECT_GT(std::abs(whole.pose(0).shift.y()), 1e-3);
  EXPECT_EQ(view(whole).velocity, view(halved).velocity);
  EXPECT_EQ(view(whole, 1).spin, view(halved, 1).spin);
  EXPECT_EQ(whole.pose(1).turn, halved.pose(1).turn);
  try {
    Walls none;
    restore_state(halved, saved_state(none));
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "the checkpoint has 0 walls, but the description has 2; continue with the description that wrote it");
  }
}

TEST(Walls, RejectInvalidMotions) {
  const ServoDescription servo{.axis = "z", .pressure = 1, .max_velocity = 1};
  const auto flat = [](double area, const Vec3& towards, const ServoDescription& how) -> std::vector<WallSetup> {
    auto geometry = std::make_shared<Plate>();
    geometry->surface = area;
    geometry->towards = towards;
    return {{"lid", geometry, {.servo = how}}};
  };
  EXPECT_EQ(complaint(flat(1, -Vec3::UnitZ(), servo)), "");
  EXPECT_EQ(complaint(flat(0, -Vec3::UnitZ(), servo)),
            "wall \"lid\": found a servo pressure on a geometry without an area; allowed is a geometry with an area (a "
            "rectangle, or its parameter area), or a force instead of the pressure");
  EXPECT_EQ(
      complaint(flat(1, Vec3::UnitX(), servo)),
      "wall \"lid\": found a servo pressure along z, perpendicular to the normal of the wall; allowed is an axis along "
      "which the normal has a component, or a force instead of the pressure");
  EXPECT_EQ(complaint(flat(1, -Vec3::UnitZ(), {.axis = "z", .pressure = 1})),
            "wall \"lid\": a servo needs max_velocity above 0");
  EXPECT_EQ(complaint(flat(1, -Vec3::UnitZ(), {.axis = "xz", .pressure = 1, .max_velocity = 1})),
            "wall \"lid\": a servo along \"xz\"; allowed is one axis");
  EXPECT_EQ(complaint({plate({.velocity = {0, 0, 1}, .servo = servo})}),
            "wall \"lid\": two motions along z; choose velocity and oscillation, or one of servo, follow and free");
  EXPECT_EQ(complaint({plate(
                {.oscillation = OscillationDescription{.amplitude = {1, 0, 1}, .frequency = 1}, .servo = servo})}),
            "wall \"lid\": two motions along z; choose velocity and oscillation, or one of servo, follow and free");
  EXPECT_EQ(complaint({plate({.velocity = {1, 0, 0},
                              .oscillation = OscillationDescription{.amplitude = {1, 0, 0}, .frequency = 1},
                              .servo = servo})}),
            "");
  EXPECT_EQ(complaint(flat(0, Vec3::Zero(), {.axis = "z", .force = -3, .max_velocity = 1})), "");
  EXPECT_EQ(complaint(flat(1, Vec3::UnitZ(), {.axis = "z", .max_velocity = 1})),
            "wall \"lid\": a servo needs either a pressure or a force");
  EXPECT_EQ(complaint({plate({.free = FreeDescription{.axes = "z"}})}),
            "wall \"lid\": a free wall needs a mass above 0");
  EXPECT_EQ(complaint({plate({.free = FreeDescription{.axes = "w", .mass = 1}})}),
            "wall \"lid\": free along \"w\"; allowed is x, y or z");
  const auto turns = [](const Vec3& axis, double inertia) {
    return FreeRotationDescription{.axis = axis, .inertia = inertia};
  };
  EXPECT_EQ(complaint({plate({.free_rotation = turns(Vec3::UnitX(), 0)})}),
            "wall \"lid\": free rotation needs an inertia above 0");
  EXPECT_EQ(complaint({plate({.free_rotation = turns(Vec3::Zero(), 1)})}),
            "wall \"lid\": free rotation needs an axis of a length above 0");
  const std::string two = "wall \"lid\": two rotations; choose spin and oscillation, or free_rotation";
  EXPECT_EQ(complaint({plate({.spin = {1, 0, 0}, .free_rotation = turns(Vec3::UnitX(), 1)})}), two);
  EXPECT_EQ(complaint({plate({.oscillation = OscillationDescription{.angle = {0, 0, 1}, .frequency = 1},
                              .free_rotation = turns(Vec3::UnitX(), 1)})}),
            two);
  EXPECT_EQ(complaint({plate({.velocity = {1, 0, 0}, .free_rotation = turns(Vec3::UnitX(), 1)})}), "");
  EXPECT_EQ(complaint({plate({.follow = FollowDescription{.wall = "base"}})}),
            "wall \"lid\": follows the wall \"base\", which does not exist");
  EXPECT_EQ(complaint({plate({.follow = FollowDescription{.wall = "b"}}, "a"),
                       plate({.follow = FollowDescription{.wall = "a"}}, "b")}),
            "wall \"a\": follows itself, directly or through other walls");
}

}  // namespace
}  // namespace grit
