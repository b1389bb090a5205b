// Each guard stops a run at its limit, and reports the cause, body, time and remedy; none stops a good run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "grit/error.hpp"
#include "support/packing.hpp"

namespace grit::test::guards_tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Applies a force of NaN to every body from the fifth step on.
class Poison final : public Engine {
 public:
  void declare(Parameters&) override {}
  Phase phase() const override { return Phase::forces; }
  void forces(const World& world, std::span<Row> force, std::span<Row>) const override {
    if (world.step() >= 5) force.back().y = std::numeric_limits<double>::quiet_NaN();
  }
};

Description two(double gap, double speed) {
  Description d = description("linear-rolling", {{"contact_modulus", 1e7}},
                              {{{0, 0, 0}, 1e-3, {speed, 0, 0}}, {{2e-3 + gap, 0, 0}, 1e-3, {-speed, 0, 0}}});
  d["time_step"]["value"] = 1e-6;
  return d;
}

std::string complaint(const Description& d, std::size_t steps) {
  try {
    Trial t(d);
    t.step(steps);
  } catch (const NumericsError& error) {
    return error.what();
  }
  return "";
}

TEST(Guards, LeaveAGoodRunAlone) {
  EXPECT_EQ(complaint(two(1e-5, 1), 600), "");
  Description d = description("linear-rolling", {{"contact_modulus", 1e7}}, {{{0, 0, 2e-3}, 1e-3}});
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["engines"]["gravity"] = {{"type", "gravity"}};
  d["domain"] = {{"low", {-1, -1, -1}}, {"high", {1, 1, 1}}};
  d["time_step"]["safety"] = 0.1;  // an impact may gain (ω dt)²/4 of the energy
  EXPECT_EQ(complaint(d, 20000), "") << "a bouncing ball neither gains energy nor leaves";
}

TEST(Guards, Overlap) {
  // The deepest overlap is v/ω = 1.3 mm at 20 m/s, far beyond a fifth of a radius.
  const std::string text = complaint(two(0, 20), 200);
  EXPECT_THAT(text, testing::MatchesRegex(
                        "step [0-9]+, time [0-9.e-]+ s: body 0 at \\(.*\\) m overlaps body 1 by 0\\.[0-9]+ of its "
                        "radius, more than /guards/overlap 0\\.2; the contact modulus may be too low for this "
                        "load, or bodies overlapped at the start"));
  Description allowed = two(0, 2);
  EXPECT_EQ(complaint(allowed, 200), "");
  allowed["guards"]["overlap"] = 0.02;
  EXPECT_THAT(complaint(allowed, 200), HasSubstr("more than /guards/overlap 0.02"));

  Description wall = description("linear-rolling", {{"contact_modulus", 1e7}}, {{{0, 0, 0.7e-3}, 1e-3}});
  wall["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  EXPECT_THAT(complaint(wall, 1), HasSubstr("step 0, time 0 s: body 0 at (0, 0, 0.0007) m appears inside wall "
                                            "\"floor\": they overlap by 0.3 of its radius, "
                                            "more than /guards/overlap 0.2; place it in front of the wall"));
  Description thrown = description("linear-rolling", {{"contact_modulus", 1e7}}, {{{0, 0, 1e-3}, 1e-3, {0, 0, -20}}});
  thrown["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  thrown["time_step"]["value"] = 1e-6;
  EXPECT_THAT(complaint(thrown, 200),
              AllOf(HasSubstr("overlaps wall \"floor\" by 0."), HasSubstr("the wall may face away from the bodies")));
}

TEST(Guards, Travel) {
  EXPECT_EQ(complaint(two(1, 49), 3), "");
  EXPECT_THAT(
      complaint(two(1, 51), 3),
      HasSubstr(
          "step 0, time 0 s: body 0 at (0, 0, 0) m moves 0.051 of its radius in one step, more than "
          "/guards/travel 0.05; bodies may overlap too much at the start, a wall may be too fast, or the time step"));
}

