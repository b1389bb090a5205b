// No guard trips in the small descriptions of sims/: all run to their end.
#include <gtest/gtest.h>

#include "support/mapped.hpp"
#include "support/notes.hpp"
#include "support/recorded.hpp"

namespace grit::test::false_alarms_tests {
namespace {

/// Returns the number of grains. The energy guard uses the stored energy, or the energy balance.
std::size_t expect_done(const std::string& file, const std::vector<std::string>& sets, bool by_energy) {
  const StateRequest also = by_energy ? StateRequest(BodyState::energy) : StateRequest();
  Scene scene = load_scene(std::string(GRIT_SOURCE_DIR) + "/sims/" + file, sets, installed());
  const std::size_t stages = scene.stages.size();
  const StateRequest state = requested_state(LiveScene(scene).components(), also);
  Notes notes;
  Simulation simulation = recorded(std::move(scene), notes, 2, state);
  run_recorded(simulation);
  EXPECT_EQ(notes.summary.status, "done") << notes.summary.message;
  EXPECT_EQ(notes.ended.size(), stages);
  EXPECT_GT(simulation.world().step(), 1000u);
  return simulation.world().positions().size();
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
  std::vector<std::string> loose = small;
  loose.push_back("/scenario/void_ratio=0.74");
  for (const auto& [file, sets] :
       {std::pair{"direct-shear/quick.json", small}, {"direct-shear/quick-loose.json", loose}})
    figure("grains in the box that is sheared", static_cast<double>(expect_done(file, sets, GetParam())));
  figure("way that the box is sheared, in mm", 1e3 * sheared);
}

INSTANTIATE_TEST_SUITE_P(All, FalseAlarms, testing::Bool(),
                         [](const auto& info) { return info.param ? "by_the_ledger" : "by_what_is_stored"; });

}  // namespace
}  // namespace grit::test::false_alarms_tests
