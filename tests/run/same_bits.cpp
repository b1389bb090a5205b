// The same bits for any number of threads, with or without queries of forces.
#include <gtest/gtest.h>

#include <array>
#include <deque>

#include "support/packing.hpp"

namespace grit::test::same_bits_tests {
namespace {

const Description sand{{"contact_modulus", 1e6}, {"density", 2600}};

/// 2744 grains between six walls: a servo-controlled lid, another wall slides.
Description boxed() {
  const double spacing = 1e-3;
  const Vec3 low = Vec3::Zero(), high = Vec3::Constant(14 * spacing);
  Description d = description("linear-rolling", sand, jumble({14, 14, 14}, spacing, 0.02, 5));
  const char* const names[3][2] = {{"left", "right"}, {"front", "back"}, {"bottom", "lid"}};
  for (int axis = 0; axis < 3; ++axis)
    for (const bool up : {true, false})
      d["walls"][names[axis][up ? 0 : 1]] = side(axis, up ? low[axis] : high[axis], low, high, up);
  d["walls"]["lid"]["motion"]["servo"] = {{"axis", "z"}, {"pressure", 1e4}, {"max_velocity", 0.5}};
  d["walls"]["bottom"]["motion"]["velocity"] = {0.05, 0, 0};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.3}};
  d["engines"]["gravity"] = {{"type", "gravity"}};
  d["guards"] = {{"overlap", 0.5}, {"travel", 0.2}, {"energy", 1}};
  return d;
}

/// 2744 grains without a wall, compressed along x and y at this rate [1/s], stretched along z.
Description periodic(double rate = 18) {
  const double spacing = 1e-3;
  Description d = description("linear-rolling", sand, jumble({14, 14, 14}, spacing, 0.02, 6));
  d["domain"] = {{"low", {0, 0, 0}},
                 {"high", {14 * spacing, 14 * spacing, 14 * spacing}},
                 {"periodic", {true, true, true}},
                 {"strain_rate", {-rate, -rate, 0.75 * rate}}};
  d["guards"] = {{"overlap", 0.5}, {"travel", 0.2}, {"energy", 1}};
  return d;
}

/// The same, sheared at constant normal stress.
Description sheared() {
  Description d = periodic();
  d["domain"].erase("strain_rate");
  d["domain"]["shear_rate"] = {{"xz", 150}, {"yz", -100}};
  d["domain"]["servo"] = {{"stress", {{"zz", 2e4}, {"xy", 0}}}, {"max_strain_rate", 50}, {"interval", 7}};
  return d;
}

/// The same under prescribed stresses along x and y.
Description under_stress() {
  Description d = periodic();
  d["domain"]["strain_rate"] = {0, 0, 15};
  d["domain"]["servo"] = {{"stress", {{"xx", 2e4}, {"yy", 1e4}}}, {"max_strain_rate", 50}, {"interval", 7}};
  return d;
}

/// Springs that stiffen, so that the time step follows the overlaps.
Description stiffening() {
  Description d = boxed();
  d["contacts"]["type"] = "hertz-mindlin";
  d["materials"]["grain"] = {{"density", 2600}, {"young_modulus", 1e7}, {"poisson_ratio", 0.2}, {"restitution", 0.5}};
  return d;
}

/// Bodies that attract each other and the walls, beyond contact.
Description cohesive(Description d, double strength) {
  d["contacts"]["type"] = "linear-cohesive";
  d["materials"]["grain"].update({{"tensile_strength", strength}, {"rolling_stiffness", 0.5}, {"rolling_limit", 0.2}});
  return d;
}

void expect_same_bits(const Description& d) {
  Trial asked(d, 1);
  std::deque<Trial> others;
  const std::array<unsigned, 4> threads{1, 2, 3, 7};
  for (const unsigned count : threads) others.emplace_back(d, count);
  ASSERT_EQ(others.back().kernel().threads(), 7u);
  const std::size_t steps = 125;
  for (int round = 0; round < 8; ++round) {
    asked.kernel().request_rebuild();  // the ninth sorts bodies
    asked.step(steps);
    for (std::size_t i = 0; i < threads.size(); ++i) {
      others[i].kernel().request_rebuild();
      others[i].step_on(steps);
      ASSERT_TRUE(same_bits(asked.kernel(), others[i].kernel()))
          << threads[i] << " threads, step " << asked.world().step();
    }
  }
  EXPECT_GT(asked.kernel().state().pairs.touching_count(), 2744u) << "a packing";
  EXPECT_GT(asked.kernel().state().lists.rebuilds(), 8u) << "bodies are reordered in between";
}

