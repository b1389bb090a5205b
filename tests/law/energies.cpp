// What the contract of contact laws says of laws that report wrong energies.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grit/testing/energy_paths.hpp"
#include "grit/testing/laws.hpp"
#include "plugins/registry.hpp"
#include "support/misreported.hpp"

namespace grit::test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;

const Values springs{
    {"contact_modulus", 1e6},    {"friction_angle", 0.4},  {"rolling_stiffness", 0.7},        {"rolling_limit", 0.4},
    {"twisting_stiffness", 0.5}, {"twisting_limit", 0.15}, {"shear_to_normal_stiffness", 0.4}};
const Values damped{{"contact_modulus", 1e6}, {"friction_angle", 0.0}, {"restitution", 0.4}, {"rolling_limit", 0.0}};

std::vector<std::string> faults_of(const Values& material, const Misreport& factors, bool losses = true) {
  static const Registry registry({GRIT_PLUGIN_DIR});
  const std::shared_ptr<ContactLaw> law = registry.make<ContactLaw>("linear-rolling");
  Parameters parameters;
  law->declare_material("m0", parameters);
  assign(parameters, material);
  const std::vector<std::string> names{"m0"};
  law->mix(names, 1);
  return energy_faults(MisreportedLaw(law, factors), losses);
}

TEST(EnergiesOfALaw, AreRight) {
  EXPECT_THAT(faults_of(springs, {}), IsEmpty());
  EXPECT_THAT(faults_of(damped, {}), IsEmpty());
}

TEST(EnergiesOfALaw, MissWorkOfADashpotThatIsForgotten) {
  EXPECT_THAT(faults_of(damped, {.viscosity = 0}),
              AllOf(Contains(AllOf(HasSubstr("bodies that are pressed: "), HasSubstr("is reported nowhere"))),
                    Each(HasSubstr("a law without losses() says so by LawSetup::losses = false"))));
}

TEST(EnergiesOfALaw, ExceedTheWorkWhereThatOfADashpotIsDoubled) {
  EXPECT_THAT(faults_of(damped, {.viscosity = 2}),
              Contains(AllOf(HasSubstr("bodies that are pressed and parted"), HasSubstr("is reported without work"))));
}

TEST(EnergiesOfALaw, ComeBackFromADashpotOfTheWrongSign) {
  EXPECT_THAT(faults_of(damped, {.viscosity = -1}),
              AllOf(Contains(HasSubstr("is reported nowhere")), Contains(HasSubstr("was lost and came back"))));
}

TEST(EnergiesOfALaw, MissWorkOfSlipThatIsForgotten) {
  EXPECT_THAT(faults_of(springs, {.friction = 0}), Contains(HasSubstr("bodies that are sheared: ")));
  EXPECT_THAT(faults_of(springs, {.rolling = 0}),
              AllOf(Contains(HasSubstr("bodies that are rolled: ")), Contains(HasSubstr("bodies that are twisted: "))));
}

TEST(EnergiesOfALaw, DoNotFitWhereAnElasticEnergyHasAWrongFactor) {
  EXPECT_THAT(faults_of(springs, {.elastic_normal = 2}), Contains(HasSubstr("bodies that are pressed: ")));
  EXPECT_THAT(faults_of(springs, {.elastic_shear = 0.5}), Contains(HasSubstr("bodies that are sheared: ")));
  EXPECT_THAT(faults_of(springs, {.elastic_rolling = 0.5}), Contains(HasSubstr("bodies that are rolled: ")));
}

TEST(EnergiesOfALaw, AreNotCreatedByOneThatReportsNoLosses) {
  const Misreport none{.friction = 0, .rolling = 0, .viscosity = 0};
  EXPECT_THAT(faults_of(springs, none, false), IsEmpty());
  EXPECT_THAT(faults_of(springs, {.friction = 0, .rolling = 0, .elastic_normal = 2}, false),
              Contains(HasSubstr("is reported without work")));
  EXPECT_THAT(faults_of(springs, {}, false), Contains(HasSubstr("set LawSetup::losses")));
}

}  // namespace
}  // namespace grit::test
