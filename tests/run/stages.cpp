// Stages: conditions, changes, reports, end of a run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "run/conditions.hpp"
#include "support/notes.hpp"
#include "support/packing.hpp"

namespace grit::test::stages_tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double dt = 1e-5, radius = 1e-3, modulus = 1e7, density = 2600;
constexpr double mass = density * 4.188790204786391 * radius * radius * radius;

/// One grain at rest, 1 mm above a floor of 1 cm², steps of 10 µs, and a stage with the condition `until`.
Description lone(const Description& until, double limit = 1) {
  Description d = description("linear-rolling", {{"contact_modulus", modulus}, {"density", density}},
                              {{{0, 0, 2 * radius}, radius}});
  d["time_step"]["value"] = dt;
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["walls"]["floor"]["area"] = 1e-4;
  d["stages"][0]["until"] = until;
  d["stages"][0]["limit"] = limit;
  return d;
}
Description steps(int n) { return {{"type", "steps"}, {"value", n}}; }
Description seconds(double t) { return {{"type", "time"}, {"value", t}}; }
Description stage(const char* name, const Description& until) {
  return {{"name", name}, {"until", until}, {"limit", 1}};
}
/// The grain, dropped, comes to rest on the floor.
Description dropped(const Description& until) {
  Description d = lone(until);
  d["bodies"]["grains"]["source"]["bodies"][0]["position"] = {0, 0, radius};
  d["engines"]["gravity"] = {{"type", "gravity"}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.5}};
  return d;
}
/// A cell of 1 cm³ with a grain in it that shrinks evenly.
Description shrinking(const Description& until, double rate) {
  Description d = lone(until);
  d.erase("walls");
  d["bodies"]["grains"]["source"]["bodies"][0]["position"] = {5e-3, 5e-3, 5e-3};
  d["domain"] = {{"low", {0, 0, 0}},
                 {"high", {1e-2, 1e-2, 1e-2}},
                 {"periodic", {true, true, true}},
                 {"strain_rate", {rate, 0, 0}}};
  return d;
}

std::uint64_t steps_until(const Description& until) { return run(lone(until)).summary().steps; }

/// The index of a material in a contact must not depend on when the material is defined.
TEST(Stage, MayGiveAWallAMaterialThatItAdds) {
  const Description ice = {{"contact_modulus", modulus / 7}, {"friction_angle", 0.05}, {"density", density}};
  const auto slid = [&](bool from_the_start) {
    Description d = lone(steps(10));
    d["materials"]["grain"]["friction_angle"] = 0.5;
    auto& grain = d["bodies"]["grains"]["source"]["bodies"][0];
    grain["position"] = {0, 0, 0.999 * radius}, grain["velocity"] = {0.1, 0, 0};
    d["stages"].push_back(stage("on ice", steps(10)));
    d["stages"][1]["change"] = {{"materials", {{"ice", ice}}}, {"walls", {{"floor", {{"material", "ice"}}}}}};
    if (from_the_start) d["materials"]["ice"] = ice;
    Trial t(d);
    t.step(10);
    t.begin_stage(1, "on ice");
    t.step(10);
    const State& state = t.kernel().state();
    EXPECT_EQ(state.materials.at(state.surfaces.at(0).material), "ice");
    return t.position(0);
  };
  EXPECT_EQ(slid(false), slid(true));
}

TEST(Stage, ReportsAServoThatFellBehind) {
  Description d = lone(steps(100));
  d["bodies"]["grains"]["source"]["bodies"][0]["position"] = {0, 0, radius};
  d["walls"]["floor"]["motion"]["velocity"] = {0, 0, 0.1};
  d["walls"]["lid"] = plane(2 * radius * Vec3::UnitZ(), -Vec3::UnitZ());
  d["walls"]["lid"]["area"] = 1e-4;
  auto& servo = d["walls"]["lid"]["motion"]["servo"];
  servo = {{"axis", "z"}, {"pressure", 100}, {"max_velocity", 0.01}};
  const auto told = [&] { return run(d).notes.ended.front(); };
  EXPECT_THAT(told(), HasSubstr("; servo of wall \"lid\" is limited by its max_velocity of 0.01 m/s: "));
  servo["max_velocity"] = 1;
  EXPECT_THAT(told(), testing::Not(HasSubstr("is limited by")));
}

TEST(Stage, ReportsACellThatFellBehind) {
  Description d = shrinking(steps(100), 0);
  d["domain"]["servo"] = {{"stress", {{"xx", 2e3}, {"zz", 0}}}, {"max_strain_rate", 0.5}};
  EXPECT_THAT(
      run(d).notes.ended.front(),
      HasSubstr("; servo of the cell is limited by its max_strain_rate of 0.5 1/s: stress xx 0 Pa, target 2000"))
      << "and not zz";
  d["domain"]["servo"]["stress"]["xx"] = 0;
  EXPECT_THAT(run(d).notes.ended.front(), testing::Not(HasSubstr("is limited by")));
}

