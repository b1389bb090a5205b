// Bodies that appear in a later stage.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <set>

#include "grit/error.hpp"
#include "support/clump.hpp"
#include "support/memories.hpp"
#include "support/notes.hpp"
#include "support/packing.hpp"

namespace grit::test::arrivals_tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double radius = 1e-3, modulus = 1e7, density = 2600;
constexpr double mass = density * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
const Description stuff{{"density", density}, {"contact_modulus", modulus}};

/// Grains, and others that appear in a second stage.
Description first_and_late(const std::vector<Grain>& first, const std::vector<Grain>& late) {
  Description d = description("linear-rolling", stuff, first);
  d["bodies"]["late"] = description("", {}, late)["bodies"]["grains"];
  d["bodies"]["late"]["stage"] = "second";
  d["stages"].push_back({{"name", "second"}, {"until", {{"type", "steps"}, {"value", 1}}}, {"limit", 1}});
  d["time_step"]["value"] = 2e-6;
  return d;
}
Description cloud(const Vec3& low, const Vec3& high, int count, double smallest, double largest) {
  return {{"type", "cloud"},
          {"low", vector(low)},
          {"high", vector(high)},
          {"count", count},
          {"sizes", {{"type", "uniform"}, {"smallest", smallest}, {"largest", largest}}}};
}
void begin_second(Trial& trial) { trial.begin_stage(1, "second"); }
std::vector<std::uint32_t> sorted_ids(const World& world) {
  std::vector<std::uint32_t> ids(world.ids().begin(), world.ids().end());
  std::ranges::sort(ids);
  return ids;
}

TEST(Arrivals, FallFromTheirPositionWithTheirVelocity) {
  const Vec3 place(0, 0, 9e-3), gravity(0, 0, -9.81), velocity(0.02, 0, 0.05), extra(0, 0.01, 0);
  Description d = first_and_late({{Vec3::Zero(), radius}}, {{place, radius, velocity, {0, 3, 0}}});
  d["bodies"]["late"]["velocity"] = vector(extra);
  d["engines"]["gravity"] = {{"type", "gravity"}};
  Trial trial(d);
  trial.step(137);
  begin_second(trial);
  const Vec3 start = velocity + extra;
  EXPECT_EQ(trial.position(1), place);
  EXPECT_LT((trial.velocity(1) - start).norm(), 1e-15);
  const double began = trial.world().time();
  trial.kernel().find_forces();
  trial.step(500);
  const double t = trial.world().time() - began;
  EXPECT_LT((trial.position(1) - (place + start * t + 0.5 * gravity * t * t)).norm(), 1e-15);
  EXPECT_LT((trial.velocity(1) - (start + gravity * t)).norm(), 1e-13);
  EXPECT_EQ(trial.spin(1), Vec3(0, 3, 0));
  const double all = trial.world().time();
  EXPECT_LT((trial.position(0) - 0.5 * gravity * all * all).norm(), 1e-15) << "the earlier grain is not affected";
}

TEST(Arrivals, GetUnusedIds) {
  Description d = first_and_late({{Vec3::Zero(), radius}, {{-7e-3, 0, 0}, radius, {-1, 0, 0}}},
                                 {{{0, 3e-3, 0}, radius}, {{0, 6e-3, 0}, radius}});
  d["domain"] = {{"low", {-0.01, -0.01, -0.01}}, {"high", {0.01, 0.01, 0.01}}, {"open_sides", {"-x"}}};
  Trial trial(d);
  for (int k = 0; k < 5000 && trial.world().departures().empty(); ++k) trial.step();
  ASSERT_EQ(trial.world().departures().size(), 1u);
  EXPECT_DOUBLE_EQ(trial.kernel().state().discharged_fraction(), 0.5);
  begin_second(trial);
  EXPECT_THAT(sorted_ids(trial.world()), ElementsAre(0, 2, 3));
  EXPECT_DOUBLE_EQ(trial.kernel().state().discharged_fraction(), 0.25) << "of all bodies so far";
  EXPECT_EQ(trial.position(3), Vec3(0, 6e-3, 0));
}

