// Runs that begin from a prepared sample: the state of another run.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "output/read_results.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

/// Grains in a box under a lid that presses on them.
constexpr auto prepare = R"({
  "title": "a sample under a lid",
  "contacts": {"type": "linear-rolling"},
  "materials": {"sand": {"density": 2600, "contact_modulus": "10 MPa", "friction_angle": "30 deg", "rolling_stiffness": 0.3, "rolling_limit": 0.2}},
  "bodies": {"grains": {"type": "sphere", "material": "sand", "source": {
    "type": "cloud", "low": [0, 0, 0], "high": ["10 mm", "10 mm", "20 mm"], "count": 80,
    "sizes": {"type": "uniform", "smallest": "2 mm", "largest": "2.5 mm"}}}},
  "walls": {
    "box": {"type": "box", "low": [0, 0, 0], "high": ["10 mm", "10 mm", "30 mm"], "open": ["z_high"], "material": "sand"},
    "lid": {"type": "plane", "point": [0, 0, "25 mm"], "normal": [0, 0, -1], "area": "1e-4 m^2", "material": "sand",
            "motion": {"servo": {"pressure": "10 kPa", "max_velocity": "0.5 m/s"}}}},
  "engines": {"gravity": {"type": "gravity"}, "damping": {"type": "local-damping", "coefficient": 0.3}},
  "stages": [{"name": "press", "until": {"type": "all", "of": [{"type": "at-rest", "below": 1e-5}, {"type": "pressure", "wall": "lid", "value": "10 kPa", "within": 1e-3}]}, "limit": "2 s"}],
  "probes": {"walls": {"type": "walls", "every_time": "1 ms"}, "packing": {"type": "packing", "every_time": "1 ms"},
             "energy": {"type": "energy", "every_time": "1 ms"}}
}
)";

/// What a test after it has in common.
constexpr auto go_on = R"({
  "extends": "prepare.json",
  "begin": {"from": "sample"},
  "bodies": {"grains": {"source": {"type": "sample", "low": null, "high": null, "count": null, "sizes": null}}},
  "stages": [{"name": "test", "until": {"type": "time", "value": "5 ms"}, "limit": "1 s"}]
}
)";

class Samples : public testing::Test {
 protected:
  Samples() { folder.write("prepare.json", prepare), folder.write("test.json", go_on); }
  Outcome grit(std::vector<std::string> words) const { return grit_in(folder.path(), std::move(words)); }
  Outcome run(const std::string& file, const std::string& out, const std::vector<std::string>& sets = {}) const {
    std::vector<std::string> words{"run", file, "--no-report", "--quiet", "--overwrite", "--out", out};
    for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
    return grit(words);
  }
  void prepare_sample() const {
    const auto prepared = run("prepare.json", "sample");
    ASSERT_EQ(prepared.status, 0) << prepared.err;
    ASSERT_TRUE(std::filesystem::exists(folder / "sample/final.h5"));
  }
  /// A test from the sample must be refused with these messages.
  void refuses(const std::vector<std::string>& sets, const testing::Matcher<const std::string&>& message) const {
    const auto refused = run("test.json", "refused", sets);
    EXPECT_EQ(refused.status, 2) << refused.out;
    EXPECT_THAT(refused.err, message);
    EXPECT_FALSE(std::filesystem::exists(folder / "refused"));
  }
  std::vector<double> series(const std::string& out, const std::string& channel) const {
    return SeriesFile(folder / out).channel(channel).values;
  }

  OwnFolder folder;
};

