// Doubtful densities and attractions of materials, of which `check` warns.
#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "scenes.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(Descriptions, CheckWarnsOfDensitiesThatNoSolidHas) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto check = [&](const std::string& density) {
    const auto outcome = grit_in(folder.path(), {"check", "two.json", "--set", R"(/materials/glass={"density": 1})",
                                                 "--set", "/materials/sand/density=" + density});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  const std::string warning = "\nwarning\n  /materials/sand/density: ";
  EXPECT_THAT(check("2.65"),
              HasSubstr(warning + "2.65 kg/m^3 is far from any solid; did you mean 2.65 g/cm^3? A density that "));
  EXPECT_THAT(check("2.65e6"), HasSubstr(warning + "2.65e+06 kg/m^3 is far from any solid; is the unit right? "));
  for (const char* density : {"2.65 g/cm^3", "50", "25000"})
    EXPECT_THAT(check(density), testing::Not(HasSubstr("far from any solid"))) << "no body is of glass";
}

TEST(Descriptions, CheckWarnsOfAttractionWithinAStep) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto check = [&](std::vector<std::string> sets) {
    std::vector<std::string> words{
        "check", "two.json", "--set", "/contacts/type=linear-cohesive", "--set", "/materials/sand/contact_modulus=1e8"};
    for (const auto& set : sets) words.insert(words.end(), {"--set", set});
    return grit_in(folder.path(), words).out;
  };
  // The reach is π R times strength over modulus.
  EXPECT_THAT(
      check({"/materials/sand/tensile_strength=1e4"}),
      AllOf(HasSubstr("\nwarning\n  /time_step: bodies attract each other up to 3.1e-07 m apart, but may move by "
                      "4e-05 m in a step"),
            HasSubstr("/time_step/max_displacement\n")));
  const auto quiet = testing::Not(HasSubstr("attract each other"));
  EXPECT_THAT(check({"/materials/sand/tensile_strength=0"}), quiet);
  EXPECT_THAT(check({"/materials/sand/tensile_strength=1e4", "/time_step/max_displacement=3e-4"}), quiet);
  EXPECT_THAT(check({"/materials/sand/tensile_strength=2e6"}), quiet);
  EXPECT_THAT(check({"/materials/sand/tensile_strength=1e4", "/time_step/value=1e-9"}),
              HasSubstr("/time_step/value\n"));
}

}  // namespace
}  // namespace grit