/// A box full of moving grains, and as many that appear elsewhere.
Description crowded() {
  const Vec3 low(0, 0, 20e-3);
  Description d = first_and_late(jumble({7, 7, 7}, 1e-3, 0.1, 4), jumble({7, 7, 7}, 1e-3, 0.1, 5, low));
  for (int axis = 0; axis < 3; ++axis)
    for (const bool up : {true, false})
      d["walls"][std::string(up ? "low_" : "high_") + "xyz"[axis]] =
          side(axis, up ? 0 : 7e-3, Vec3::Zero(), Vec3::Constant(7e-3), up);
  d["materials"]["grain"]["contact_modulus"] = 1e6;
  d["guards"] = {{"overlap", 0.5}, {"travel", 0.2}, {"energy", 1}};
  return d;
}

TEST(Arrivals, KeepContactHistoryToTheLastBit) {
  Description without = crowded();
  without["bodies"].erase("late");
  Trial trial(crowded()), alone(without);
  for (Trial* t : {&trial, &alone}) t->step(100);
  const std::vector<std::uint32_t> order(trial.world().ids().begin(), trial.world().ids().end());
  begin_second(trial), begin_second(alone);
  alone.kernel().find_forces();  // which new bodies find at once
  const Memories after = memories(trial), expected = memories(alone);
  ASSERT_GT(expected.size(), 400u);
  EXPECT_GT(after.size(), expected.size());
  for (const auto& [pair, state] : expected) {
    ASSERT_TRUE(after.contains(pair));
    ASSERT_EQ(after.at(pair), state) << pair.first << ' ' << pair.second;
  }
  EXPECT_FALSE(std::equal(order.begin(), order.end(), trial.world().ids().begin())) << "in a new order of bodies";
}

TEST(Arrivals, ElsewhereChangeNoOthers) {
  Description without = crowded();
  without["bodies"].erase("late");
  Trial trial(crowded()), alone(without);
  for (Trial* t : {&trial, &alone}) t->step(100), begin_second(*t), t->kernel().find_forces(), t->step(50);
  double apart = 0;
  for (std::uint32_t id = 0; id < 343; ++id)
    apart = std::max(apart, (trial.position(id) - alone.position(id)).norm() / radius);
  EXPECT_LT(apart, 1e-11) << "the order of sums differs";
  EXPECT_EQ(trial.world().ids().size(), 686u);
}

TEST(Arrivals, AreTheSameBitsForAnyNumberOfThreads) {
  Description d = crowded();
  d["bodies"]["late"]["source"] = cloud({-3e-3, -3e-3, 7.7e-3}, {9e-3, 9e-3, 20e-3}, 500, 0.8e-3, 1.2e-3);
  Trial one(d, 1), three(d, 3);
  for (Trial* t : {&one, &three}) t->step(60), begin_second(*t);
  ASSERT_TRUE(same_bits(one.kernel(), three.kernel()));
  EXPECT_EQ(one.world().dt(), three.world().dt());
  for (Trial* t : {&one, &three}) t->kernel().find_forces(), t->step_on(120);
  EXPECT_TRUE(same_bits(one.kernel(), three.kernel()));
  EXPECT_EQ(one.world().ids().size(), 843u);
}

/// Contacts of an earlier body with a new one.
std::size_t meetings(const World& world, std::uint32_t first_late) {
  return static_cast<std::size_t>(std::ranges::count_if(world.contacts(), [&](const Contact& c) {
    return !c.with_wall && (world.ids()[c.a] < first_late) != (world.ids()[c.b] < first_late);
  }));
}

TEST(Arrivals, OfACloudKeepClearOfOthersAndTheirImages) {
  // Some extend across the side x = 6 mm, and in again at x = 0.
  std::vector<Grain> first;
  for (int y = 0; y < 3; ++y)
    for (int z = 0; z < 4; ++z) first.push_back({{5.9e-3, (2 * y + 1) * 1e-3, (2 * z + 1) * 1e-3}, 0.5e-3});
  Description d = first_and_late(first, {});
  d["domain"] = {{"low", {0, 0, -1}}, {"high", {6e-3, 6e-3, 1}}, {"periodic", {true, true, false}}};
  for (const double width : {1.1e-3, 6e-3}) {
    d["bodies"]["late"]["source"] = cloud({0, 0, 0}, {width, 6e-3, 8e-3}, 8, 0.9e-3, 1e-3);
    Trial trial(d);
    begin_second(trial);
    EXPECT_EQ(trial.world().ids().size(), 20u);
    EXPECT_EQ(meetings(trial.world(), 12), 0u) << width;
  }
}

