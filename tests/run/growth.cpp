// Bodies that grow during a stage.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "grit/error.hpp"
#include "support/clump.hpp"
#include "support/notes.hpp"
#include "support/packing.hpp"

namespace grit::test::growth_tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double radius = 1e-3, modulus = 1e7, density = 2600, rate = 20, dt = 1e-6;

double volume(double r) { return 4.0 / 3 * std::numbers::pi * r * r * r; }
Description steps(int n) { return {{"type", "steps"}, {"value", n}}; }

/// Grows in its only stage.
Description growing(Description d, double how_fast = rate) {
  d["stages"][0]["growth"]["rate"] = how_fast;
  return d;
}

/// Two equal grains whose surfaces are `gap` apart and whose centres are held.
Description two(double gap, const std::string& law = "linear-rolling") {
  Description d =
      description(law, {{"density", density}}, {{Vec3::Zero(), radius}, {Vec3(2 * radius + gap, 0, 0), radius}});
  if (law == "linear-rolling") d["materials"]["grain"]["contact_modulus"] = modulus;
  d["engines"]["hold"] = {{"type", "hold"}, {"translation", "xyz"}};
  d["time_step"]["value"] = dt;
  return growing(d);
}

/// A trial in its first stage.
struct Grown : Trial {
  explicit Grown(const Description& d, unsigned threads = 1, StateRequest state = {}) : Trial(d, threads, state) {
    begin_stage(0, scene().description->stages[0].name);
    kernel().find_forces();
  }
  double radius_of(std::uint32_t id) const { return world().positions()[index_of(world(), id)].w; }
};

TEST(Growth, RaisesRadiusMassAndInertiaTogether) {
  Grown trial(two(0.5 * radius));
  trial.step(1000);
  const double r = radius * std::exp(rate * 1000 * dt), m = density * volume(r);
  for (const std::uint32_t id : {0u, 1u}) {
    EXPECT_NEAR(trial.radius_of(id), r, 1e-12 * r);
    EXPECT_NEAR(trial.mass(id), m, 1e-11 * m);
    EXPECT_NEAR(1 / trial.world().spins()[id].w, 0.4 * m * r * r, 1e-11 * m * r * r);
  }
  EXPECT_NEAR(trial.world().mean_diameter(), 2 * r, 1e-12 * r);
  EXPECT_NEAR(trial.world().solid_density(), density, 1e-9);
}

TEST(Growth, BringsTwoGrainsIntoContactAccordingToTheirLaw) {
  const double gap = 0.02 * radius, distance = 2 * radius + gap;
  Grown trial(two(gap));
  // r = distance / 2 after ln(1.01) / rate, not necessarily at the end of a step.
  const auto touching = static_cast<std::size_t>(std::ceil(std::log(1.01) / rate / dt));
  trial.step(touching - 1);
  EXPECT_TRUE(trial.world().contacts().empty());
  trial.step(1);
  ASSERT_EQ(trial.world().contacts().size(), 1u);
  trial.step(500);
  const double r = trial.radius_of(0), overlap = 2 * r - distance;
  ASSERT_GT(overlap, 0.01 * radius);
  const Contact& contact = trial.world().contacts()[0];
  EXPECT_NEAR(contact.overlap, overlap, 1e-9 * overlap);
  EXPECT_NEAR(contact.normal_force, modulus * r * overlap, 1e-9 * contact.normal_force);  // Kn = E R of equal grains
  const double push = (contact.a == index_of(trial.world(), 0) ? -1 : 1) * contact.force.x();
  EXPECT_NEAR(push, -contact.normal_force, 1e-12 * contact.normal_force);
}

TEST(Growth, PressesAgainstWallsToo) {
  Description d = two(radius);
  d["walls"]["floor"] = plane(Vec3(0, 0, -1.01 * radius), Vec3::UnitZ());
  d["walls"]["floor"]["area"] = 1e-4;
  Grown trial(d);
  trial.step(1000);
  const double r = trial.radius_of(0), force = 2 * modulus * r * (r - 1.01 * radius);
  EXPECT_NEAR(-trial.world().walls()[0].force.z(), force, 1e-9 * force);
}