TEST(Stage, EndsAtATimeOrAfterSteps) {
  EXPECT_EQ(steps_until(seconds(1e-3)), 100u);
  EXPECT_EQ(steps_until(seconds(1.004e-3)), 100u);
  EXPECT_EQ(steps_until(seconds(1.006e-3)), 101u);
  EXPECT_EQ(steps_until(steps(7)), 7u);
}

// Steps that double precision cannot add to its end.
TEST(Stage, IsNoLongerThanItsStepsReach) {
  const Description endless = seconds(1e14);
  for (const Description& until : {endless, Description{{"type", "all"}, {"of", {endless, steps(3)}}},
                                   Description{{"type", "any"}, {"of", {endless, seconds(2e14)}}}}) {
    EXPECT_THROW(run(lone(until, 1e15)), DescriptionError) << until;
    Description d = lone(steps(3));
    d["stages"].push_back(stage("wait", until));
    d["stages"][1]["limit"] = 1e15;
    EXPECT_THROW(run(d), DescriptionError) << "also of a later stage: " << until;
  }
  EXPECT_EQ(run(lone({{"type", "any"}, {"of", {endless, steps(2)}}}, 1e15)).summary().steps, 2u);

  Description stiff = lone(steps(3));
  stiff.erase("time_step");
  stiff["stages"].push_back(stage("load", seconds(0.5)));
  stiff["stages"][1]["change"]["materials"]["grain"]["contact_modulus"] = 1e33;
  const Done done = run(stiff);
  EXPECT_EQ(done.summary().status, "failed");
  EXPECT_EQ(done.summary().steps, 4u) << "when the step is known";
  EXPECT_THAT(done.summary().message, HasSubstr("stage \"load\": time never reaches 0.5"));
}

TEST(Stage, IsNoShorterThanHalfAStep) {
  const Description brief = seconds(0.4 * dt), rest = {{"type", "unbalanced-force"}, {"below", 0.1}};
  for (const Description& until : {brief, Description{{"type", "all"}, {"of", {brief, seconds(0.3 * dt)}}},
                                   Description{{"type", "any"}, {"of", {rest, brief}}}}) {
    Description d = lone(steps(3));
    d["stages"].push_back(stage("tap", until));
    const Done done = run(d);
    EXPECT_EQ(done.summary().status, "failed") << until;
    EXPECT_EQ(done.summary().steps, 3u);
    EXPECT_THAT(done.summary().message,
                HasSubstr("stage \"tap\" lasts 4e-06 s, less than half of the time step of 1e-05 "
                          "s, so that it would take no step; give it more time "
                          "(/stages/1/until) or a shorter step (/time_step)"));
  }
  EXPECT_EQ(steps_until(seconds(0.6 * dt)), 1u);
  EXPECT_EQ(steps_until({{"type", "all"}, {"of", {brief, steps(2)}}}), 2u);
}

TEST(Stage, CountsFromItsOwnStart) {
  Description d = lone(steps(30));
  d["stages"].push_back(stage("second", seconds(2e-4)));
  d["stages"].push_back(stage("third", steps(5)));
  const Done done = run(d);
  EXPECT_EQ(done.summary().status, "done");
  EXPECT_THAT(done.notes.ended_at, ElementsAre(30, 50, 55));
  EXPECT_EQ(done.summary().stage, "third");
}

TEST(Stage, EndsAtADisplacementInTheDirectionOfItsSign) {
  for (const double sign : {1.0, -1.0}) {
    Description d = lone({{"type", "displacement"}, {"wall", "floor"}, {"axis", "x"}, {"value", sign * 0.9995e-4}});
    d["walls"]["floor"]["motion"]["velocity"] = {sign * 0.1, 0, 0};
    const Done done = run(d);
    EXPECT_EQ(done.summary().steps, 100u);
    EXPECT_NEAR(done.kernel->world().walls()[0].position.x(), sign * 1e-4, 1e-12);
    // One with both directions possible moves in the other.
    d["walls"]["floor"]["motion"] = {{"free", {{"axes", "x"}, {"mass", 1}, {"load", {-sign * 100, 0, 0}}}}};
    d["stages"][0]["limit"] = 2e-3;
    EXPECT_EQ(run(d).summary().status, "failed");
  }
}

TEST(Stage, EndsAtAPressureWithinItsBand) {
  Description d = lone({{"type", "pressure"}, {"wall", "floor"}, {"value", 1e3}, {"within", 0.02}});
  d["bodies"]["grains"]["source"]["bodies"][0]["position"] = {0, 0, radius};
  d["engines"]["hold"] = {{"type", "hold"}, {"translation", "xyz"}};
  d["walls"]["floor"]["motion"]["velocity"] = {0, 0, 1e-2};
  const Done done = run(d);
  // E R u / A = 1e8 Pa/m · u: 980 Pa are reached 9.8 µm up, after 98 steps; rounding may take one more.
  EXPECT_NEAR(static_cast<double>(done.summary().steps), 98, 1);
  EXPECT_NEAR(done.kernel->world().walls()[0].pressure, 980, 10.001);
  d["stages"][0]["until"]["value"] = 0;
  EXPECT_EQ(run(d).summary().steps, 0u) << "no pressure is reached at once";
}