TEST(Arrivals, OfACloudDependOnTheSeedAndNotOnOtherStages) {
  Description d = first_and_late({{Vec3::Zero(), radius}}, {});
  d["bodies"]["late"]["source"] = cloud({5e-3, 5e-3, 5e-3}, {15e-3, 15e-3, 15e-3}, 5, 0.9e-3, 1e-3);
  const auto place = [](const Description& with) {
    Trial trial(with);
    begin_second(trial);
    return trial.position(sorted_ids(trial.world()).back());
  };
  const Vec3 plain = place(d);
  Description other = d;
  other["bodies"]["more"] = d["bodies"]["late"];
  other["bodies"]["more"].erase("stage");
  other["bodies"]["more"]["source"] = cloud({-15e-3, -15e-3, -15e-3}, {-5e-3, -5e-3, -5e-3}, 5, 0.9e-3, 1e-3);
  EXPECT_EQ(place(other), plain);
  other["seed"] = 2;
  EXPECT_NE(place(other), plain);
  EXPECT_NE(place(d), [&] {
    Description at_start = d;
    at_start["bodies"]["late"].erase("stage");
    return Trial(at_start).position(5);
  }()) << "a stage has its own random numbers";
}

std::string refusal(const Description& d) {
  const Done done = run(d);
  EXPECT_EQ(done.summary().status, "failed");
  EXPECT_EQ(done.notes.finished, 1) << "the state before is recorded";
  return done.summary().message;
}

TEST(Arrivals, InsideOthersAreRefused) {
  Description d = first_and_late({{Vec3::Zero(), radius}}, {{{0, 0, 4e-3}, radius}, {{0, 0, 1.4e-3}, 0.5 * radius}});
  d["domain"] = {{"low", {-5e-3, -5e-3, -5e-3}}, {"high", {5e-3, 5e-3, 5e-3}}};
  d["guards"]["overlap"] = 0.1;
  const std::string found = refusal(d);
  EXPECT_THAT(found, HasSubstr("stage \"second\""));
  EXPECT_THAT(found, HasSubstr("body 2 at (0, 0, 0.0014) m of group \"late\" appears inside body 0: they overlap by "
                               "0.2 of the smaller radius, more than /bodies/late/overlap 0.01; place it"));
  d["bodies"]["late"]["overlap"] = 0.21;
  d["guards"]["overlap"] = 0.3;
  EXPECT_EQ(run(d).summary().status, "done") << run(d).summary().message;
  // Across a periodic side, and more than one.
  d["bodies"]["late"]["overlap"] = 0.01;
  d["domain"]["periodic"] = {false, false, true};
  d["bodies"]["grains"]["source"]["bodies"][0]["position"] = {0, 0, -4.9e-3};
  d["bodies"]["late"]["source"]["bodies"][0]["position"] = {0, 0, 4e-3};
  d["bodies"]["late"]["source"]["bodies"][1]["position"] = {0, 1.2e-3, -4.9e-3};
  EXPECT_THAT(refusal(d), HasSubstr("body 1 at (0, 0, 0.004) m of group \"late\" appears inside body 0: they overlap "
                                    "by 0.9 of the smaller radius, more than /bodies/late/overlap 0.01, the deepest of "
                                    "2 such pairs"));
}