TEST(Growth, LastsAsLongAsItsStage) {
  Description d = two(radius);
  d["stages"][0]["until"] = steps(100);
  Description rest = {{"name", "rest"}, {"until", steps(50)}, {"limit", 1}}, again = rest;
  again["name"] = "again", again["growth"]["rate"] = 2 * rate;
  d["stages"].push_back(rest), d["stages"].push_back(again);
  d["probes"]["watch"] = {{"type", "watch"}};
  watched() = [](const World& w) { return w.positions()[0].w; };
  const Done done = run(d);
  ASSERT_EQ(done.summary().status, "done") << done.summary().message;
  const double first = radius * std::exp(100 * rate * dt), second = first * std::exp(50 * 2 * rate * dt);
  using testing::DoubleNear;
  EXPECT_THAT(done.notes.values_of("watch"),
              ElementsAre(DoubleNear(first, 1e-14), DoubleNear(first, 1e-14), DoubleNear(second, 1e-14)));
}

/// Grains or clumps between walls.
Description crowd(bool clumps, double how_fast = 30, const std::string& law = "linear-rolling") {
  const double spacing = 1e-3;
  const Vec3 low = Vec3::Zero(), high = Vec3::Constant(8 * spacing);
  const char* const stiffness = law == "hertz-mindlin" ? "young_modulus" : "contact_modulus";
  Description d = description(law, {{stiffness, law == "hertz-mindlin" ? 1e8 : 1e7}, {"density", density}},
                              jumble({8, 8, 8}, spacing, 0.01, 5));
  for (Description& grain : d["bodies"]["grains"]["source"]["bodies"])
    grain["radius"] = (clumps ? 1.0 : 0.9) * grain["radius"].get<double>();
  if (clumps) make_clumps(d, boomerang());
  const char* const names[3][2] = {{"left", "right"}, {"front", "back"}, {"bottom", "top"}};
  for (int axis = 0; axis < 3; ++axis)
    for (const bool up : {true, false})
      d["walls"][names[axis][up ? 0 : 1]] = side(axis, up ? low[axis] : high[axis], low, high, up);
  d["guards"] = {{"overlap", 0.9}, {"travel", 0.2}};
  return growing(d, how_fast);
}

TEST(Growth, FindsEachContact) {
  // They come into contact one after the other, far beyond the first skins, which growth alone uses up.
  Description d = crowd(false, 60);
  for (Description& grain : d["bodies"]["grains"]["source"]["bodies"])
    grain["radius"] = 0.6 * grain["radius"].get<double>(), grain.erase("velocity"), grain.erase("spin");
  Grown trial(d);
  EXPECT_EQ(trial.kernel().state().pairs.touching_count(), 0u);
  while (trial.world().mean_diameter() < 1.02e-3) {
    trial.step(20);
    const auto x = trial.world().positions();
    std::size_t touching = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) touching += (xyz(x[i]) - xyz(x[j])).norm() < x[i].w + x[j].w;
    ASSERT_EQ(trial.kernel().state().pairs.touching_count(), touching) << "step " << trial.world().step();
  }
  EXPECT_GT(trial.kernel().state().pairs.touching_count(), 600u) << "it reached a packing";
  EXPECT_GT(trial.kernel().state().lists.rebuilds(), 10u);
}

TEST(Growth, GivesTheSameBitsForAnyNumberOfThreadsAndObservers) {
  for (const bool clumps : {false, true}) {
    const Description d = crowd(clumps, clumps ? 100 : 30);
    Grown asked(d, 1);
    asked.step(1200);
    for (const unsigned threads : {1u, 3u, 4u}) {
      Grown other(d, threads);
      other.step_on(1200);
      ASSERT_TRUE(same_bits(asked.kernel(), other.kernel())) << threads << " threads";
    }
    EXPECT_GT(asked.kernel().state().pairs.touching_count(), clumps ? 60u : 600u) << "a packing";
  }
}

