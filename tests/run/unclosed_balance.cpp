// The warning of a run whose energy balance does not close.
#include "run/unclosed_balance.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/misreported.hpp"
#include "support/notes.hpp"

namespace grit::test::unclosed_balance_tests {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Misreport& factors() {
  static Misreport one;
  return one;
}

/// Two damped grains that collide head-on, with a law that reports these energies, by /contacts/type "misreported".
/// They keep a quarter of their energy.
Description collision(const Misreport& misreport, bool probe = true) {
  static const PluginInfo law = [] {
    PluginInfo info;
    info.kind = "contact", info.name = "misreported", info.version = "1.0.0", info.doc = "of a test";
    info.make_contact = []() -> ContactLaw* {
      return new MisreportedLaw(installed().make<ContactLaw>("linear-rolling"), factors());
    };
    return info;
  }();
  installed().add(law);
  factors() = misreport;
  const double radius = 1e-3;
  Description d = description("misreported", {{"contact_modulus", 1e7}, {"density", 2600}, {"restitution", 0.5}},
                              {{Vec3::Zero(), radius, {1, 0, 0}}, {{2.01 * radius, 0, 0}, radius, {-1, 0, 0}}});
  d["time_step"]["safety"] = 0.02;
  d["stages"][0]["until"] = {{"type", "time"}, {"value", 1e-3}};
  d["guards"]["energy"] = 10;
  if (probe) d["probes"]["energy"] = {{"type", "energy"}, {"every_steps", 100}};
  return d;
}
std::vector<std::string> warnings_of(const Description& d) {
  Notes notes;
  Simulation simulation = recorded(scene_of(d), notes);
  run_recorded(simulation);
  EXPECT_EQ(notes.summary.status, "done") << notes.summary.message;
  return notes.summary.warnings;
}

TEST(UnclosedBalance, IsWarnedOfWhereADashpotForgetsItsWork) {
  EXPECT_THAT(warnings_of(collision({.viscosity = 0})),
              ElementsAre(AllOf(
                  HasSubstr("the energy balance does not close: "), HasSubstr(" J have gone nowhere, 75 % of"),
                  HasSubstr("J, initial energy); allowed is 1.0 %; try a smaller step (/time_step/safety); if the "
                            "error stays, the losses() of the contact law \"misreported\" may be wrong"))));
}

TEST(UnclosedBalance, IsWarnedOfWhereADashpotReportsItsWorkTwice) {
  EXPECT_THAT(warnings_of(collision({.viscosity = 2})),
              ElementsAre(AllOf(HasSubstr(" J are more than there were and were put in, 50 % of"),
                                HasSubstr("J, dissipated energy)"))));
}

TEST(UnclosedBalance, IsNotWarnedOfWhereItCloses) { EXPECT_THAT(warnings_of(collision({})), IsEmpty()); }

/// The run could keep an energy balance, but nothing in it uses one.
TEST(UnclosedBalance, IsNotLookedForWhereNoneIsKept) {
  Notes notes;
  Simulation simulation = recorded(scene_of(collision({.viscosity = 0}, false)), notes, 1, BodyState::energy);
  run_recorded(simulation);
  EXPECT_THAT(notes.summary.warnings, IsEmpty());
  EXPECT_FALSE(kernel_of(simulation).keeps_energy_balance());
}

TEST(UnclosedBalance, IsOneOfMoreThanAHundredthOfTheLargestTerm) {
  // Initially 10 J, of which 4 J are left and 5.95 J are dissipated.
  Energies balance{.kinetic = 4, .friction = 5, .viscosity = 0.95, .closure_error = -0.05};
  EXPECT_DOUBLE_EQ(largest_term(balance).energy, 10);
  EXPECT_STREQ(largest_term(balance).name, "initial energy");
  EXPECT_THAT(unclosed_balance(balance, "a"), IsEmpty());
  balance.viscosity = 0.8, balance.closure_error = -0.2;
  EXPECT_THAT(unclosed_balance(balance, "a"),
              HasSubstr("0.2 J have gone nowhere, 2.0 % of the energy turned over (10 J"));
  // Walls do 50 J more, which are dissipated.
  balance.walls = 50, balance.friction += 50;
  EXPECT_STREQ(largest_term(balance).name, "dissipated energy");
  EXPECT_THAT(unclosed_balance(balance, "a"), IsEmpty());
  // A fall of 100 J.
  balance.gravitational = -100, balance.kinetic += 100;
  EXPECT_DOUBLE_EQ(largest_term(balance).energy, 104);
  EXPECT_THAT(unclosed_balance({}, "a"), IsEmpty());
  // Attraction stores negative energy.
  EXPECT_STREQ(largest_term({.elastic_normal = -3, .closure_error = -3}).name, "elastic energy");
}

}  // namespace
}  // namespace grit::test::unclosed_balance_tests