TEST(Arrivals, InsideWallsAreRefused) {
  Description d = first_and_late({{Vec3::Zero(), radius}}, {{{0, 0, 4e-3}, radius}, {{0, 0, 1.4e-3}, 0.5 * radius}});
  d["walls"]["roof"] = plane({0, 0, 4.7e-3}, -Vec3::UnitZ());
  d["guards"]["overlap"] = 0.4;
  EXPECT_THAT(refusal(d),
              HasSubstr("stage \"second\": body 1 at (0, 0, 0.004) m of group \"late\" appears inside wall \"roof\": "
                        "they overlap by 0.3 of its radius, more than /bodies/late/overlap 0.01, the deepest of 2 such "
                        "pairs; place it in front of the wall"));
  d["bodies"]["late"]["overlap"] = 0.301;
  EXPECT_EQ(run(d).summary().status, "done") << run(d).summary().message;
  d["bodies"]["late"]["overlap"] = 0.299;
  d["walls"]["roof"]["point"] = {0, 0, 3.5e-3};
  EXPECT_THAT(refusal(d), HasSubstr("wall \"roof\": they overlap by 1.5 of its radius, more than /bodies/late/overlap "
                                    "0.299; place it"))
      << "its centre is behind the wall";
  d["bodies"]["late"]["source"] = cloud({5e-3, 5e-3, 0}, {7e-3, 7e-3, 2e-3}, 1, 2e-3, 2e-3);
  d["walls"]["roof"]["point"] = {0, 0, 1.5e-3};
  EXPECT_THAT(refusal(d), HasSubstr("wall \"roof\": they overlap by 0.5 of its radius")) << "clouds ignore walls";
  // At the position of the wall at that time.
  d["walls"]["roof"]["motion"]["velocity"] = {0, 0, 50};
  d["stages"][0]["until"]["value"] = 6;
  d["guards"]["travel"] = 0.2;
  EXPECT_EQ(run(d).summary().status, "done") << run(d).summary().message;
}

/// The last sample of a run that fails at the start of the second stage, by a probe of that stage only.
double seen_at_failure(Description d, const std::string& why, std::function<double(const World&)> what) {
  d["probes"]["last"] = {{"type", "watch"}, {"stages", {"second"}}};
  watched() = std::move(what);
  const Done done = run(d);
  watched() = {};
  EXPECT_EQ(done.summary().status, "failed");
  EXPECT_THAT(done.summary().message, HasSubstr(why));
  EXPECT_EQ(done.notes.values_of("last").size(), 1u);
  return done.notes.values_of("last").back();
}

TEST(Arrivals, ThatAreRefusedLeaveTheWorldAsItWas) {
  const double overlap = 0.01 * radius;
  Description d = first_and_late({{Vec3::Zero(), radius}, {{0, 0, 2 * radius - overlap}, radius}},
                                 {{{0, 0, -radius}, 0.5 * radius}, {{0, 0, 9e-3}, 0.5 * radius}});
  d["engines"]["hold"] = {{"type", "hold"}, {"translation", "xyz"}};
  const auto expect = [&](std::function<double(const World&)> what, double value) {
    EXPECT_NEAR(seen_at_failure(d, "appears inside body 0", std::move(what)), value, 1e-9 * value);
  };
  const auto count = [](std::size_t n) { return static_cast<double>(n); };
  expect([&](const World& w) { return count(w.ids().size()); }, 2);
  expect([&](const World& w) { return count(w.forces().size()); }, 2);
  expect([&](const World& w) { return count(w.contacts().size()); }, 1);
  expect([](const World& w) { return w.mean_diameter(); }, 2 * radius);
  expect([](const World& w) { return w.contacts()[0].normal_force; }, modulus * radius * overlap);
}

TEST(Arrivals, ThatTripAGuardAreRecordedWithTheirForces) {
  // The first of many bodies, which are then reordered; the small one is too fast for the time step.
  std::vector<Grain> first;
  for (int i = 0; i < 40; ++i) first.push_back({{(i * 17 % 40) * 3e-3, 0, 0}, radius});
  const double small = 0.1 * radius, overlap = 0.005 * small;
  Description d = first_and_late(first, {{{0, 0, radius + small - overlap}, small, {0, 6, 0}}});
  d["time_step"]["value"] = 1e-6;
  const auto force = seen_at_failure(d, "moves 0.06 of its radius in one step", [](const World& w) {
    EXPECT_EQ(w.ids().size(), 41u);
    EXPECT_EQ(w.contacts().size(), 1u);
    EXPECT_EQ(w.forces()[index_of(w, 0)].z, -w.forces()[index_of(w, 40)].z);
    return w.forces()[index_of(w, 40)].z;
  });
  // 2 E r_a r_b / (r_a + r_b)
  const double stiffness = 2 * modulus * radius * small / (radius + small);
  EXPECT_NEAR(force, stiffness * overlap, 1e-9 * stiffness * small);
}

