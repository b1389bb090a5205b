// No guard trips in what sims/ has: its small descriptions run to their end.
#include <gtest/gtest.h>

#include "support/notes.hpp"

namespace grit::test {
namespace {

void expect_done(const std::string& file, const std::vector<std::string>& sets) {
  const Scene scene = load_scene(std::string(GRIT_SOURCE_DIR) + "/sims/" + file, sets, installed());
  Simulation world(*scene.description, make_bodies(*scene.description, requested_state(*scene.description)), 2);
  Notes notes;
  run(scene, world, notes, {});
  EXPECT_EQ(notes.summary.status, "done") << notes.summary.message;
  EXPECT_EQ(notes.ended.size(), scene.stages.size());
  EXPECT_GT(world.step(), 1000u);
}

TEST(FalseAlarms, NoneInTheColumn) { expect_done("column/quick.json", {}); }
TEST(FalseAlarms, NoneInTheOedometer) { expect_done("oedometer/quick.json", {}); }
TEST(FalseAlarms, NoneInDirectShear) {
  // A box of some 650 grains, dense and loose.
  const std::vector<std::string> small{"/scenario/width=6e-3", "/scenario/height=5e-3",
                                       "/scenario/depth_boundary=periodic", "/scenario/shear_displacement=0.1e-3"};
  for (const char* file : {"direct-shear/quick.json", "direct-shear/quick-loose.json"}) expect_done(file, small);
}

}  // namespace
}  // namespace grit::test
