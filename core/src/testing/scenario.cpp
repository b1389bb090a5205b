#include "grit/testing/scenario.hpp"

#include <set>

namespace grit {

int scenario_contract() { return 0; }

namespace {

TEST_P(ScenarioContract, DocumentsItsParameters) {
  const auto scenario = GetParam().make();
  Parameters parameters;
  scenario->declare(parameters);
  std::set<std::string> names;
  for (const auto& parameter : parameters.entries()) {
    EXPECT_TRUE(names.insert(parameter.name()).second) << parameter.name() << " is declared twice";
    EXPECT_FALSE(parameter.doc().empty()) << parameter.name();
  }
}

TEST_P(ScenarioContract, ExpandsToADescription) {
  const Description plain = made()->expand();
  ASSERT_TRUE(plain.is_object());
  for (const char* section : {"materials", "contacts", "bodies", "stages"})
    EXPECT_TRUE(plain.contains(section)) << section;
  EXPECT_FALSE(plain.contains("scenario"));
}

TEST_P(ScenarioContract, ExpandsToTheSameAgain) {
  const auto scenario = made();
  const Description first = scenario->expand();
  EXPECT_EQ(scenario->expand(), first);
  EXPECT_EQ(made()->expand(), first);
}

}  // namespace
}  // namespace grit