TEST(Guards, TravelOfABodyThatIsAccelerated) {
  Description d = two(1, 0);
  d["engines"]["rocket"] = {{"type", "gravity"}, {"acceleration", {1e7, 0, 0}}};
  EXPECT_THAT(complaint(d, 10), testing::AllOf(HasSubstr("step 6, time 6e-06 s: body 0 at"),
                                               HasSubstr("moves 0.055 of its radius in one step")));
}

TEST(Guards, WallThatPassesThroughBodies) {
  Description d = two(1, 0);
  d["walls"]["lid"] = plane({0, 0, 1.0002e-3}, -Vec3::UnitZ());
  d["walls"]["lid"]["motion"]["velocity"] = {1000, 0, -49};
  EXPECT_EQ(complaint(d, 3), "") << "however fast it slides along itself";
  d["walls"]["lid"]["motion"]["velocity"] = {0, 0, -51};
  EXPECT_THAT(complaint(d, 3), HasSubstr("wall \"lid\" moves 0.051 of a radius towards a body in one step, more than "
                                         "/guards/travel 0.05; a wall this fast passes through bodies"));
  d["walls"]["lid"]["motion"]["velocity"] = {0, 0, 51};
  EXPECT_EQ(complaint(d, 3), "") << "away from bodies";
}

// In one step it is beyond bodies that it was far from before.
TEST(Guards, WallThatJumpsOverBodies) {
  Description d = two(1, 0);
  d["walls"]["lid"] = plane({0, 0, 0.02}, -Vec3::UnitZ());
  d["walls"]["lid"]["motion"]["velocity"] = {0, 0, -4e4};
  EXPECT_THAT(complaint(d, 3), HasSubstr("wall \"lid\" moves 40 of a radius towards a body in one step, more than "
                                         "/guards/travel 0.05; a wall this fast passes through bodies"));
  d["walls"]["lid"]["motion"]["velocity"] = {0, 0, 4e4};
  EXPECT_EQ(complaint(d, 3), "") << "away from bodies";
  d["walls"]["lid"]["motion"]["velocity"] = {4e4, 0, 0};
  EXPECT_EQ(complaint(d, 3), "") << "along itself";

  Description sheet = two(1, 0);
  sheet["walls"]["blade"] = {{"type", "rectangle"},   {"corner", {-0.05, -0.05, 0.02}},
                             {"edge_a", {0.1, 0, 0}}, {"edge_b", {0, 0.1, 0}},
                             {"two_sided", true},     {"material", "grain"}};
  sheet["walls"]["blade"]["motion"]["velocity"] = {0, 0, -4e4};
  EXPECT_THAT(complaint(sheet, 3), HasSubstr("wall \"blade\" moves 40 of a radius towards a body in one step"));
}

TEST(Guards, WallThatFacesAway) {
  Description d = two(1, 0);
  d["walls"]["floor"] = plane({0, 0, -0.04}, -Vec3::UnitZ());
  EXPECT_THAT(complaint(d, 1), HasSubstr("wall \"floor\" faces away from the bodies: 2 of 2 have their centres behind "
                                         "it, the deepest by an overlap of 41 of its radius"));
}

TEST(TimeStep, FollowsSpringsThatStiffenBetweenSearches) {
  Description d =
      description("hertz-mindlin", {{"young_modulus", 1e8}, {"poisson_ratio", 0.2}}, {{{0, 0, 1e-3}, 1e-3}});
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["walls"]["lid"] = plane({0, 0, 2e-3}, -Vec3::UnitZ());
  d["walls"]["lid"]["motion"]["velocity"] = {0, 0, -2e-3};
  Trial t(d);
  const double first = t.world().dt();
  double overlap = 0, least = first;
  while (t.world().step() < 2000 && t.world().time() < 6e-3) {
    t.step();
    for (const Contact& c : t.world().contacts()) overlap = std::max(overlap, c.overlap);
    least = std::min(least, t.world().dt());
  }
  ASSERT_GT(overlap, 5e-6);
  ASSERT_EQ(t.kernel().state().lists.rebuilds(), 1u);
  // k ∝ √overlap; the limit of a ball between plates is 2 / sqrt(2 k / m).
  const double mass = 2600 * 4 / 3 * std::numbers::pi * 1e-9, modulus = 1e8 / (1 - 0.04) / 2;
  const double k = 2 * modulus * std::sqrt(1e-3 * overlap);
  EXPECT_LE(least, 0.8 * 2 / std::sqrt(2 * k / mass) * 1.05) << "20 % more overlap changes the step by 5 %";
  EXPECT_LT(least, 0.8 * first);
}