/// Conditions evaluated every hundred steps: met at the end, and not a hundred steps before.
template <class Measure>
void expect_first_look_below(const Description& d, double limit, Measure measure) {
  const Done done = run(d);
  ASSERT_EQ(done.summary().status, "done") << done.summary().message;
  ASSERT_GE(done.summary().steps, 200u);
  EXPECT_EQ(done.summary().steps % 100, 0u);
  EXPECT_LT(measure(*done.kernel), limit);
  Description shorter = d;
  shorter["stages"][0]["until"] = steps(static_cast<int>(done.summary().steps) - 100);
  const double look_before = measure(*run(shorter).kernel);
  EXPECT_GE(look_before, limit);
  EXPECT_LT(std::abs(look_before - limit), 0.5 * std::abs(limit))
      << "slow enough to distinguish this limit from twice the limit";
}

/// Evaluations of a condition "below" for the dropped grain, and the end of the stage with a limit just above one of
/// the values and just below.
template <class Measure>
void expect_rest_seen(const char* type, Measure measure) {
  double lowest = std::numeric_limits<double>::infinity();
  int records = 0;
  for (int looks = 1; records < 3; ++looks) {
    ASSERT_LT(looks, 20);
    const double look = measure(*run(dropped(steps(100 * looks))).kernel);
    if (look >= lowest) continue;
    lowest = look, ++records;
    const auto ends = [&](double limit) { return run(dropped({{"type", type}, {"below", limit}})).summary().steps; };
    EXPECT_EQ(ends(look * (1 + 1e-9)), 100u * static_cast<unsigned>(looks));
    EXPECT_GT(ends(look * (1 - 1e-9)), 100u * static_cast<unsigned>(looks));
  }
}

TEST(Stage, EndsAtRest) {
  expect_rest_seen("unbalanced-force", [](const Kernel& k) { return equilibrium(k.world()).unbalanced_force; });
  expect_rest_seen("kinetic-energy", [](const Kernel& k) { return k.kinetic_energy_ratio(); });
}

TEST(Stage, IsNotAtRestWithoutContacts) {
  Description d = lone(
      {{"type", "any"},
       {"of",
        {steps(250), {{"type", "unbalanced-force"}, {"below", 1e9}}, {{"type", "kinetic-energy"}, {"below", 1e9}}}}});
  EXPECT_EQ(run(d).summary().steps, 250u) << "free flight is not rest";
}

TEST(Stage, OfGrainsInFlightIsNotAtRest) {
  // One grain lies on the floor, nine fall.
  Description d = lone({{"type", "any"}, {"of", {steps(250), {{"type", "at-rest"}, {"below", 0.5}}}}});
  auto& grains = d["bodies"]["grains"]["source"]["bodies"];
  const auto lowest = [&](double z) { grains[0]["position"] = {0, 0, z}; };
  lowest(radius - 9.81 * mass / (modulus * radius));  // the floor carries it
  for (int k = 1; k < 10; ++k) grains.push_back({{"position", {0.01 * k, 0, 0.05}}, {"radius", radius}});
  d["engines"]["gravity"] = {{"type", "gravity"}};
  EXPECT_EQ(run(d).summary().steps, 250u);

  d["stages"][0]["until"] = {{"type", "unbalanced-force"}, {"below", 10}};
  EXPECT_THAT(run(d).notes.ended.front(), HasSubstr("so that grains are in flight: the condition \"at-rest\""));
}

TEST(Stage, OfGrainsThatSinkIsNotAtRest) {
  // Drag balances the weight, so that no net force is left.
  Description d = lone({{"type", "any"}, {"of", {steps(20000), {{"type", "at-rest"}, {"below", 0.5}}}}});
  d["bodies"]["grains"]["source"]["bodies"][0]["position"] = {0, 0, 1};
  d["engines"]["gravity"] = {{"type", "gravity"}};
  d["engines"]["oil"] = {{"type", "drag"}, {"viscosity", 1.0}, {"law", "stokes"}};
  EXPECT_EQ(run(d).summary().steps, 20000u);
}

TEST(Stage, GrainAtRestEndsIt) {
  const RunSummary summary = run(dropped({{"type", "at-rest"}, {"below", 0.01}})).summary();
  EXPECT_EQ(summary.status, "done");
  EXPECT_EQ(summary.steps % 100, 0u);
}

TEST(Stage, EndsOnTheClockOfTheRun) {
  Description d = lone(seconds(1.004e-3));
  d["stages"] = Description::array();
  for (int k = 0; k < 100; ++k) d["stages"].push_back(stage(("s" + std::to_string(k)).c_str(), seconds(1.004e-3)));
  EXPECT_EQ(run(d).summary().steps, 10040u) << "100 times 100.4 steps";
  d["stages"].push_back(stage("steps", steps(3)));
  d["stages"].push_back(stage("last", seconds(1e-3)));
  EXPECT_EQ(run(d).summary().steps, 10143u) << "a stage by steps ends where it does";
}

