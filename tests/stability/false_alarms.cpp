// No guard trips in what sims/ has: its small descriptions run to their end.
#include <gtest/gtest.h>

#include "support/mapped.hpp"
#include "support/notes.hpp"

namespace grit::test::false_alarms_tests {
namespace {

/// Returns how many grains there were. The guard of energies goes by what is stored, or by the ledger.
std::size_t expect_done(const std::string& file, const std::vector<std::string>& sets, bool by_ledger) {
  const StateRequest also = by_ledger ? StateRequest(BodyState::energy) : StateRequest();
  Scene described = load_scene(std::string(GRIT_SOURCE_DIR) + "/sims/" + file, sets, installed());
  const StateRequest state = requested_state(LiveScene(described).components(), also);
  Started started(std::move(described), 2, state);
  auto& [scene, live, kernel] = started;
  kernel.find_forces();
  kernel.world().energies();
  Notes notes;
  run(scene, live, kernel, notes, {});
  EXPECT_EQ(notes.summary.status, "done") << notes.summary.message;
  EXPECT_EQ(notes.ended.size(), scene.stages.size());
  EXPECT_GT(kernel.world().step(), 1000u);
  return kernel.world().positions().size();
}

class FalseAlarms : public testing::TestWithParam<bool> {};

TEST_P(FalseAlarms, NoneInTheColumn) {
  expect_done("column/quick.json", {}, GetParam());
  figure("overlap that the usual guard allows, in radii", GuardsDescription().overlap);
}
TEST_P(FalseAlarms, NoneInTheOedometer) { expect_done("oedometer/quick.json", {}, GetParam()); }
TEST_P(FalseAlarms, NoneInDirectShear) {
  // A small box, dense and loose.
  constexpr double sheared = 1e-4;
  const std::vector<std::string> small{"/scenario/width=6e-3", "/scenario/height=5e-3",
                                       "/scenario/depth_boundary=periodic",
                                       "/scenario/shear_displacement=" + std::to_string(sheared)};
  for (const char* file : {"direct-shear/quick.json", "direct-shear/quick-loose.json"})
    figure("grains in the box that is sheared", static_cast<double>(expect_done(file, small, GetParam())));
  figure("way that the box is sheared, in mm", 1e3 * sheared);
}

INSTANTIATE_TEST_SUITE_P(All, FalseAlarms, testing::Bool(),
                         [](const auto& info) { return info.param ? "by_the_ledger" : "by_what_is_stored"; });

}  // namespace
}  // namespace grit::test::false_alarms_tests