TEST(TimeStep, IsShortEnoughForAnImpactBeforeItBegins) {
  // A wall hits a body at rest, two bodies collide, and one falls.
  const Description solid{{"young_modulus", 1e8}, {"poisson_ratio", 0.2}, {"friction_angle", 0}};
  const Description lid = plane({0, 0, 2.3e-3}, -Vec3::UnitZ()), floor = plane(Vec3::Zero(), Vec3::UnitZ());
  Description struck = description("hertz-mindlin", solid, {{{0, 0, 1e-3}, 1e-3}});
  struck["walls"]["lid"] = lid, struck["walls"]["lid"]["motion"]["velocity"] = {0, 0, -0.2};
  const Description meeting =
      description("hertz-mindlin", solid, {{{0, 0, 0}, 1e-3, {0.2, 0, 0}}, {{2.3e-3, 0, 0}, 1e-3, {-0.2, 0, 0}}});
  Description falling = description("hertz-mindlin", solid, {{{0, 0, 9e-3}, 1e-3}});
  falling["walls"]["floor"] = floor, falling["engines"]["gravity"] = {{"type", "gravity"}};
  for (const Description& d : {struck, meeting, falling}) {
    Trial t(d);
    double before = 0, overlap = 0;
    while (t.world().step() < 5000 && !(overlap > 0 && t.world().contacts().empty())) {
      t.step();
      if (overlap == 0) before = t.world().dt();
      for (const Contact& c : t.world().contacts()) overlap = std::max(overlap, c.overlap);
    }
    ASSERT_GT(overlap, 5e-6);
    // Two equal bodies with the same overlap.
    const double mass = 2600 * 4 / 3 * std::numbers::pi * 1e-9, modulus = 1e8 / (1 - 0.04) / 2;
    const double k = 2 * modulus * std::sqrt(0.5e-3 * overlap);
    EXPECT_LE(before, 0.8 * 2 / std::sqrt(2 * k / mass) * 1.05);
    EXPECT_GE(before, 0.8 * 2 / std::sqrt(2 * k / mass) * 0.8) << "not shorter than necessary";
  }
}

TEST(Guards, KeepTheForcesAtTheStop) {
  const double modulus = 1e6, radius = 1e-3;
  Description d = description("linear-frictional", {{"contact_modulus", modulus}, {"friction_angle", 0}},
                              {{{0, 0, 0}, radius, {0.5, 0, 0}}, {{2.0001 * radius, 0, 0}, radius, {-0.5, 0, 0}}});
  d["time_step"] = {{"safety", 0.05}};
  d["guards"] = {{"overlap", 0.02}};
  Trial t(d);
  EXPECT_THROW(for (int i = 0; i < 1000; ++i) t.kernel().step_on(), NumericsError);
  const auto x = t.world().positions(), f = t.world().forces();
  const double overlap = 2 * radius - (x[1].x - x[0].x);
  ASSERT_GT(overlap, 0.02 * radius);
  EXPECT_NEAR(f[1].x, modulus * radius * overlap, 1e-12 * f[1].x);
  EXPECT_EQ(f[0].x, -f[1].x);
}