TEST(Arrivals, WithoutRoomOrOutsideAreRefused) {
  Description d = first_and_late({{Vec3::Zero(), 2 * radius}}, {});
  d["bodies"]["late"]["source"] = cloud({-1e-3, -1e-3, -1e-3}, {1e-3, 1e-3, 1e-3}, 1, 0.9e-3, 1e-3);
  EXPECT_THAT(refusal(d), testing::AllOf(HasSubstr("stage \"second\": group \"late\": cloud: only 0 of 1 grains"),
                                         HasSubstr("bodies of other groups take space, too")));
  d = first_and_late({{Vec3::Zero(), radius}}, {{{0, 0, 6e-3}, radius}});
  d["domain"] = {{"low", {-5e-3, -5e-3, -5e-3}}, {"high", {5e-3, 5e-3, 5e-3}}};
  EXPECT_THAT(refusal(d), testing::EndsWith("group \"late\": a body at (0, 0, 0.006) m is outside the "
                                            "domain; enlarge /domain or move the body"));
}

/// Two grains, of which one leaves, then two more; three are gone in the end.
Description leaving() {
  const Vec3 down(0, 0, -1);
  Description d = first_and_late({{{0, 0, -9.5e-3}, radius, down}, {{3e-3, 0, -7e-3}, radius, down}},
                                 {{{-3e-3, 0, -5e-3}, radius, down}, {{-6e-3, 0, 9e-3}, radius, down}});
  d["domain"] = {{"low", {-0.01, -0.01, -0.01}}, {"high", {0.01, 0.01, 0.01}}, {"open_sides", {"-z"}}};
  d["stages"][0]["until"] = {{"type", "time"}, {"value", 1.5e-3}};
  d["stages"][1]["until"] = {{"type", "discharged"}, {"fraction", 0.75}};
  return d;
}

TEST(Arrivals, CountInTheIntervalOfDischargedMass) {
  Description d = leaving();
  d["probes"]["half"] = {{"type", "watch"}, {"every_discharged", 0.5}};
  watched() = [](const World& w) { return static_cast<double>(w.ids().size()); };
  const Done done = run(d);
  watched() = {};
  EXPECT_EQ(done.summary().status, "done") << done.summary().message;
  EXPECT_THAT(done.notes.values_of("half"), ElementsAre(2, 1, 1, 1))
      << "one of two; the end of the stage; two of four, which ends the other stage";
}

TEST(Arrivals, CountInTheProgressFromTheStart) {
  std::set<double> seen;
  const auto watch_progress = [&](Simulation& simulation) {
    simulation.on_progress(
        [&](const Progress& now) {
          if (now.stage == "second") seen.insert(std::round(1e6 * now.fraction.value()) / 1e6);
        },
        0);
  };
  EXPECT_EQ(run(leaving(), watch_progress).summary().status, "done");
  EXPECT_THAT(seen, ElementsAre(0, 0.5)) << "of the two that are still to leave";
}

TEST(Arrivals, OfAMissingFileAreRefusedAtTheStart) {
  Description d = first_and_late({{Vec3::Zero(), radius}}, {});
  d["bodies"]["late"]["source"] = {{"type", "file"}, {"path", "/nowhere/grains.txt"}};
  EXPECT_THROW(run(d), PlacedError);
}

TEST(Arrivals, OfAnotherMaterialHaveMixedStiffness) {
  Description d = first_and_late({{Vec3::Zero(), radius}}, {{{0, 0, 1.995 * radius}, radius}});
  d["materials"]["hard"] = {{"density", 2 * density}, {"contact_modulus", 4 * modulus}};
  d["bodies"]["late"]["material"] = "hard";
  Trial trial(d);
  begin_second(trial);
  ASSERT_EQ(trial.world().contacts().size(), 1u);
  // 2 E_A R E_B R / (E_A R + E_B R)
  const double stiffness = 1.6 * modulus * radius;
  EXPECT_NEAR(trial.world().contacts()[0].normal_force, stiffness * 5e-3 * radius, 1e-9 * stiffness * radius);
  EXPECT_NEAR(trial.mass(1), 2 * mass, 1e-12 * mass);
  EXPECT_NEAR(trial.world().solid_density(), 1.5 * density, 1e-9 * density);
}