TEST(Growth, ScalesAClumpAsAWhole) {
  Description d = description("linear-rolling", {{"contact_modulus", modulus}, {"density", density}},
                              {{Vec3(1, 2, 3), radius, Vec3(0.1, 0, 0), Vec3(3, 5, 7)}});
  make_clumps(d, boomerang());
  d["time_step"]["value"] = dt;
  Grown trial(growing(d));
  const ClumpView before = trial.world().clumps()[0];
  const auto distances = [&] {
    std::vector<double> all;
    const auto x = trial.world().positions();
    for (std::size_t i = 0; i < x.size(); ++i) {
      all.push_back(x[i].w);
      for (std::size_t j = 0; j < i; ++j) all.push_back((xyz(x[i]) - xyz(x[j])).norm());
    }
    return all;
  };
  const auto lengths = distances();
  const double density_before = trial.world().solid_density();
  trial.step(1000);
  const ClumpView after = trial.world().clumps()[0];
  const double factor = std::exp(rate * 1000 * dt);
  for (std::size_t k = 0; const double length : distances())
    EXPECT_NEAR(length, factor * lengths[k++], 1e-9 * length) << "shape";
  EXPECT_NEAR(after.radius, factor * before.radius, 1e-12 * radius);
  EXPECT_NEAR(after.mass, std::pow(factor, 3) * before.mass, 1e-11 * after.mass);
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(after.inertia[k], std::pow(factor, 5) * before.inertia[k], 1e-11 * after.inertia[k]);
  EXPECT_NEAR(trial.world().solid_density(), density_before, 1e-9);
  // Added mass has the velocity of the clump: a free clump keeps its velocity and spin.
  EXPECT_NEAR((after.velocity - before.velocity).norm(), 0, 1e-15);
  const double turning =
      before.momentum.dot(before.axes * (before.axes.transpose() * before.momentum).cwiseQuotient(before.inertia));
  const double turning_after =
      after.momentum.dot(after.axes * (after.axes.transpose() * after.momentum).cwiseQuotient(after.inertia));
  EXPECT_NEAR(turning_after, std::pow(factor, 5) * turning, 1e-4 * turning_after);
  EXPECT_NEAR(after.centre.x(), 1 + 0.1 * 1000 * dt + (before.centre.x() - 1), 1e-9);
}

/// Closure error after 3 ms of growth, over the energy input.
double closure_of_growth(Description d, double safety, double friction_angle) {
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.2}};
  d["materials"]["grain"]["friction_angle"] = friction_angle;
  d["time_step"]["safety"] = safety;
  Grown trial(d, 1, BodyState::energy);
  trial.world().energies();
  while (trial.world().time() < 3e-3) trial.step();
  const Energies now = trial.world().energies();
  EXPECT_GT(now.settings, 10 * now.kinetic) << "growth is the only input";
  EXPECT_GT(now.elastic() + now.dissipated(), 0.9 * now.settings);
  return std::abs(now.closure_error) / now.settings;
}

TEST(Growth, EnergyBalanceContainsItsInput) {
  struct Case {
    const char* law;
    bool clumps;
  };
  for (const Case& c : {Case{"linear-rolling", false}, Case{"hertz-mindlin", false}, Case{"linear-rolling", true}}) {
    SCOPED_TRACE(std::string(c.law) + (c.clumps ? ", clumps" : ""));
    const Description d = crowd(c.clumps, c.clumps ? 100 : 30, c.law);
    // Clumps load shear at large and unload at small overlap: an error of 1e-3, independent of the step.
    const double friction_angle = c.clumps ? 0 : 0.3;
    const double coarse = closure_of_growth(d, 0.4, friction_angle), fine = closure_of_growth(d, 0.1, friction_angle);
    EXPECT_LT(coarse, 2e-3);
    EXPECT_LT(fine, 0.2 * coarse) << "the error is of second order in the time step";
  }
}