TEST(Guards, SpuriousEnergy) {
  // ω dt = 2.2: each impact increases the speed of the ball.
  Description d = description("linear-rolling", {{"contact_modulus", 1e7}, {"friction_angle", 0}, {"rolling_limit", 0}},
                              {{{0, 0, 1.01e-3}, 1e-3}});
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["engines"]["gravity"] = {{"type", "gravity"}};
  const double mass = 2600 * 4.18879e-9, dt = 2.2 / std::sqrt(1e4 / mass);
  d["time_step"] = {{"value", dt}, {"allow_unstable", true}};
  d["guards"] = {{"overlap", 1e9}, {"travel", 1e9}};
  EXPECT_THAT(complaint(d, 3000),
              testing::MatchesRegex(
                  "step [0-9]+, time [0-9.e-]+ s: energy was created: [0-9.e+-]+ J more than the work done, "
                  "[0-9.e+-]+ of the largest energy so far; /guards/energy allows 0\\.05; the time step may be "
                  "too large for the stiffest contact; try a smaller /time_step/safety"));
  d["time_step"]["value"] = 0.1 * dt;
  EXPECT_EQ(complaint(d, 3000), "");
}

TEST(Guards, SpuriousEnergyInAShortStage) {
  // As above; the stage ends before the first regular check.
  Description d = description("linear-rolling", {{"contact_modulus", 1e7}, {"friction_angle", 0}, {"rolling_limit", 0}},
                              {{{0, 0, 1.0001e-3}, 1e-3, {0, 0, -0.1}}});
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  const double mass = 2600 * 4.18879e-9, dt = 2.2 / std::sqrt(1e4 / mass);
  d["time_step"] = {{"value", dt}, {"allow_unstable", true}};
  d["guards"] = {{"overlap", 1e9}, {"travel", 1e9}};
  Trial unstable(d);
  EXPECT_NO_THROW(unstable.step(30));
  EXPECT_GT(unstable.world().velocities()[0].z, 0.11);
  EXPECT_THROW(unstable.kernel().end_stage(), NumericsError);
  d["time_step"]["value"] = 0.05 * dt;
  Trial stable(d);
  stable.step(60);
  EXPECT_NO_THROW(stable.kernel().end_stage());
}

std::string complaint_by_energy(const Description& d, std::size_t steps) {
  try {
    Trial t(d, 1, BodyState::energy);
    t.world().energies();
    t.step(steps);
  } catch (const NumericsError& error) {
    return error.what();
  }
  return "";
}

/// A gas of rough grains without dashpots in a periodic cell; `turn`: ω dt of two in contact.
Description rough_gas(double turn) {
  constexpr double modulus = 1e7, spacing = 1e-3, density = 2500, radius = 0.5 * spacing;
  std::vector<Grain> grains = jumble({5, 5, 5}, 1.3 * spacing, 0.3, 3);
  for (Grain& grain : grains) grain.radius = radius;
  Description d = description("linear-frictional",
                              {{"contact_modulus", modulus}, {"density", density}, {"friction_angle", 0.1}}, grains);
  d["domain"] = {{"low", {0, 0, 0}}, {"high", vector(Vec3::Constant(5 * 1.3 * spacing))}};
  d["domain"]["periodic"] = {true, true, true};
  const double mass = density * 4 / 3 * std::numbers::pi * radius * radius * radius;
  d["time_step"] = {{"value", turn / std::sqrt(2 * modulus * radius / mass)}, {"allow_unstable", true}};
  d["guards"] = {{"travel", 1}};
  return d;
}

TEST(Guards, SpuriousEnergyHiddenByFriction) {
  const std::size_t steps = 20000;
  EXPECT_EQ(complaint(rough_gas(1.56), steps), "") << "friction dissipates the gain";
  EXPECT_THAT(complaint_by_energy(rough_gas(1.56), steps),
              testing::MatchesRegex("step [0-9]+, time [0-9.e-]+ s: energy was created: [0-9.e+-]+ J more than "
                                    "the work done, [0-9.e+-]+ of the largest energy so far plus dissipation; "
                                    "/guards/energy allows 0\\.05; the time step may be too large for the stiffest "
                                    "contact; try a smaller /time_step/safety"));
  EXPECT_EQ(complaint_by_energy(rough_gas(0.156), steps), "");
  Description chosen = rough_gas(1);
  chosen["time_step"] = Description::object();
  EXPECT_EQ(complaint_by_energy(chosen, steps), "") << "at the default time step";
}