TEST_F(Samples, GoOnAtTheSameStress) {
  prepare_sample();
  const auto test = run("test.json", "test");
  ASSERT_EQ(test.status, 0) << test.err;
  const double pressure = series("sample", "walls/lid_pressure").back();
  ASSERT_NEAR(pressure, 1e4, 10);
  EXPECT_NEAR(series("test", "walls/lid_pressure").front(), pressure, 1e-6 * pressure);
  for (const char* contacts : {"packing/coordination_number", "packing/mean_contact_force"})
    EXPECT_NEAR(series("test", contacts).front(), series("sample", contacts).back(),
                1e-9 * series("sample", contacts).back());
  for (const char* energy : {"energy/elastic_normal", "energy/elastic_shear", "energy/elastic_rolling"}) {
    ASSERT_GT(series("sample", energy).back(), 0);
    EXPECT_NEAR(series("test", energy).front(), series("sample", energy).back(), 1e-6 * series("sample", energy).back())
        << energy;
  }
  // It stays at rest: no spring was lost.
  const auto kinetic = series("test", "energy/kinetic");
  EXPECT_LT(*std::ranges::max_element(kinetic), 1e-4 * series("test", "energy/elastic_normal").front());
  const auto positions = series("test", "walls/lid_position"), before = series("sample", "walls/lid_position");
  EXPECT_NEAR(positions.front() + positions[2], before[before.size() - 3] + before.back(), 1e-9);
  EXPECT_NEAR(positions.back(), before.back(), 1e-7);
}

TEST_F(Samples, DroppedSpringsMoveGrains) {
  prepare_sample();
  ASSERT_EQ(run("test.json", "test", {"/begin/springs=drop"}).status, 0);
  EXPECT_EQ(series("test", "energy/elastic_shear").front(), 0);
  EXPECT_GT(series("test", "energy/elastic_normal").front(), 0);
}

TEST_F(Samples, MayBeACheckpoint) {
  const auto failed = run("prepare.json", "sample", {"/stages/0/limit=20 ms"});
  ASSERT_EQ(failed.status, 4) << failed.err;
  refuses({}, HasSubstr("holds no final.h5"));
}

TEST_F(Samples, MayChangeMaterialsWallsAndStages) {
  prepare_sample();
  const auto test =
      run("test.json", "test",
          {R"(/materials/steel={"density": 7800, "contact_modulus": "20 MPa"})", "/walls/box/material=steel",
           R"(/walls/post={"type": "plane", "point": [0, 0, "-1 mm"], "material": "steel"})",
           "/walls/lid/motion/servo/pressure=20 kPa", "/stages/0/until/value=20 ms"});
  ASSERT_EQ(test.status, 0) << test.err;
  EXPECT_NEAR(series("test", "walls/lid_pressure").back(), 2e4, 200);
  // Others may be added; they keep clear of the sample.
  const auto more =
      run("test.json", "more", {R"(/bodies/more={"type": "sphere", "material": "sand", "source": {"type": "list",
                            "bodies": [{"position": ["50 mm", "5 mm", "5 mm"], "radius": "1 mm"}]}})"});
  ASSERT_EQ(more.status, 0) << more.err;
  EXPECT_EQ(json::parse(text_of(folder / "more/run.json")).at("bodies"), 81);
}

TEST_F(Samples, SayWhatCannotBeTakenOver) {
  prepare_sample();
  refuses({"/begin/from=nothing"}, AllOf(HasSubstr("/begin/from"), HasSubstr("nothing: holds no final.h5")));
  refuses({"/begin/at=checkpoint"}, HasSubstr("begin at its end with \"at\": \"end\""));
  refuses({"/contacts/type=linear-frictional", "/materials/sand/rolling_stiffness=null",
           "/materials/sand/rolling_limit=null"},
          AllOf(HasSubstr("/contacts"), HasSubstr("have the history \"rolling"), HasSubstr("\"springs\": \"drop\"")));
  refuses({R"(/domain={"low": [0, 0, 0], "high": [0.01, 0.01, 0.03], "periodic": [true, true, false]})"},
          AllOf(HasSubstr("/domain/periodic"), HasSubstr("periodic along other axes")));
  refuses({R"(/bodies/others={"type": "sphere", "material": "sand", "source": {"type": "sample"}})"},
          AllOf(HasSubstr("/bodies/others"), HasSubstr("has no group of this name; it has \"grains\"")));
  refuses(
      {"/bodies/grains=null", R"(/bodies/others={"type": "sphere", "material": "sand", "source": {"type": "sample"}})"},
      HasSubstr("has a group \"grains\", which is not described"));
  refuses({"/begin=null"}, AllOf(HasSubstr("/bodies/grains/source"), HasSubstr("without /begin")));
}

}  // namespace
}  // namespace grit
