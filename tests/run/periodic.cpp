// Periodic sides: their position has no effect on bodies, at rest or in a deforming cell.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "support/packing.hpp"

namespace grit::test::periodic_tests {
namespace {

const Vec3 period(6e-3, 7e-3, 8e-3);

Description in_cell(std::vector<Grain> grains, const Vec3& shift, const Vec3& strain_rate = Vec3::Zero(),
                    const Vec3& shear_rate = Vec3::Zero()) {
  for (Grain& g : grains) {
    g.position += shift;
    for (int k = 0; k < 3; ++k) {
      g.position[k] -= std::floor(g.position[k] / period[k]) * period[k];
      if (g.position[k] >= period[k]) g.position[k] = 0;
    }
  }
  Description d = description("linear-rolling", {{"contact_modulus", 1e6}}, grains);
  d["domain"] = {{"low", {0, 0, 0}},
                 {"high", vector(period)},
                 {"periodic", {true, true, true}},
                 {"strain_rate", vector(strain_rate)},
                 {"shear_rate", {{"xy", shear_rate[0]}, {"xz", shear_rate[1]}, {"yz", shear_rate[2]}}}};
  d["time_step"]["value"] = 2e-6;
  d["guards"] = {{"overlap", 0.5}, {"travel", 0.2}, {"energy", 1}};
  return d;
}

/// Largest difference of forces, moments, and velocities apart from the mean flow, over the largest of each.
double apart(const Trial& a, const Trial& b, std::uint32_t bodies) {
  double worst = 0;
  const auto compare = [&](auto quantity) {
    double difference = 0, size = 0;
    for (std::uint32_t id = 0; id < bodies; ++id) {
      const Vec3 qa = quantity(a, id), qb = quantity(b, id);
      difference = std::max(difference, (qa - qb).norm()), size = std::max(size, qa.norm());
    }
    worst = std::max(worst, difference / size);
  };
  compare([](const Trial& t, std::uint32_t id) { return xyz(t.world().forces()[index_of(t.world(), id)]); });
  compare([](const Trial& t, std::uint32_t id) { return xyz(t.world().moments()[index_of(t.world(), id)]); });
  compare([](const Trial& t, std::uint32_t id) {
    const Cell& cell = t.world().cell();
    const std::size_t i = index_of(t.world(), id);
    // Velocities are half a step old, and so is the mean flow.
    const Vec3 v = xyz(t.world().velocities()[i]);
    const double dt = t.kernel().state().time.previous_dt;
    const Vec3 from_middle = xyz(t.world().positions()[i]) - 0.5 * (cell.low + cell.high);
    Mat3 gradient = cell.strain_rate.asDiagonal();
    gradient(0, 1) = cell.shear_rate[0], gradient(0, 2) = cell.shear_rate[1], gradient(1, 2) = cell.shear_rate[2];
    return Vec3(v - gradient * ((Mat3::Identity() + dt * gradient).inverse() * from_middle));
  });
  return worst;
}

TEST(Periodic, GrainsThatMeetAcrossASideFeelTheSame) {
  // Oblique, with spin, through a face, an edge and a corner.
  const std::vector<Grain> two{{{2.2e-3, 3e-3, 3.1e-3}, 0.5e-3, {3, 1, 0.5}, {100, 200, -300}},
                               {{3.4e-3, 3.5e-3, 3.6e-3}, 0.8e-3, {-1, -0.5, 0}, {0, -500, 50}}};
  for (const Vec3& shift : {Vec3(3.2e-3, 0, 0), Vec3(3.2e-3, 3.75e-3, 0), Vec3(-2.8e-3, 3.75e-3, 4.65e-3)}) {
    Trial middle(in_cell(two, Vec3::Zero())), across(in_cell(two, shift));
    std::size_t touching = 0;
    for (int i = 0; i < 400; ++i) {
      middle.step(), across.step();
      ASSERT_EQ(middle.kernel().state().pairs.touching_count(), across.kernel().state().pairs.touching_count());
      if (middle.kernel().state().pairs.touching_count() == 0) continue;
      ++touching;
      ASSERT_LT(apart(middle, across, 2), 1e-9) << middle.world().step();
    }
    EXPECT_GT(touching, 50u);
    EXPECT_EQ(middle.kernel().state().pairs.touching_count(), 0u) << "they have collided and separated";
  }
}

TEST(Periodic, PackingMayBeShiftedAndWrapped) {
  const auto grains = jumble({6, 7, 8}, 1e-3, 0.1, 9);
  const auto bodies = static_cast<std::uint32_t>(grains.size());
  const Vec3 none(0, 0, 0), stretch(-30, 20, -10);
  for (const auto& [rate, shear] :
       {std::pair(none, none), std::pair(stretch, none), std::pair(stretch, Vec3(200, -300, 100)),
        std::pair(none, Vec3(3000, 9000, -5000))}) {
    // With a mean flow all bodies start at rest relative to it.
    Trial one(in_cell(grains, Vec3::Zero(), rate, shear)),
        other(in_cell(grains, {1.3e-3, -2.9e-3, 5.1e-3}, rate, shear));
    EXPECT_LT(apart(one, other, bodies), 1e-12);
    one.step(60), other.step(60);
    EXPECT_GT(one.kernel().state().pairs.touching_count(), shear.norm() > 1000 ? 200u : 500u);
    // The order of sums causes round-off, which collisions amplify.
    EXPECT_LT(apart(one, other, bodies), 1e-9) << rate.transpose() << ", " << shear.transpose();
  }
}

/// Displacements need the jumps of positions at periodic sides.
TEST(Periodic, DisplacementsContinueAcrossSides) {
  const Vec3 none(0, 0, 0);
  for (const auto& [rate, shear] : {std::pair(none, none), std::pair(Vec3(-30, 20, -10), none),
                                    std::pair(Vec3(-30, 20, -10), Vec3(500, -700, 300))}) {
    // Across several sides, back and forth, past each other and swapping indices.
    std::vector<Grain> grains{{{2e-3, 3e-3, 3e-3}, 0.5e-3, {40, 3, -25}}, {{4.5e-3, 1e-3, 7e-3}, 0.4e-3, {-30, 0, 7}}};
    Trial t(in_cell(grains, Vec3::Zero(), rate, shear), 1, BodyState::displacement);
    std::vector<Vec3> gone(2, Vec3::Zero());
    for (int step = 0; step < 600; ++step) {
      t.kernel().advance();
      for (std::uint32_t id = 0; id < 2; ++id)
        gone[id] += t.world().dt() * xyz(t.world().velocities()[index_of(t.world(), id)]);
      t.kernel().find_forces();
    }
    const Vec3 sides = t.world().cell().high - t.world().cell().low;
    EXPECT_GT(gone[0].x() / sides.x(), 5) << "it crossed sides";
    for (std::uint32_t id = 0; id < 2; ++id)
      EXPECT_LT((t.world().displacements()[index_of(t.world(), id)] - gone[id]).norm(), 1e-13) << rate.transpose();
  }
}

TEST(Periodic, AcceptsABodyJustPastASideAndNoneFarther) {
  const auto at = [](double x) {
    Description d = in_cell({{Vec3(3e-3, 3e-3, 3e-3), 1e-3}}, Vec3::Zero());
    d["bodies"]["grains"]["source"]["bodies"][0]["position"][0] = x;
    return d;
  };
  const Trial past(at(-0.9e-3));
  EXPECT_DOUBLE_EQ(past.world().positions()[0].x, period.x() - 0.9e-3);
  EXPECT_THROW(Trial(at(-1.1e-3)), Error);
}

TEST(Periodic, WallThatEndsAtASideIsRefused) {
  const auto complaint = [](const Vec3& low, const Vec3& high) -> std::string {
    Description d = in_cell({{{3e-3, 3e-3, 4e-3}, 5e-4}}, Vec3::Zero());
    d["walls"]["block"] = {
        {"type", "box"}, {"inside", false}, {"low", vector(low)}, {"high", vector(high)}, {"material", "grain"}};
    try {
      Trial t(d);
    } catch (const NumericsError& error) {
      return error.what();
    }
    return "";
  };
  const double far = 6e-4;
  EXPECT_EQ(complaint({-far, -far, 1e-3}, {6e-3 + far, 7e-3 + far, 2e-3}), "") << "beyond both sides";
  EXPECT_EQ(complaint({far, far, 1e-3}, {2e-3, 2e-3, 2e-3}), "") << "away from all sides";
  EXPECT_EQ(complaint({0, -far, 1e-3}, {6e-3, 7e-3 + far, 2e-3}), "") << "exactly one period";
  EXPECT_EQ(
      complaint({0, -far, 1e-3}, {5.9e-3, 7e-3 + far, 2e-3}),
      "step 0, time 0 s: wall \"block\" extends from 0 to 0.0059 m along x and so ends near a periodic side (0 or "
      "0.006 m); walls have no images: make it exactly one period long, extend it beyond both sides by at least "
      "the largest radius, 0.0005 m, or keep it as far from both");
  EXPECT_NE(complaint({-far, far, 1e-3}, {5e-3, 2e-3, 2e-3}), "") << "across one side only";
}

TEST(Periodic, WallOfOnePeriodHasNoEnds) {
  // A grain slides over both sides of the cell, on a floor of one period and on an endless one.
  const auto slid = [](const Description& floor) {
    Description d = in_cell({{{3e-3, 3e-3, 5e-4}, 5e-4, {0.5, 0.3, 0}}}, Vec3::Zero());
    d["domain"]["periodic"] = {true, true, false};
    d["domain"].erase("strain_rate");
    d["time_step"] = Description::object();
    d["engines"]["gravity"] = {{"type", "gravity"}};
    d["walls"]["floor"] = floor;
    Trial t(d);
    double highest = 0;
    while (t.world().time() < 0.1) {
      t.step();
      highest = std::max(highest, t.position(0).z());
    }
    const Vec3 x = t.position(0), v = t.velocity(0);
    return std::array<double, 6>{x.x(), x.y(), highest, v.x(), v.y(), v.z()};
  };
  const Description endless = plane(Vec3::Zero(), Vec3::UnitZ());
  const Description one_period = {{"type", "rectangle"},
                                  {"corner", {0, 0, 0}},
                                  {"edge_a", {period.x(), 0, 0}},
                                  {"edge_b", {0, period.y(), 0}},
                                  {"material", "grain"}};
  const auto expected = slid(endless), found = slid(one_period);
  EXPECT_LT(expected[3], 0.49) << "friction acts";
  for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_NEAR(found[k], expected[k], 1e-12) << k;
}

TEST(Periodic, WallOfOnePeriodMayMoveAlongIt) {
  // A floor that has moved by a third of the period carries a grain anywhere.
  for (const double place : {0.1, 0.5, 0.9}) {
    Description d = in_cell({{{place * period.x(), 3e-3, 5e-4}, 5e-4}}, Vec3::Zero());
    d["domain"]["periodic"] = {true, true, false};
    d["domain"].erase("strain_rate");
    d["time_step"] = Description::object();
    d["engines"]["gravity"] = {{"type", "gravity"}};
    d["walls"]["floor"] = {{"type", "rectangle"},
                           {"corner", {0, 0, 0}},
                           {"edge_a", {period.x(), 0, 0}},
                           {"edge_b", {0, period.y(), 0}},
                           {"material", "grain"}};
    d["walls"]["floor"]["motion"]["velocity"] = {period.x() / 0.15, 0, 0};
    Trial t(d);
    while (t.world().time() < 0.05) t.step();
    EXPECT_GT(t.position(0).z(), 4.9e-4) << place;
  }
}

// The drum drags a ball up to the angle of friction, where it slides: rolling resistance, 0.4 > tan φ, keeps it from
// rolling back. There its overlap carries m g cos φ.
TEST(Periodic, DrumOfOnePeriodMaySpinAboutIt) {
  const double ball = 5e-4, drum = 2.5e-3, modulus = 1e6, friction = 0.3, g = 9.81;
  const Vec3 axis(3e-3, 0, 3e-3);
  Description d = in_cell({{axis + Vec3(0, 3e-3, 0), ball}}, Vec3::Zero());
  d["materials"]["grain"].update({{"friction_angle", friction}, {"restitution", 0.1}, {"rolling_limit", 0.4}});
  d["domain"]["periodic"] = {false, true, false};
  d["domain"].erase("strain_rate");
  d["time_step"] = Description::object();
  d["engines"] = {{"gravity", {{"type", "gravity"}, {"acceleration", {0, 0, -g}}}},
                  {"damping", {{"type", "local-damping"}, {"coefficient", 0.7}}}};
  d["walls"]["drum"] = {{"type", "cylinder"},
                        {"start", vector(axis)},
                        {"end", vector(axis + Vec3(0, period.y(), 0))},
                        {"radius", drum},
                        {"material", "grain"}};
  d["walls"]["drum"]["motion"]["spin"] = {0, 3, 0};
  Trial t(d);
  while (t.world().time() < 0.6) t.step();
  const double overlap = t.mass(0) * g * std::cos(friction) / (modulus * ball);
  const double x = t.position(0).x() - axis.x(), z = t.position(0).z() - axis.z();
  // It still swings along the drum, by less than 5e-4 rad. The force changes by tan φ times that.
  EXPECT_NEAR(std::atan2(-x, -z), friction, 5e-4);
  EXPECT_NEAR(std::hypot(x, z), drum - ball + overlap, 5e-4 * std::tan(friction) * overlap);
}

TEST(Periodic, WallOfOnePeriodMustBeUniformAlongIt) {
  const auto grooved = [](const Vec3& along, const Vec3& across) {
    Description d = in_cell({{{3e-3, 3e-3, 6e-4}, 5e-4}}, Vec3::Zero());
    d["domain"]["periodic"] = {true, true, false};
    d["domain"].erase("strain_rate");
    d["walls"]["floor"] = {{"type", "saw-tooth"},     {"corner", {0, 0, 0}}, {"edge_a", vector(across)},
                           {"edge_b", vector(along)}, {"depth", 5e-4},       {"material", "grain"}};
    return d;
  };
  const double wide = 2e-3;  // beyond the sides
  Description beyond = grooved({0, period.y(), 0}, {period.x() + 2 * wide, 0, 0});
  beyond["walls"]["floor"]["corner"] = {-wide, 0, 0};
  EXPECT_NO_THROW(Trial{beyond});
  try {
    Trial t(grooved({0, period.y(), 0}, {period.x(), 0, 0}));
    FAIL();
  } catch (const NumericsError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("is one period long along x"));
    EXPECT_THAT(error.what(), testing::HasSubstr("its surface changes along x"));
  }
}

TEST(Periodic, DeformingCellCarriesAllBodiesAlike) {
  // Without contact up to 25 % of strain: relative positions in the cell are constant.
  auto grains = jumble({6, 7, 8}, 1e-3, 0, 10);
  for (Grain& g : grains) g.radius *= 0.3;
  Trial t(in_cell(grains, {0.3e-3, 0, 0}, {-50, 40, 0}));
  const Cell first = t.world().cell();
  std::vector<Vec3> places;
  for (std::uint32_t id = 0; id < grains.size(); ++id)
    places.push_back((t.position(id) - first.low).cwiseQuotient(first.high - first.low));
  t.step(2500);
  const Cell& last = t.world().cell();
  // Each step multiplies the sides by 1 + dt ε̇.
  EXPECT_NEAR((last.high - last.low).x() / period.x(), std::pow(1 - 50 * 2e-6, 2500), 1e-12);
  EXPECT_NEAR((last.high - last.low).y() / period.y(), std::pow(1 + 40 * 2e-6, 2500), 1e-12);
  EXPECT_NEAR((last.high - last.low).z() / period.z(), 1, 1e-14);
  double worst = 0;
  for (std::uint32_t id = 0; id < grains.size(); ++id) {
    Vec3 moved = (t.position(id) - last.low).cwiseQuotient(last.high - last.low) - places[id];
    for (int k = 0; k < 3; ++k) moved[k] -= std::round(moved[k]);
    worst = std::max(worst, moved.norm());
  }
  EXPECT_LT(worst, 1e-11) << "round-off of 2500 steps";
}

TEST(Periodic, ShearMovesAllBodiesAlike) {
  // Without contact over several periods of shear.
  auto grains = jumble({6, 7, 8}, 1e-3, 0, 10);
  for (Grain& g : grains) g.radius *= 0.3;
  const Vec3 shear(0, 900, 400);
  Trial t(in_cell(grains, Vec3::Zero(), Vec3::Zero(), shear));
  const Vec3 middle = 0.5 * period;
  std::vector<Vec3> places;
  for (std::uint32_t id = 0; id < grains.size(); ++id) places.push_back(t.position(id) - middle);
  t.step(2500);
  const double time = t.world().time();
  ASSERT_EQ(t.kernel().state().pairs.touching_count(), 0u);
  double worst = 0;
  for (std::uint32_t id = 0; id < grains.size(); ++id) {
    const Vec3& from = places[id];
    const Vec3 expected = middle + from + time * Vec3(shear[1] * from.z(), shear[2] * from.z(), 0);
    const Cell& cell = t.world().cell();
    worst = std::max(worst, (cell.inside(expected) - cell.inside(t.position(id))).norm());
  }
  EXPECT_GT(time * shear[1] * period.z(), 4 * period.x());
  EXPECT_LT(worst, 1e-12) << "round-off of 2500 steps";
}

TEST(Periodic, AveragesOfASkewedCellAreThoseOfAllContactsAndBodies) {
  Trial t(in_cell(jumble({6, 7, 8}, 1e-3, 0.1, 9), Vec3::Zero(), Vec3::Zero(), {2000, 3000, -2500}));
  t.step(60);
  const World& world = t.world();
  const Cell& cell = world.cell();
  ASSERT_GT(std::abs(cell.tilt[1]), 0.1 * period.x());
  Mat3 sum = Mat3::Zero();
  for (const Contact& contact : world.contacts()) sum += contact.force * contact.branch.transpose();
  const Mat3 stress = mean_stress(world, {cell.low, cell.high});
  EXPECT_LT((stress - sum / period.prod()).norm(), 1e-12 * stress.norm());
  double solid = 0;
  for (const Row& x : world.positions()) solid += 4.0 / 3 * std::numbers::pi * x.w * x.w * x.w;
  EXPECT_NEAR(void_ratio(world, {cell.low, cell.high}), period.prod() / solid - 1, 1e-12);
}

TEST(Periodic, ChangeOfStrainRateIsTheSameEverywhere) {
  auto d = [&](const Vec3& shift) { return in_cell(jumble({6, 7, 8}, 1e-3, 0.1, 9), shift, {-30, 20, -10}); };
  Trial one(d(Vec3::Zero())), other(d({1.3e-3, -2.9e-3, 5.1e-3}));
  Description faster = d(Vec3::Zero());
  faster["domain"]["strain_rate"] = {20, -40, 0};
  const Scene then = scene_of(faster);
  one.step(20), other.step(20);
  for (Trial* t : {&one, &other}) t->begin_stage(then, 0, "then"), t->kernel().find_forces();
  one.step(20), other.step(20);
  // The flow of the step before the change is taken with the new rate: dt ε̇² over the cell, small against grain motion.
  EXPECT_LT(apart(one, other, 6 * 7 * 8), 5e-5);
}

}  // namespace
}  // namespace grit::test::periodic_tests