TEST(Stage, MayBeginWithoutBodies) {
  Description d = lone(seconds(1e-3));
  d["time_step"] = Description::object();
  d["stages"].push_back(stage("grains", seconds(1e-3)));
  d["bodies"]["grains"]["stage"] = "grains";
  EXPECT_EQ(run(d).summary().status, "done");
  d["bodies"]["grains"]["stage"] = "only";
  EXPECT_EQ(run(d).summary().status, "done") << "all groups begin with the first stage";
}

TEST(Stage, WithAGroupAboveThePrescribedStepIsRefusedBefore) {
  Description d = lone(seconds(1e-3));
  d["stages"].push_back(stage("small", seconds(1e-3)));
  d["bodies"]["small"] = d["bodies"]["grains"];
  d["bodies"]["small"]["stage"] = "small";
  d["bodies"]["small"]["source"]["bodies"][0] = {{"position", {0, 0, 0.1}}, {"radius", 1e-5}};
  try {
    run(d);
    FAIL() << "accepted";
  } catch (const DescriptionError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/time_step/value: the time step 1e-05 s is above the critical one of group "
                                        "\"small\" in stage \"small\", "));
  }
}

TEST(Stage, EndsAtAVoidRatio) {
  const auto e = [](const Kernel& k) { return void_ratio(k.world(), k.world().specimen()); };
  const double start = 1e-6 / (mass / density) - 1;
  expect_first_look_below(shrinking({{"type", "void-ratio"}, {"below", 0.9 * start}}, -20), 0.9 * start, e);
  expect_first_look_below(shrinking({{"type", "void-ratio"}, {"above", 1.1 * start}}, 20), -1.1 * start,
                          [&](const Kernel& k) { return -e(k); });
}

TEST(Stage, EndsWhenAllOrAnyHold) {
  EXPECT_EQ(steps_until({{"type", "all"}, {"of", {steps(20), seconds(5e-4)}}}), 50u);
  EXPECT_EQ(steps_until({{"type", "any"}, {"of", {steps(20), seconds(5e-4)}}}), 20u);
  EXPECT_EQ(steps_until({{"type", "all"}, {"of", {steps(20), {{"type", "any"}, {"of", {steps(60), steps(40)}}}}}}),
            40u);
}

TEST(Stage, ReportsWhichOfItsConditionsEndedIt) {
  const auto told = [](const Description& until) { return run(lone(until)).notes.ended.at(0); };
  const auto any = [](const Description& of) { return Description{{"type", "any"}, {"of", of}}; };
  const auto all = [](const Description& of) { return Description{{"type", "all"}, {"of", of}}; };
  using testing::StartsWith;
  EXPECT_THAT(told(any({steps(20), seconds(5e-4)})), StartsWith("by steps, "));
  EXPECT_THAT(told(any({steps(60), seconds(5e-4)})), StartsWith("by time, "));
  EXPECT_THAT(told(any({steps(60), all({steps(30), seconds(4e-4)})})), StartsWith("by steps and time, "));
  EXPECT_THAT(told(all({steps(20), any({steps(60), seconds(4e-4)})})), StartsWith("by steps and time, "));
  for (const Description& sure : {steps(20), all({steps(20), seconds(1e-4)}), any(Description::array({steps(20)}))})
    EXPECT_THAT(told(sure), testing::Not(StartsWith("by "))) << "there was no alternative";
}

TEST(Stage, ReportsProgress) {
  Started started(scene_of(lone({{"type", "all"}, {"of", {steps(20), seconds(5e-4)}}})));
  auto& [scene, live, kernel] = started;
  kernel.find_forces();
  for (int i = 0; i < 10; ++i) kernel.advance(), kernel.find_forces();
  EXPECT_NEAR(*progress(scene.description->stages[0].until, kernel, {}), 0.2, 1e-12);
}

TEST(Stage, ReportsNoProgressWhileItWaitsForRestOnly) {
  const Description rest = {{"type", "unbalanced-force"}, {"below", 1e-3}};
  const auto far = [&](const Description& until, int steps_gone) {
    Started started(scene_of(lone(until)));
    auto& [scene, live, kernel] = started;
    kernel.find_forces();
    for (int i = 0; i < steps_gone; ++i) kernel.advance(), kernel.find_forces();
    return progress(scene.description->stages[0].until, kernel, {});
  };
  const Description settled = {{"type", "all"}, {"of", {steps(20), rest}}};
  EXPECT_NEAR(far(settled, 10).value(), 0.5, 1e-12);
  EXPECT_FALSE(far(settled, 20).has_value());
  EXPECT_NEAR(far({{"type", "any"}, {"of", {settled, steps(40)}}}, 30).value(), 0.75, 1e-12);
}