TEST(Guards, SpuriousEnergyWithAForceAlongAPeriodicAxis) {
  // ω dt = 2.2, as above.
  Description d = description("linear-rolling", {{"contact_modulus", 1e7}, {"friction_angle", 0}, {"rolling_limit", 0}},
                              {{{0.05, 0, 1.01e-3}, 1e-3}});
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["domain"] = {{"low", {0, -1, -1}}, {"high", {0.1, 1, 1e3}}, {"periodic", {true, false, false}}};
  d["engines"]["gravity"] = {{"type", "gravity"}, {"acceleration", {0.1, 0, -9.81}}};
  const double mass = 2600 * 4.18879e-9, dt = 2.2 / std::sqrt(1e4 / mass);
  d["time_step"] = {{"value", dt}, {"allow_unstable", true}};
  d["guards"] = {{"overlap", 1e9}, {"travel", 1e9}};
  EXPECT_EQ(complaint(d, 3000), "") << "there is no potential, and no energy balance";
  EXPECT_THAT(complaint_by_energy(d, 3000), HasSubstr("energy was created"));
  d["time_step"]["value"] = 0.1 * dt;
  EXPECT_EQ(complaint_by_energy(d, 3000), "");
}

TEST(Guards, SpuriousEnergyWhileACellDoesWorkOrBodiesAreHeld) {
  // ω dt = 2.2, as above.
  for (const bool held : {false, true}) {
    Description d =
        description("linear-rolling", {{"contact_modulus", 1e7}, {"friction_angle", 0}, {"rolling_limit", 0}},
                    {{{0.05, 0, 1.01e-3}, 1e-3}});
    d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
    d["domain"] = {{"low", {0, -1, -1}}, {"high", {0.1, 1, 1e3}}, {"periodic", {true, false, false}}};
    d["engines"]["gravity"] = {{"type", "gravity"}};
    if (held) d["engines"]["hold"] = {{"type", "hold"}};
    else d["domain"]["strain_rate"] = {0.1, 0, 0};
    const double mass = 2600 * 4.18879e-9, dt = 2.2 / std::sqrt(1e4 / mass);
    d["time_step"] = {{"value", dt}, {"allow_unstable", true}};
    d["guards"] = {{"overlap", 1e9}, {"travel", 1e9}};
    EXPECT_EQ(complaint(d, 3000), "") << "no energy balance";
    EXPECT_THAT(complaint_by_energy(d, 3000), HasSubstr("energy was created"));
    d["time_step"]["value"] = 0.1 * dt;
    EXPECT_EQ(complaint_by_energy(d, 3000), "");
  }
}

TEST(Guards, NotANumber) {
  static const PluginInfo poison = [] {
    PluginInfo info;
    info.kind = "engine", info.name = "poison", info.version = "1.0.0", info.doc = "for tests";
    info.make_engine = []() -> Engine* { return new Poison; };
    return info;
  }();
  installed().add(poison);
  Description d = two(1, 1);
  d["engines"]["poison"] = {{"type", "poison"}};
  EXPECT_EQ(complaint(d, 4), "");
  EXPECT_THAT(
      complaint(d, 5),
      testing::MatchesRegex("step 5, time 5e-06 s: body [01] at .* gets a force of the engine \"poison\" that is "
                            "not finite; this engine needs a finite value wherever bodies are, at every "
                            "velocity and time"));
  d["engines"]["before"] = d["engines"]["zero"] = {{"type", "drag"}, {"viscosity", 1e-5}, {"law", "stokes"}};
  EXPECT_THAT(complaint(d, 5), HasSubstr("of the engine \"poison\"")) << "not of the others";

  Description heavy = two(1, 1);
  for (const char* name : {"one", "other"})
    heavy["engines"][name] = {{"type", "gravity"}, {"acceleration", {0, 1.5e308, 0}}};
  EXPECT_THAT(complaint(heavy, 1),
              testing::MatchesRegex("step 1, time 1e-06 s: body [01] at .* has a velocity that is not a number; "
                                    "two bodies may have started at the same point, or the time step is too large"));
}