/// The energy balance uses separate loops and a fixed order of sums, with or without queries of forces.
void expect_energies_change_nothing(const Description& d) {
  Trial without(d, 2), with(d, 2, BodyState::energy), other(d, 7, BodyState::energy);
  for (Trial* trial : {&with, &other}) trial->world().energies();
  without.step_on(700), with.step_on(700), other.step(700);
  EXPECT_TRUE(same_bits(without.kernel(), with.kernel()));
  const Energies a = with.world().energies(), b = other.world().energies();
  EXPECT_GT(a.friction, 0);
  for (const auto entry : {&Energies::kinetic, &Energies::elastic_normal, &Energies::elastic_shear,
                           &Energies::elastic_rolling, &Energies::friction, &Energies::rolling, &Energies::viscosity,
                           &Energies::local_damping, &Energies::gravitational, &Energies::walls, &Energies::cell,
                           &Energies::engines, &Energies::settings, &Energies::closure_error})
    EXPECT_EQ(a.*entry, b.*entry);
}

TEST(SameBits, WhetherOrNotEnergiesAreKept) {
  expect_energies_change_nothing(boxed());
  expect_energies_change_nothing(periodic());
  expect_energies_change_nothing(under_stress());
  expect_energies_change_nothing(sheared());
  expect_energies_change_nothing(stiffening());
  expect_energies_change_nothing(cohesive(boxed(), 2e4));
  expect_energies_change_nothing(cohesive(periodic(), 2e4));
  Description held = periodic();
  held["engines"]["hold"] = {{"type", "hold"}}, held["guards"]["overlap"] = 0.9;
  expect_energies_change_nothing(held);
}

TEST(SameBits, OfAPackingBetweenWalls) { expect_same_bits(boxed()); }

TEST(SameBits, WhereCandidatesAtWallsAloneAreFoundAgain) {
  Description d = boxed();
  d["walls"]["bottom"]["motion"]["velocity"] = {1, 0, 0};
  Trial one(d, 1);
  std::deque<Trial> others;
  for (const unsigned count : {2u, 3u, 7u}) others.emplace_back(d, count);
  for (int round = 0; round < 3; ++round) {
    one.step(100);
    for (Trial& other : others) {
      other.step_on(100);
      ASSERT_TRUE(same_bits(one.kernel(), other.kernel()))
          << other.kernel().threads() << " threads, step " << one.world().step();
    }
  }
  EXPECT_GT(one.kernel().state().lists.searches_at_walls(), 0u);
}

TEST(SameBits, OfAPeriodicPackingThatDeforms) { expect_same_bits(periodic()); }
TEST(SameBits, OfAPeriodicPackingUnderPrescribedStresses) { expect_same_bits(under_stress()); }
TEST(SameBits, OfAPackingThatIsSheared) { expect_same_bits(sheared()); }
TEST(SameBits, OfSpringsThatStiffen) { expect_same_bits(stiffening()); }
TEST(SameBits, OfBodiesThatAttract) {
  expect_same_bits(cohesive(boxed(), 2e4));
  // Attraction resists no compression. At 10/s, 1000 steps of 15 µs compress the cell by a factor of exp(−0.15). If all
  // bodies followed it, the nearest neighbours, 0.94 mm apart with radii of 0.535 mm, would overlap by 0.49 radii: less
  // than the guard allows.
  expect_same_bits(cohesive(periodic(10), 2e4));
}

TEST(SameBits, OfOneThatIsPressedAndShortensTheTimeStep) {
  Description d =
      description("hertz-mindlin", {{"young_modulus", 1e8}, {"poisson_ratio", 0.2}}, {{{0, 0, 1e-3}, 1e-3}});
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["walls"]["lid"] = plane({0, 0, 2e-3}, -Vec3::UnitZ());
  d["walls"]["lid"]["motion"]["velocity"] = {0, 0, -5e-3};
  Trial asked(d), other(d);
  const double first = asked.world().dt();
  while (asked.world().time() < 4e-3) {
    asked.step(3), other.step_on(3);
    ASSERT_TRUE(same_bits(asked.kernel(), other.kernel())) << "step " << asked.world().step();
  }
  EXPECT_LT(asked.world().dt(), 0.8 * first);
}

TEST(SameBits, OfOneThatFallsAndShortensTheTimeStep) {
  Description d =
      description("hertz-mindlin", {{"young_modulus", 1e8}, {"poisson_ratio", 0.2}}, {{{0, 0, 3e-3}, 1e-3}});
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["engines"]["gravity"] = {{"type", "gravity"}};
  Trial asked(d), other(d);
  const double first = asked.world().dt();
  bool touched = false;
  while (!touched || !asked.world().contacts().empty()) {
    asked.step(3), other.step_on(3);
    ASSERT_TRUE(same_bits(asked.kernel(), other.kernel())) << "step " << asked.world().step();
    ASSERT_LT(asked.world().time(), 0.1);
    touched = touched || !asked.world().contacts().empty();
  }
  EXPECT_LT(asked.world().dt(), 0.8 * first);
}

TEST(SameBits, DifferFromOthers) {
  Trial one(periodic()), other(periodic());
  EXPECT_TRUE(same_bits(one.kernel(), other.kernel()));
  one.step();
  EXPECT_FALSE(same_bits(one.kernel(), other.kernel()));
}

}  // namespace
}  // namespace grit::test::same_bits_tests