TEST(Stage, ThatNeverEndsFails) {
  Description d = lone(steps(1000000), 0.9995e-3);
  d["stages"].push_back(stage("never begun", steps(1)));
  const Done done = run(d);
  EXPECT_EQ(done.summary().status, "failed");
  EXPECT_EQ(done.summary().steps, 100u);
  EXPECT_THAT(
      done.summary().message,
      testing::AllOf(HasSubstr("stage \"only\" did not end within its limit of 0.0009995 s: 100 of 1000000 steps ("),
                     HasSubstr("time 0.001 s"),
                     HasSubstr("give it more time (/stages/0/limit) or a condition that it can reach")));
  EXPECT_EQ(done.notes.finished, 1);
  EXPECT_THAT(done.notes.ended, testing::IsEmpty());
}

TEST(Stage, ThatWaitsForGrainsWithoutAFloorSaysSo) {
  const Description rest = {{"type", "at-rest"}};
  const auto told = [](const Description& until, const Vec3& gravity) {
    Description d = lone(until, 0.0999);
    d["engines"]["gravity"] = {{"type", "gravity"}, {"acceleration", vector(gravity)}};
    return run(d).summary().message;
  };
  EXPECT_THAT(told(rest, {0, 0, 10}), testing::AllOf(HasSubstr("1 of 1 bodies have no contact and fall, at up to "),
                                                     HasSubstr(" m/s: is there a floor below them, and does gravity "
                                                               "point towards it?"),
                                                     testing::Not(HasSubstr("give it more time"))));
  EXPECT_THAT(told(rest, Vec3::Zero()), HasSubstr("without gravity or another force (/engines) bodies do not come"));
  EXPECT_THAT(told(steps(1000000), {0, 0, 10}), HasSubstr("give it more time")) << "steps need no floor";
}

TEST(Stage, ReportsUnmetConditions) {
  const auto told = [](Description d, const Description& until) {
    d["stages"][0]["until"] = until, d["stages"][0]["limit"] = 0.9995e-3;
    const std::string message = run(d).summary().message, begin = "its limit of 0.0009995 s: ";
    return message.substr(message.find(begin) + begin.size(), message.find(" (") - message.find(begin) - begin.size());
  };
  const Description move{{"type", "displacement"}, {"wall", "floor"}, {"axis", "x"}, {"value", 1e-3}},
      press{{"type", "pressure"}, {"wall", "floor"}, {"value", 5e3}, {"within", 0.02}},
      rest{{"type", "unbalanced-force"}, {"below", 0.003}}, calm{{"type", "kinetic-energy"}, {"below", 1e-4}},
      left{{"type", "discharged"}, {"fraction", 0.25}}, loose{{"type", "void-ratio"}, {"above", 500}, {"below", 600}},
      stress{{"type", "mean-stress"}, {"above", 2e4}},
      along{{"type", "stress"}, {"component", "yy"}, {"value", 3e4}, {"within", 0.05}};
  Description moving = lone(steps(1));
  moving["walls"]["floor"]["motion"]["velocity"] = {0.2, 0, 0};
  moving["domain"] = {{"low", {-1, -1, -1}}, {"high", {1, 1, 1}}, {"open_sides", {"-z"}}};
  Description swinging = moving;  // how far it moves only the run knows
  swinging["walls"]["floor"]["motion"]["oscillation"] = {{"amplitude", {1e-12, 0, 0}}, {"frequency", 1}};
  EXPECT_EQ(told(swinging, move), "displacement of wall \"floor\" along x 0.0002 of 0.001 m");
  EXPECT_EQ(told(moving, {{"type", "any"}, {"of", {seconds(1), steps(200)}}}),
            "either time 0.001 of 1 s or 100 of 200 steps");
  EXPECT_EQ(told(moving, {{"type", "all"}, {"of", {seconds(5e-4), press, rest}}}),
            "pressure on wall \"floor\" 0 Pa, required 5000 Pa ± 2 %; "
            "unbalanced force undefined: no contact forces")
      << "the time is over and not reported";
  EXPECT_EQ(
      told(moving, {{"type", "any"}, {"of", {calm, left}}}),
      "either kinetic over elastic energy inf, required below 0.0001 or 0 % of the mass discharged, required 25 %");
  EXPECT_EQ(told(shrinking(steps(1), -20), loose), "void ratio of the interior 233, required above 500 and below 600");
  EXPECT_EQ(told(shrinking(steps(1), -20), stress), "mean stress 0 Pa, required above 2e+04 Pa");
  EXPECT_EQ(told(shrinking(steps(1), -20), along), "stress yy 0 Pa, required 3e+04 Pa ± 5 %");
  const Description still{{"type", "at-rest"}, {"below", 1e-9}};
  EXPECT_EQ(told(moving, still), "no force acts on the bodies, and no contact carries one yet");
  Description falling = dropped(steps(1));
  EXPECT_THAT(told(falling, still), testing::MatchesRegex("net forces [0-9.e-]+ of loads and contact forces, required "
                                                          "below 1e-09, contacts carry [0-9.]+ of the load, required "
                                                          "0.5"));
  falling["bodies"]["grains"]["source"]["bodies"][0]["position"] = {0, 0, 2 * radius};
  EXPECT_EQ(told(falling, still), "no contact carries load yet");
  EXPECT_THAT(told(dropped(steps(1)), rest), testing::MatchesRegex("unbalanced force [0-9.e-]+, required below 0.003"));
}