TEST(Arrivals, CountInPropertiesOfAll) {
  Description d = first_and_late({{Vec3::Zero(), radius}}, {{{0, 0, 5e-3}, 0.4 * radius}, {{0, 0, 9e-3}, radius}});
  d["time_step"] = {{"safety", 0.5}};
  Trial trial(d, 1, BodyState::rotation | BodyState::displacement);
  trial.step(3);
  const double before = trial.world().dt();
  const std::size_t memory = trial.kernel().state().bytes();
  begin_second(trial);
  EXPECT_NEAR(trial.world().mean_diameter(), 2 * radius * 2.4 / 3, 1e-15);
  // √(m/k) is proportional to the radius.
  EXPECT_NEAR(trial.world().dt(), 0.4 * before, 1e-9 * before);
  EXPECT_GT(trial.kernel().state().bytes(), memory);
  ASSERT_EQ(trial.world().rotations().size(), 3u);
  ASSERT_EQ(trial.world().displacements().size(), 3u);
  EXPECT_EQ(trial.world().forces().size(), 3u);
}

// Rotations and displacements of the preparation do not count in the test.
TEST(Stages, ResetRotationsAndDisplacements) {
  Description d = first_and_late({{Vec3::Zero(), radius, {0.1, 0, 0}, {0, 20, -5}}}, {{{0, 0, 9e-3}, radius}});
  Trial trial(d, 1, BodyState::rotation | BodyState::displacement);
  const auto turned_by = [&](double time) {
    EXPECT_LT((trial.world().rotations()[0] - time * Vec3(0, 20, -5)).norm(), 1e-12);
    EXPECT_LT((trial.world().displacements()[0] - time * Vec3(0.1, 0, 0)).norm(), 1e-12);
  };
  trial.step(40);
  const double first = trial.world().time();
  turned_by(first);
  begin_second(trial);
  turned_by(0);
  trial.kernel().find_forces();
  trial.step(30);
  ASSERT_GT(trial.world().time(), first);
  turned_by(trial.world().time() - first);
}

TEST(Arrivals, BringTheirEnergy) {
  Description d = first_and_late({{Vec3::Zero(), radius}}, {{{0, 0, 5e-3}, radius, {0.1, 0, 0}, {0, 20, 0}}});
  d["engines"]["gravity"] = {{"type", "gravity"}};
  Trial trial(d, 1, BodyState::energy);
  trial.world().energies();
  trial.step(50);
  begin_second(trial);
  const double brought = 0.5 * mass * 0.01 + 0.2 * mass * radius * radius * 400;
  EXPECT_NEAR(trial.world().energies().settings, brought, 1e-12 * brought);
  EXPECT_LT(std::abs(trial.world().energies().closure_error), 1e-12 * brought);
  // One that appears in contact also adds the energy stored in the contact.
  d["bodies"]["late"]["source"]["bodies"][0]["position"][2] = 1.995 * radius;
  d["engines"].erase("gravity");
  d["time_step"]["value"] = 5e-7;
  Trial pressed(d, 1, BodyState::energy);
  pressed.world().energies();
  begin_second(pressed);
  EXPECT_NEAR(pressed.world().energies().settings, brought + 0.5 * modulus * radius * 25e-12, 1e-9 * brought);
  pressed.step(2000);
  EXPECT_TRUE(pressed.world().contacts().empty()) << "they have separated";
  EXPECT_LT(std::abs(pressed.world().energies().closure_error), 2e-3 * brought);
}