/// What an engine adds to bodies on which it does not act is discarded, whatever it is.
TEST(Guards, AForceOnOtherGroupsMayBeAnything) {
  Description d = two(1, 1);
  d["bodies"]["others"] = d["bodies"]["grains"];
  d["bodies"]["others"]["source"]["bodies"] = Description::array({{{"position", {-1, 0, 0}}, {"radius", 1e-3}}});
  d["engines"]["root"] = {{"type", "force-field"}, {"z", "sqrt(x)"}, {"groups", {"grains"}}};
  EXPECT_EQ(complaint(d, 3), "") << "the other group is at a negative x";
  d["engines"]["root"]["groups"] = {"others"};
  EXPECT_THAT(complaint(d, 0),
              HasSubstr("body 2 at (-1, 0, 0) m gets a force of the engine \"root\" that is not finite"));
}

TEST(Guards, LeftTheDomain) {
  Description d = two(1e-3, 1);
  d["domain"] = {{"low", {-2e-3, -2e-3, -2e-3}}, {"high", {6e-3, 2e-3, 2e-3}}};
  d["bodies"]["grains"]["source"]["bodies"][1]["velocity"] = {30, 0, 0};
  EXPECT_THAT(complaint(d, 1000),
              testing::MatchesRegex("step [0-9]+, time [0-9.e-]+ s: body 1 at \\(0.008.*\\) m left the domain "
                                    "through its upper x side; close the domain there with a wall, make it "
                                    "larger, or name the side in /domain/open_sides"));
  d["bodies"]["grains"]["source"]["bodies"][1]["velocity"] = {0, 0, -30};
  EXPECT_THAT(complaint(d, 1000), HasSubstr("left the domain through its lower z side"));
}

TEST(Guards, StepAboveTheCriticalOne) {
  Description d = two(0, 1);
  d["time_step"]["value"] = 1e-4;
  EXPECT_THAT(complaint(d, 1),
              testing::MatchesRegex("step 0, time 0 s: the time step 0.0001 s is above the critical one, "
                                    "[0-9.e-]+ s; remove /time_step/value, or set /time_step/allow_unstable to true"));
  d["time_step"]["allow_unstable"] = true;
  d["guards"] = {{"travel", 1e9}, {"overlap", 1e9}};
  EXPECT_EQ(complaint(d, 1), "");
}

TEST(Guards, CountTheWorkOfAServoByTheForcesAtBothEndsOfAStep) {
  // A servo moves according to the force at the start of a step; with this force alone its work would be far too small.
  constexpr double radius = 1e-3;
  Description d = description("linear-rolling", {{"contact_modulus", 1e7}}, {{{0, 0, radius}, radius}});
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["walls"]["lid"] = {{"type", "rectangle"},
                       {"corner", {-radius, radius, 2 * radius}},
                       {"edge_a", {2 * radius, 0, 0}},
                       {"edge_b", {0, -2 * radius, 0}},
                       {"material", "grain"},
                       {"motion", {{"servo", {{"axis", "z"}, {"pressure", 2e4}, {"max_velocity", 0.05}}}}}};
  d["time_step"]["safety"] = 0.05;
  d["guards"] = {{"energy", 1e-4}};
  Trial t(d);
  EXPECT_NO_THROW(t.step(5000));
  EXPECT_GT(t.kernel().state().walls.states()[1].force.norm(), 0.07) << "the lid presses";
}

}  // namespace
}  // namespace grit::test::guards_tests
