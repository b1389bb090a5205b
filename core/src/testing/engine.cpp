#include "grit/testing/engine.hpp"

#include <set>

namespace grit {

int engine_contract() { return 0; }

namespace {

TEST_P(EngineContract, DocumentsItsParameters) {
  Parameters parameters;
  engine_->declare(parameters);
  std::set<std::string> names;
  for (const auto& parameter : parameters.entries()) {
    EXPECT_TRUE(names.insert(parameter.name()).second) << parameter.name() << " is declared twice";
    EXPECT_FALSE(parameter.doc().empty()) << parameter.name();
  }
}

TEST_P(EngineContract, StartsIdentically) {
  const auto other = GetParam().make();
  for (int look = 0; look < 6; ++look)
    EXPECT_TRUE(same_bits(acted(*engine_, later(world_, look)), acted(*other, later(world_, look)))) << look;
}

/// State kept between steps must be in serialize(): a restored engine acts exactly as one that was not interrupted.
TEST_P(EngineContract, ContinuesFromACheckpoint) {
  const int looks = 12, stops_after = 6;
  std::shared_ptr<Engine> goes_on;
  for (int look = 0; look < looks; ++look) {
    const FakeWorld now = later(world_, look);
    const auto expected = acted(*engine_, now);
    if (goes_on) ASSERT_TRUE(same_bits(acted(*goes_on, now), expected)) << "sample " << look;
    if (look != stops_after) continue;
    goes_on = GetParam().make();
    restore_state(*goes_on, saved_state(*engine_));
    EXPECT_TRUE(saved_state(*goes_on) == saved_state(*engine_));
  }
}

}  // namespace
}  // namespace grit