TEST(Stage, MustReachWhatIsExpected) {
  Description d = shrinking(steps(10), -20);
  d["stages"][0]["expect"] = {{"void_ratio", 0.6}, {"within", 0.02}};
  d["stages"].push_back(stage("never begun", steps(1)));
  Done done = run(d);
  EXPECT_EQ(done.summary().status, "failed");
  EXPECT_THAT(done.summary().message,
              testing::StartsWith("stage \"only\" was to end at a void ratio of 0.6 ± 0.02 and reached 237.3; "));
  EXPECT_EQ(done.summary().steps, 10u);
  d["stages"][0]["expect"]["void_ratio"] = 237.3;
  d["stages"][0]["expect"]["within"] = 0.1;
  EXPECT_EQ(run(d).summary().status, "done");
}

TEST(Stage, ChangeTakesEffectAndStays) {
  Description d = lone(steps(10));
  d["stages"].push_back(stage("fall", steps(10)));
  d["stages"][1]["change"]["engines"]["gravity"] = {{"type", "gravity"}, {"acceleration", {0, 0, -10}}};
  d["stages"].push_back(stage("fall on", steps(10)));
  d["stages"].push_back(stage("fly", steps(10)));
  d["stages"][3]["change"]["engines"]["gravity"] = nullptr;
  d["probes"]["speed"] = {{"type", "watch"}, {"every_steps", 10}};
  watched() = [](const World& w) { return w.velocities()[0].z; };
  // The step before the change ends half a step before it: ten kicks in ten steps.
  const auto speeds = run(d).notes.values_of("speed");
  ASSERT_EQ(speeds.size(), 5u);
  const double expected[] = {0, 0, -1e-3, -2e-3, -2e-3};
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(speeds[static_cast<std::size_t>(i)], expected[i], 1e-15) << i;
}

TEST(Stage, RampsAdvanceInIncrementsOneAfterTheOther) {
  Description d = lone(steps(30));
  d["stages"][0]["ramps"] = {
      {{"pointer", "/walls/floor/motion/velocity/0"}, {"from", 0}, {"to", 4}, {"duration", 16 * dt}, {"increments", 4}},
      {{"pointer", "/walls/floor/motion/velocity/0"},
       {"from", 4},
       {"to", 10},
       {"duration", 4 * dt},
       {"increments", 2}}};
  d["probes"]["speed"] = {{"type", "watch"}, {"every_steps", 1}};
  watched() = [](const World& w) { return w.walls()[0].velocity.x(); };
  std::vector<double> expected;  // of the completed step
  for (int step = 0; step <= 30; ++step) {
    const int began = step - 1;
    expected.push_back(began < 4 ? 0 : began < 16 ? began / 4 : began < 18 ? 4 : began < 20 ? 7 : 10);
  }
  EXPECT_EQ(run(d).notes.values_of("speed"), expected);
}

TEST(Stage, BoundaryChangesNothing) {
  Description whole = description("linear-rolling", {{"contact_modulus", 1e6}}, jumble({4, 4, 4}, 1e-3, 0.1, 8));
  whole["time_step"]["value"] = 2e-6;
  whole["stages"] = Description::array({stage("all", steps(60))});
  Description halves = whole;
  halves["stages"] = Description::array();
  for (int i = 0; i < 6; ++i) halves["stages"].push_back(stage(std::to_string(i).c_str(), steps(10)));
  const Done one = run(whole), six = run(halves);
  double largest = 0, apart = 0;
  for (std::uint32_t id = 0; id < 64; ++id) {
    const auto row = [&](const Done& d) { return xyz(d.kernel->world().spins()[index_of(d.kernel->world(), id)]); };
    largest = std::max(largest, row(one).norm()), apart = std::max(apart, (row(one) - row(six)).norm());
  }
  EXPECT_LT(apart, 1e-10 * largest) << "only the order of sums differs";
}

