#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kernel/energy_balance.hpp"
#include "kernel/energy_guard.hpp"
#include "kernel/world_view.hpp"
#include "two_spheres.hpp"

namespace grit::test::energy_tests {
namespace {

/// Two spheres that overlap by a hundredth of their radius.
class Energy : public testing::Test {
 protected:
  static constexpr double overlap = 0.01 * radius;
  Energy() {
    state_.time.dt = 1e-7;
    search(state_, passes_);
    evaluate(state_);
    view_.set_balance(balance_);
  }
  /// Stiffness of the spring between them [N/m].
  double stiffness() const {
    return state_.settings.law
        ->stiffness({.radius_a = radius,
                     .radius_b = radius,
                     .inverse_mass_a = 1 / sphere_mass(),
                     .inverse_mass_b = 1 / sphere_mass(),
                     .overlap = overlap},
                    0, 0)
        .normal;
  }
  State state_ = two_spheres(2 * radius - overlap);
  Passes passes_{1};
  WorldView view_{state_, passes_};
  EnergyBalance balance_{state_, view_, passes_};
  EnergyGuard guard_;
};

TEST_F(Energy, OfASpringIsHalfItsStiffnessTimesItsOverlapSquared) {
  const double expected = 0.5 * stiffness() * overlap * overlap;
  EXPECT_NEAR(balance_.elastic().normal, expected, 1e-10 * expected);
  EXPECT_EQ(balance_.elastic().shear, 0);
}

TEST_F(Energy, OfMotionAndHeight) {
  set_velocity(state_, 0, {0, 0, 2});
  state_.settings.motion.gravity = {0, 0, -10};
  state_.bodies.position[1].z = 0.003;
  EXPECT_NEAR(balance_.kinetic(), 2 * sphere_mass(), 1e-12 * sphere_mass());
  EXPECT_NEAR(balance_.gravitational(), sphere_mass() * 10 * 0.003, 1e-12 * sphere_mass());
}

TEST_F(Energy, BalanceBeginsWhenAsked) {
  state_.bodies.state = BodyState::energy;
  EXPECT_FALSE(balance_.is_kept());
  EXPECT_EQ(balance_.terms().closure_error, 0);
  EXPECT_TRUE(balance_.is_kept());
  balance_.add_step(0.25);
  EXPECT_EQ(balance_.terms().walls, 0.25);
  EXPECT_EQ(balance_.terms().closure_error, -0.25) << "work that is not stored in a spring";
  balance_.add_settings(0.5);
  EXPECT_EQ(balance_.terms().settings, 0.5);
}

TEST_F(Energy, ChangesOfSettingsAreBooked) {
  state_.bodies.state = BodyState::energy;
  balance_.terms();
  balance_.book_elastic([this] { state_.bodies.position[1].x += overlap; });  // the spring is gone
  const double expected = -0.5 * stiffness() * overlap * overlap;
  EXPECT_NEAR(balance_.terms().settings, expected, 1e-10 * std::abs(expected));
}

TEST_F(Energy, GuardTripsOnGainsAlone) {
  guard_.check(state_, balance_);  // starts
  set_velocity(state_, 0, {0, 0, 0});
  guard_.check(state_, balance_);
  const double stored = balance_.elastic().total();
  set_velocity(state_, 0, {0, std::sqrt(2 * 0.04 * stored / sphere_mass()), 0});
  EXPECT_NO_THROW(guard_.check(state_, balance_)) << "4 % are allowed";
  set_velocity(state_, 0, {0, std::sqrt(2 * 0.1 * stored / sphere_mass()), 0});
  try {
    guard_.check(state_, balance_);
    FAIL();
  } catch (const NumericsError& error) {
    EXPECT_EQ(error.guard(), Guard::energy);
    EXPECT_THAT(error.what(), testing::HasSubstr("0.09091 of the largest energy so far"));
  }
}

TEST_F(Energy, GuardCountsTheWorkOfWalls) {
  guard_.check(state_, balance_);
  const double stored = balance_.elastic().total();
  set_velocity(state_, 0, {0, std::sqrt(2 * stored / sphere_mass()), 0});
  guard_.add_work_of_walls(stored);
  EXPECT_NO_THROW(guard_.check(state_, balance_));
}

TEST_F(Energy, GuardChecksOftenAtFirst) {
  EXPECT_TRUE(guard_.due(7)) << "it has not started";
  guard_.check(state_, balance_);
  for (const std::uint64_t step : {64u, 128u, 256u, 500u, 1000u}) EXPECT_TRUE(guard_.due(step)) << step;
  for (const std::uint64_t step : {1u, 63u, 512u, 501u}) EXPECT_FALSE(guard_.due(step)) << step;
}

}  // namespace
}  // namespace grit::test::energy_tests