TEST(Arrivals, MayBeClumps) {
  const std::vector<Grain> late{{{0, 0, 9e-3}, radius, {0.1, 0, 0}, {3, 20, 9}}, {{0, 0, 18e-3}, radius}};
  Description d = first_and_late({{Vec3::Zero(), radius}}, late);
  d["bodies"]["late"]["type"] = "clump", d["bodies"]["late"]["shape"] = boomerang();
  d["engines"]["gravity"] = {{"type", "gravity"}};
  Description at_once = d;
  at_once["bodies"]["late"].erase("stage");
  Trial trial(d), always(at_once);
  trial.step(20);
  EXPECT_TRUE(trial.world().clumps().empty());
  begin_second(trial);
  ASSERT_EQ(trial.world().ids().size(), 7u);
  ASSERT_EQ(trial.world().clumps().size(), 2u);
  EXPECT_EQ(trial.world().clumps()[1].id, 1u);
  EXPECT_EQ(trial.world().volume_fractions().size(), 7u);
  EXPECT_EQ(trial.world().mean_diameter(), always.world().mean_diameter());
  EXPECT_EQ(trial.world().clump_of()[index_of(trial.world(), 0)], no_clump);
  trial.kernel().find_forces();
  trial.step(400), always.step(400);
  for (std::uint32_t id = 1; id < 7; ++id)
    EXPECT_LT((trial.position(id) - always.position(id)).norm(), 1e-9 * radius) << id;
}

TEST(Arrivals, OfClumpsFollowClumps) {
  Description d = first_and_late({{Vec3::Zero(), radius}, {{0, 0, 9e-3}, radius}}, {{{0, 9e-3, 0}, radius}});
  for (const char* group : {"grains", "late"})
    d["bodies"][group]["type"] = "clump", d["bodies"][group]["shape"] = boomerang();
  Trial trial(d);
  begin_second(trial);
  ASSERT_EQ(trial.world().clumps().size(), 3u);
  for (std::uint32_t id = 0; id < 9; ++id) {
    const ClumpView& clump = trial.world().clumps()[trial.world().clump_of()[index_of(trial.world(), id)]];
    EXPECT_EQ(clump.id, id / 3);
    EXPECT_LT((clump.centre - trial.position(id)).norm(), radius) << id;
  }
}

/// A layer falls onto the floor and comes to rest, then another on top of it.
Description two_layers() {
  Description d = first_and_late({}, {});
  d["bodies"]["grains"]["source"] = cloud({0, 0, 0}, {6e-3, 6e-3, 4.5e-3}, 80, 0.8e-3, 1.2e-3);
  d["bodies"]["late"]["source"] = cloud({0, 0, 4.5e-3}, {6e-3, 6e-3, 9e-3}, 80, 0.8e-3, 1.2e-3);
  d["domain"] = {{"low", {0, 0, -1e-3}}, {"high", {6e-3, 6e-3, 20e-3}}, {"periodic", {true, true, false}}};
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["engines"]["gravity"] = {{"type", "gravity"}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.4}};
  d["time_step"] = {{"safety", 0.8}};
  for (Description& stage : d["stages"])
    stage["until"] = {{"type", "all"},
                      {"of", {{{"type", "time"}, {"value", 0.04}}, {{"type", "unbalanced-force"}, {"below", 3e-4}}}}};
  return d;
}

TEST(Arrivals, OfASecondLayerWeighOnTheFloorWithTheFirst) {
  Description d = two_layers();
  d["probes"]["weight"] = {{"type", "watch"}};
  watched() = [](const World& world) {
    double weight = 0;
    for (const Row& v : world.velocities()) weight += 9.81 / v.w;
    return -world.walls()[0].force.z() / weight;
  };
  const Done done = run(d);
  watched() = {};
  ASSERT_EQ(done.summary().status, "done") << done.summary().message;
  EXPECT_EQ(done.summary().bodies, 160u);
  EXPECT_THAT(done.notes.values_of("weight"), ElementsAre(testing::DoubleNear(1, 1e-3), testing::DoubleNear(1, 1e-3)));
  EXPECT_THAT(done.notes.ended, ElementsAre(HasSubstr("80 bodies, "), HasSubstr("160 bodies, ")));
  EXPECT_GT(meetings(done.kernel->world(), 80), 10u) << "the second lies on the first";
}

}  // namespace
}  // namespace grit::test::arrivals_tests