TEST(Reports, ComeAtTheirCadence) {
  Description d = lone(steps(10));
  d["stages"].push_back(stage("second", steps(8)));
  d["probes"]["steps"] = {{"type", "watch"}, {"every_steps", 4}};
  d["probes"]["time"] = {{"type", "watch"}, {"every_time", 2.4 * dt}};
  d["probes"]["second"] = {{"type", "watch"}, {"every_steps", 4}, {"stages", {"second"}}};
  d["probes"]["ends"] = {{"type", "watch"}};
  d["output"]["frames"]["every_steps"] = 6;
  const Done done = run(d);
  EXPECT_THAT(done.notes.steps_of("steps"), ElementsAre(0, 4, 8, 10, 14, 18));
  EXPECT_THAT(done.notes.steps_of("time"), ElementsAre(0, 2, 5, 7, 10, 12, 15, 17, 18));
  EXPECT_THAT(done.notes.steps_of("second"), ElementsAre(10, 14, 18));
  EXPECT_THAT(done.notes.steps_of("ends"), ElementsAre(10, 18));
  EXPECT_THAT(done.notes.frames, ElementsAre(0, 6, 10, 16, 18)) << "at their cadence and at the end of every stage";
  EXPECT_EQ(done.notes.begun, 1);
  EXPECT_EQ(done.notes.finished, 1);
  d["output"].erase("frames");
  EXPECT_THAT(run(d).notes.frames, testing::IsEmpty());
  d["output"]["frames"]["formats"] = Description::array({"vtk"});
  EXPECT_THAT(run(d).notes.frames, ElementsAre(18)) << "at the end of the run";
}

TEST(Reports, ComeByDisplacementOfAWall) {
  // Forward for four steps, then back, by 0.01 mm each.
  Description d = lone(steps(12));
  d["walls"]["floor"]["motion"]["velocity"] = {1, 0, 0};
  d["stages"][0]["ramps"] = {{{"pointer", "/walls/floor/motion/velocity/0"},
                              {"from", 1},
                              {"to", -1},
                              {"duration", 4 * dt},
                              {"increments", 1}}};
  const auto every = [](double metres) {
    return Description{{"type", "watch"}, {"every_displacement", {{"wall", "floor"}, {"value", metres}}}};
  };
  d["probes"]["two"] = every(2e-5);
  d["probes"]["three"] = every(3e-5);
  d["probes"]["half"] = every(0.5e-5);
  d["probes"]["far"] = every(1);
  d["probes"]["aside"] = every(1e-5);
  d["probes"]["aside"]["every_displacement"]["axis"] = "y";
  d["output"]["frames"]["every_displacement"] = {{"wall", "floor"}, {"value", 4e-5}};
  watched() = [](const World& w) { return std::round(1e5 * w.walls()[0].position.x()); };
  const Done done = run(d);
  EXPECT_THAT(done.notes.values_of("two"), ElementsAre(0, 2, 4, 2, 0, -2, -4));
  EXPECT_THAT(done.notes.steps_of("two"), ElementsAre(0, 2, 4, 6, 8, 10, 12));
  EXPECT_THAT(done.notes.steps_of("three"), ElementsAre(0, 3, 8, 11, 12)) << "one back is not three";
  EXPECT_THAT(done.notes.steps_of("half"), ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12));
  EXPECT_THAT(done.notes.steps_of("far"), ElementsAre(0, 12));
  EXPECT_THAT(done.notes.steps_of("aside"), ElementsAre(0, 12));
  EXPECT_THAT(done.notes.frames, ElementsAre(0, 4, 8, 12));
}

TEST(Reports, ComeByDisplacementOfAWallAgainInEachStage) {
  Description d = lone(steps(5));
  d["stages"].push_back(stage("second", steps(5)));
  d["walls"]["floor"]["motion"]["velocity"] = {1, 0, 0};
  d["probes"]["three"] = {{"type", "watch"}, {"every_displacement", {{"wall", "floor"}, {"value", 3e-5}}}};
  EXPECT_THAT(run(d).notes.steps_of("three"), ElementsAre(0, 3, 5, 8, 10));
}

/// Five grains that leave the domain one after the other.
Description five_leave() {
  Description d = lone(seconds(8e-3));
  d.erase("walls");
  d["domain"] = {{"low", {-0.01, -0.01, -0.01}}, {"high", {0.01, 0.01, 0.01}}, {"open_sides", {"-z"}}};
  auto& grains = d["bodies"]["grains"]["source"]["bodies"] = Description::array();
  for (int i = 0; i < 5; ++i)
    grains.push_back(
        {{"position", {-8e-3 + 4e-3 * i, 0, -0.009 + 1e-3 * i}}, {"radius", radius}, {"velocity", {0, 0, -1}}});
  return d;
}

TEST(Reports, ComeByDischargedMass) {
  Description d = five_leave();
  d["probes"]["each"] = {{"type", "watch"}, {"every_discharged", 0.2}};
  d["probes"]["two"] = {{"type", "watch"}, {"every_discharged", 0.4}};
  d["probes"]["all"] = {{"type", "watch"}, {"every_discharged", 1}};
  watched() = [](const World& w) { return static_cast<double>(w.ids().size()); };
  const Done done = run(d);
  EXPECT_THAT(done.notes.values_of("each"), ElementsAre(5, 4, 3, 2, 1, 0, 0)) << "and at the end of the stage";
  EXPECT_THAT(done.notes.values_of("two"), ElementsAre(5, 3, 1, 0));
  EXPECT_THAT(done.notes.values_of("all"), ElementsAre(5, 0, 0));
}

