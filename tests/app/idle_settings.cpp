// Studies warn of values that no run depends on.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "scenes.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(IdleSettings, AreWarnedOfIfTheyHaveNoEffectInAnyVariant) {
  const OwnFolder folder;
  auto scene = json::parse(two_grains);
  scene["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0}};
  folder.write("two.json", scene.dump());
  json study = {{"scene", "two.json"},
                {"settings", {{"damping", {{"pointers", {"/engines/damping/coefficient"}}, {"values", {0.5, 0}}}}}},
                {"seeds", {{"values", {1}}}},
                {"metrics", {{"energy", {{"type", "last"}, {"of", "packing/kinetic_energy"}}}}}};
  const auto dry = [&] {
    folder.write("study.json", study.dump());
    return grit_in(folder.path(), {"study", "study.json", "--dry-run"});
  };
  // Damping of 0 has no effect, but the other variant has.
  const auto whole = dry();
  EXPECT_EQ(whole.status, 0);
  EXPECT_THAT(whole.err, Not(HasSubstr("without effect")));

  study["set"] = {{"/materials/snd/density", 2000}};
  study["settings"]["friction"] = {{"pointers", {"/materials/sand/friction_angle", "/materials/snd/friction_angle"}},
                                   {"values", {{0.2, 0.2}, {0.5, 0.5}}}};
  const auto misspelt = dry();
  EXPECT_EQ(misspelt.status, 0);
  EXPECT_THAT(misspelt.out, HasSubstr("4 of 4 runs are missing in results/study"));
  EXPECT_THAT(misspelt.err,
              AllOf(HasSubstr("grit: warning: study.json:1: /settings/friction/pointers/1: without effect: "
                              "/materials/snd: no body and no wall uses it"),
                    HasSubstr("grit: warning: study.json:1: /set/~1materials~1snd~1density: without effect: "),
                    Not(HasSubstr("/pointers/0"))));
}

}  // namespace
}  // namespace grit
