// Bodies that leave through an open side of the domain.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "grit/error.hpp"
#include "run/conditions.hpp"
#include "support/clump.hpp"
#include "support/packing.hpp"

namespace grit::test::departures_tests {
namespace {

const Description stuff{{"density", 2600}, {"contact_modulus", 1e7}};

/// One grain falls next to a floor on which others rest, and leaves the domain.
Description falling() {
  Description d = description("linear-rolling", stuff,
                              {{{8e-3, 0, 1e-3}, 1e-3},
                               {{-1e-3, 0, 0.999e-3}, 1e-3},
                               {{-3.001e-3, 0, 0.999e-3}, 1e-3},
                               {{-2e-3, 0, 2.73e-3}, 1e-3}});
  d["walls"]["floor"] = side(2, 0, Vec3(-6e-3, -3e-3, 0), Vec3(0, 3e-3, 0), true);
  d["engines"]["gravity"] = {{"type", "gravity"}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.2}};
  d["domain"] = {{"low", {-0.01, -0.01, -0.01}}, {"high", {0.01, 0.01, 0.01}}, {"open_sides", {"-z"}}};
  d["time_step"]["value"] = 5e-6;
  return d;
}

TEST(Departures, AreKeptAndCounted) {
  Trial trial(falling(), 1, BodyState::energy);
  trial.world().energies();
  const double mass = trial.mass(0);
  while (trial.world().departures().empty() && trial.world().time() < 0.2) trial.step();
  ASSERT_EQ(trial.world().departures().size(), 1u);
  const Departure gone = trial.world().departures().front();
  EXPECT_EQ(gone.id, 0u);
  EXPECT_EQ(gone.mass, mass);
  EXPECT_LT(gone.position.z(), -0.01);
  EXPECT_GT(gone.position.z(), -0.0115) << "found within a skin of the side";
  // Damping reduces the acceleration by gravity: z = ½ (1 − λ) g t².
  EXPECT_NEAR(gone.time, std::sqrt(2 * (1e-3 - gone.position.z()) / (0.8 * 9.81)), 1e-4);
  EXPECT_EQ(trial.world().ids().size(), 3u);
  EXPECT_NEAR(trial.kernel().state().discharged_fraction(), 0.25, 1e-12);
  EXPECT_LT(std::abs(trial.world().energies().closure_error), 5e-3 * mass * 9.81 * 0.01);
}

/// Other bodies keep their contacts and contact history: forces continue without a jump.
TEST(Departures, LeaveOthersAlone) {
  Trial trial(falling());
  Description without = falling();
  without["bodies"]["grains"]["source"]["bodies"].erase(0);
  Trial others(without);
  trial.world().departures();
  for (int k = 0; k < 60000 && trial.world().departures().empty(); ++k) trial.step(), others.step();
  ASSERT_EQ(trial.world().departures().size(), 1u);
  trial.step(200), others.step(200);
  ASSERT_EQ(trial.world().contacts().size(), others.world().contacts().size());
  ASSERT_GT(trial.world().contacts().size(), 3u);
  for (std::uint32_t id = 1; id < 4; ++id) EXPECT_LT((trial.position(id) - others.position(id - 1)).norm(), 1e-15);
  for (std::size_t c = 0; c < trial.world().contacts().size(); ++c)
    EXPECT_LT((trial.world().contacts()[c].force - others.world().contacts()[c].force).norm(), 1e-12);
}

TEST(Departures, OfAClumpAreOneOfTheWholeClump) {
  Description d = description("linear-rolling", stuff, {{{0, 0, 0}, 1e-3, {0, 0, -1}}, {{0, 0, 6e-3}, 1e-3}});
  make_clumps(d, boomerang());
  d["domain"] = {{"low", {-0.01, -0.01, -0.01}}, {"high", {0.01, 0.01, 0.01}}, {"open_sides", {"-z"}}};
  Trial trial(d);
  const double mass = trial.world().clumps().front().mass;
  for (int k = 0; k < 5000 && trial.world().departures().empty(); ++k) trial.step();
  ASSERT_EQ(trial.world().departures().size(), 1u);
  EXPECT_NEAR(trial.world().departures().front().mass, mass, 1e-12 * mass);
  EXPECT_EQ(trial.world().ids().size(), 3u);
  ASSERT_EQ(trial.world().clumps().size(), 1u);
  EXPECT_EQ(trial.world().clumps().front().id, 1u);
  for (const std::uint32_t c : trial.world().clump_of()) EXPECT_EQ(c, 0u);
  const Vec3 before = trial.position(3);
  trial.step(10);
  EXPECT_EQ((trial.position(3) - before).norm(), 0);
}

TEST(Departures, OfTheLastClumpRemoveAllOfIt) {
  Description d = description("linear-rolling", stuff, {{{0, 0, 0}, 1e-3, {0, 0, -1}}});
  make_clumps(d, boomerang());
  d["bodies"]["others"] = {
      {"type", "sphere"},
      {"material", "grain"},
      {"source",
       {{"type", "list"}, {"bodies", {{{"position", {0, 0, 6e-3}}, {"radius", 1e-3}, {"velocity", {1e-3, 0, 0}}}}}}}};
  d["engines"]["gravity"] = {{"type", "gravity"}, {"acceleration", {0, 0, -1e-3}}};
  d["domain"] = {{"low", {-0.01, -0.01, -0.01}}, {"high", {0.01, 0.01, 0.01}}, {"open_sides", {"-z"}}};
  Trial trial(d, 1, BodyState::energy);
  trial.world().energies();
  ASSERT_EQ(trial.world().clumps().size(), 1u);
  for (int k = 0; k < 5000 && trial.world().departures().empty(); ++k) trial.step();
  EXPECT_TRUE(trial.world().clumps().empty());
  EXPECT_TRUE(trial.world().clump_of().empty());
  EXPECT_TRUE(trial.world().arms().empty());
  const double kinetic = trial.world().energies().kinetic, fallen = trial.world().energies().gravitational;
  EXPECT_NEAR(kinetic, 0.5 * trial.mass(3) * trial.velocity(3).squaredNorm(), 1e-9 * kinetic);
  trial.step(100);
  EXPECT_NEAR(trial.world().energies().gravitational, fallen, 1e-3 * std::abs(fallen));
}

/// Two grains in contact, one above the other, held at 1 m/s along x.
Description pair_in_contact() {
  Description d =
      description("linear-rolling", stuff, {{{0, 0, 0.999e-3}, 1e-3, {1, 0, 0}}, {{0, 0, 2.998e-3}, 1e-3, {1, 0, 0}}});
  d["engines"]["hold"] = {{"type", "hold"}, {"translation", "xyz"}};
  return d;
}
void expect_none_left(const World& world) {
  EXPECT_EQ(world.departures().size(), 2u);
  EXPECT_TRUE(world.ids().empty());
  EXPECT_TRUE(world.contacts().empty());
}

TEST(Departures, OfAllBodiesEndTheirContacts) {
  Description d = pair_in_contact();
  d["domain"] = {{"low", {-0.01, -0.01, -0.01}}, {"high", {2e-3, 0.01, 0.01}}, {"open_sides", {"+x"}}};
  Trial trial(d);
  ASSERT_EQ(trial.world().contacts().size(), 1u);
  for (int k = 0; k < 20000 && trial.world().departures().empty(); ++k) trial.step();
  expect_none_left(trial.world());
  trial.step(3);
  expect_none_left(trial.world());
}

TEST(Departures, OfAllBodiesIntoASinkEndContactsWithWalls) {
  Description d = pair_in_contact();
  d["walls"]["floor"] = plane({0, 0, 0}, {0, 0, 1});
  const auto all_above = [](double z) {
    return Description{{"type", "half-space"}, {"point", {0, 0, z}}, {"normal", {0, 0, -1}}};
  };
  d["engines"]["sink"] = {{"type", "sink"}, {"region", all_above(1)}};
  d["bodies"]["late"] = description("", {}, {{{0, 0, 0.999e-3}, 1e-3}})["bodies"]["grains"];
  d["bodies"]["late"]["stage"] = "late";
  d["stages"][0]["name"] = "first";
  for (const auto& [name, z] : {std::pair("remove", 0.0), std::pair("late", 1.0)})
    d["stages"].push_back({{"name", name},
                           {"until", {{"type", "steps"}, {"value", 1}}},
                           {"limit", 1},
                           {"change", {{"engines", {{"sink", {{"region", {{"point", {0, 0, z}}}}}}}}}}});
  Trial trial(d);
  trial.step(2);
  ASSERT_EQ(trial.world().contacts().size(), 2u);
  ASSERT_EQ(trial.world().walls()[0].contacts, 1u);
  trial.begin_stage(1, "remove");
  trial.step();
  expect_none_left(trial.world());
  EXPECT_EQ(trial.world().walls()[0].contacts, 0u);
  EXPECT_EQ(trial.world().walls()[0].force, Vec3::Zero());
  trial.step(3);
  expect_none_left(trial.world());

  // A body that appears where one was has a contact of its own.
  trial.begin_stage(2, "late");
  trial.kernel().find_forces();
  EXPECT_EQ(trial.world().ids().size(), 1u);
  EXPECT_EQ(trial.world().walls()[0].contacts, 1u);
  EXPECT_LT(trial.world().walls()[0].force.z(), 0);
}

TEST(Departures, AreTheSameBitsForAnyNumberOfThreads) {
  Description d = description("linear-rolling", stuff, jumble({14, 14, 14}, 1e-3, 0.5, 5));
  d["domain"] = {{"low", {-1e-3, -1e-3, 2e-3}},
                 {"high", {15e-3, 15e-3, 15e-3}},
                 {"open_sides", {"-z", "+x", "-x", "+y", "-y", "+z"}}};
  d["bodies"]["grains"]["source"]["bodies"] = [&] {
    Description kept = Description::array();
    for (const auto& grain : d["bodies"]["grains"]["source"]["bodies"])
      if (grain["position"][2] > 2.2e-3) kept.push_back(grain);
    return kept;
  }();
  d["guards"] = {{"overlap", 0.5}, {"travel", 0.2}, {"energy", 1}};
  Trial one(d, 1), three(d, 3);
  for (int round = 0; round < 6; ++round) {
    one.step(150), three.step(150);
    ASSERT_TRUE(same_bits(one.kernel(), three.kernel()));
    ASSERT_EQ(one.world().departures().size(), three.world().departures().size());
  }
  EXPECT_GT(one.world().departures().size(), 100u);
}

TEST(Departures, EndAStage) {
  const Trial still(falling());
  Condition condition;
  condition.is.choose("discharged");
  std::get<DischargedCondition>(condition.is.value()).fraction = 0.2;
  Trial trial(falling());
  const StageStart start{};
  EXPECT_FALSE(is_met(condition, trial.kernel(), start));
  while (trial.world().departures().empty() && trial.world().time() < 0.2) trial.step();
  EXPECT_TRUE(is_met(condition, trial.kernel(), start));
  // The progress of a later stage counts from the mass discharged before.
  std::get<DischargedCondition>(condition.is.value()).fraction = 0.5;
  EXPECT_NEAR(progress(condition, trial.kernel(), start).value(), 0.25 / 0.5, 1e-12);
  EXPECT_NEAR(progress(condition, trial.kernel(), {.discharged_fraction = 0.2}).value(), 0.05 / 0.3, 1e-12);
  EXPECT_EQ(progress(condition, trial.kernel(), {.discharged_fraction = 0.5}), 1) << "reached before it began";
}

TEST(Departures, ThroughAnotherSideAreAnError) {
  Description d = description("linear-rolling", stuff, {{{0, 0, 0}, 1e-3, {-1, 0, 0}}});
  d["domain"] = {{"low", {-0.01, -0.01, -0.01}}, {"high", {0.01, 0.01, 0.01}}, {"open_sides", {"-z"}}};
  Trial trial(d);
  try {
    trial.step(5000);
    FAIL() << "it continued";
  } catch (const NumericsError& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("left the domain through its lower x side"));
    EXPECT_THAT(e.what(), testing::HasSubstr("/domain/open_sides"));
  }
}

}  // namespace
}  // namespace grit::test::departures_tests