TEST(Reports, ComeAtTheSameStepsWithOtherObservers) {
  Description d = five_leave();
  d["probes"]["each"] = {{"type", "watch"}, {"every_discharged", 0.2}};
  d["output"]["frames"]["every_discharged"] = 0.4;
  const Done alone = run(d);
  d["probes"]["always"] = {{"type", "watch"}, {"every_steps", 1}};
  const Done beside = run(d);
  EXPECT_EQ(alone.notes.steps_of("each").size(), 7u);
  EXPECT_EQ(alone.notes.steps_of("each"), beside.notes.steps_of("each"));
  EXPECT_EQ(alone.notes.frames.size(), 4u);
  EXPECT_EQ(alone.notes.frames, beside.notes.frames);
}

TEST(Reports, FramesHaveFieldsOfProbesThatSampleTheirStage) {
  Description d = lone(steps(10));
  d["stages"].push_back(stage("second", steps(8)));
  d["probes"]["always"] = {{"type", "watch"}};
  d["probes"]["first"] = {{"type", "watch"}, {"stages", {"only"}}};
  d["probes"]["second"] = {{"type", "watch"}, {"stages", {"second"}}};
  d["probes"]["unseen"] = {{"type", "watch"}, {"frames", false}};
  d["output"]["frames"]["every_steps"] = 6;
  const Done done = run(d);
  EXPECT_THAT(done.notes.frames, ElementsAre(0, 6, 10, 16, 18));
  const auto in_first = ElementsAre("always", "first"), in_second = ElementsAre("always", "second");
  EXPECT_THAT(done.notes.mapped, ElementsAre(in_first, in_first, in_second, in_second, in_second));
}

TEST(Reports, ChangeNoBitAtAnyInterval) {
  Description d = description("linear-rolling", {{"contact_modulus", 1e6}}, jumble({4, 4, 4}, 1e-3, 0.1, 8));
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["walls"]["floor"]["motion"]["velocity"] = {1, 0, 0};
  d["time_step"]["value"] = 2e-6;
  d["stages"] = Description::array({stage("all", steps(200))});
  const Done unseen = run(d);
  d["probes"]["way"] = {{"type", "watch"}, {"every_displacement", {{"wall", "floor"}, {"value", 7e-6}}}};
  d["probes"]["left"] = {{"type", "watch"}, {"every_discharged", 0.1}};
  watched() = [](const World& w) { return w.time(); };
  const Done seen = run(d);
  EXPECT_GT(seen.notes.steps_of("way").size(), 50u);
  for (std::uint32_t id = 0; id < 64; ++id) {
    const auto row = [&](const Done& of) {
      return xyz(of.kernel->world().positions()[index_of(of.kernel->world(), id)]);
    };
    EXPECT_EQ(row(unseen), row(seen)) << id;
  }
}

TEST(Reports, ContainSummaryAndStages) {
  const Done done = run(dropped(steps(40)));
  EXPECT_EQ(done.summary().bodies, 1u);
  EXPECT_EQ(done.summary().time_step, dt);
  EXPECT_GT(done.summary().critical_time_step, dt);
  EXPECT_NEAR(done.summary().time, 40 * dt, 1e-15);
  EXPECT_EQ(done.summary().threads, 1u);
  EXPECT_GT(done.summary().rebuilds, 0u);
  ASSERT_EQ(done.notes.ended.size(), 1u);
  EXPECT_THAT(done.notes.ended[0], testing::MatchesRegex("unbalanced force [0-9.e-]+, time 0.0004 s"));
}

TEST(Reports, AnInterruptedRunEndsAtOnceAndComplete) {
  bool interrupted = false;
  const auto until_interrupted = [&](Simulation& simulation) {
    simulation.interrupt_when([&] { return interrupted; });
  };
  Description d = dropped(steps(1000));
  d["probes"]["stop"] = {{"type", "watch"}, {"every_steps", 1}};
  d["output"]["frames"]["every_steps"] = 1000;
  watched() = [&](const World& w) { return interrupted = w.step() == 120, 0.0; };
  const Done done = run(d, until_interrupted);
  EXPECT_EQ(done.summary().status, "interrupted");
  EXPECT_EQ(done.summary().message, "");
  // Interrupted during a step, it ends with the next: it can be resumed only between two steps.
  EXPECT_EQ(done.summary().steps, 121u);
  EXPECT_EQ(done.notes.steps_of("stop").back(), 121u);
  EXPECT_THAT(done.notes.frames, ElementsAre(0, 121));
  EXPECT_THAT(done.notes.ended, testing::IsEmpty()) << "the stage did not end";
  ASSERT_EQ(done.kernel->world().contacts().size(), 1u);
  EXPECT_NEAR(done.kernel->world().contacts()[0].overlap, radius - done.kernel->world().positions()[0].z, 1e-18)
      << "positions and forces are of one instant";

  watched() = {};
  interrupted = true;
  EXPECT_EQ(run(d, until_interrupted).summary().steps, 0u);
}

}  // namespace
}  // namespace grit::test::stages_tests