TEST(Growth, LengthensTheCriticalTimeStep) {
  Description d = two(radius);
  d["time_step"].erase("value");
  Grown trial(d);
  const double before = trial.kernel().critical_time_step();
  while (trial.radius_of(0) < 1.3 * radius) trial.step();
  // dt ∝ √(m / k) ∝ r; last evaluated a few percent of growth before.
  EXPECT_NEAR(trial.kernel().critical_time_step() / before, 1.3, 0.05);
}

TEST(Growth, EndsAtAVoidRatioOrAMeanStress) {
  Description d = crowd(false, 3);
  const Description box = {{"low", {"left", "front", "bottom"}}, {"high", {"right", "back", "top"}}};
  d["specimen"] = box;
  d["stages"][0]["until"] = {{"type", "void-ratio"}, {"below", 0.7}};
  d["stages"][0]["limit"] = 1;
  const auto void_ratio_of = [](const World& w) { return void_ratio(w, w.interior(w.mean_diameter())); };
  const Done dense = run(d);
  ASSERT_EQ(dense.summary().status, "done") << dense.summary().message;
  EXPECT_LT(void_ratio_of(dense.kernel->world()), 0.7);
  EXPECT_GT(void_ratio_of(dense.kernel->world()), 0.68);

  d["stages"][0]["until"] = {{"type", "mean-stress"}, {"above", 5e4}};
  const Done pressed = run(d);
  ASSERT_EQ(pressed.summary().status, "done") << pressed.summary().message;
  const auto mean = [](const World& w) { return mean_stress(w, w.interior(w.mean_diameter())).trace() / 3; };
  EXPECT_GT(mean(pressed.kernel->world()), 5e4);
  EXPECT_LT(mean(pressed.kernel->world()), 6e4);
  EXPECT_EQ(pressed.summary().steps % 10, 0u);
}

TEST(Growth, StopsIfItIsTooFast) {
  Description d = two(radius);
  d["guards"]["travel"] = 0.05;
  d["stages"][0]["growth"]["rate"] = 0.06 / dt;
  const Done done = run(d);
  EXPECT_EQ(done.summary().status, "failed");
  EXPECT_THAT(done.summary().message, HasSubstr("the largest body grows by 0.06184 of the smallest radius in one step, "
                                                "more than /guards/travel 0.05; reduce the growth rate of the stage"));
}

std::string refusal(const Description& d) {
  try {
    scene_of(d);
  } catch (const DescriptionError& error) {
    return error.what();
  }
  return "";
}

TEST(Growth, IsRefusedIfItMakesNoSense) {
  Description d = two(radius);
  EXPECT_EQ(refusal(d), "");
  d["stages"][0]["growth"] = {{"rate", "20 mm"}};
  EXPECT_THAT(refusal(d), HasSubstr("/stages/0/growth/rate"));
  d["stages"][0]["growth"] = {{"rate", -1}};
  EXPECT_THAT(refusal(d), HasSubstr("/stages/0/growth/rate: found -1 1/s; allowed is above 0 1/s"));
  d["stages"][0]["growth"] = Description::object();
  EXPECT_THAT(refusal(d), HasSubstr("/stages/0/growth: missing key \"rate\" [1/s]"));
  d = two(radius);
  d["engines"]["scaling"] = {{"type", "density-scaling"}, {"below", 3 * radius}};
  EXPECT_THAT(refusal(d),
              HasSubstr("/engines/scaling: found density scaling together with growth of bodies in a stage"));
  d = two(radius);
  d["stages"][0]["until"] = {{"type", "mean-stress"}};
  EXPECT_THAT(refusal(d), HasSubstr("found neither below nor above"));
}

}  // namespace
}  // namespace grit::test::growth_tests
