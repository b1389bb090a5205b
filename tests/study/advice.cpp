#include "study/advice.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "grit/error.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;

json effect(const char* setting, const char* level, double cost, double error, double standard_error) {
  return {{"setting", setting},
          {"level", level},
          {"cost", cost},
          {"figures",
           {{"peak", {{"error", error}, {"standard_error", standard_error}}},
            {"small", {{"error", 0.1 * error}, {"standard_error", 0.0}}}}}};
}

json levels(const std::vector<std::string>& labels) {
  json all = json::array();
  for (const auto& label : labels) all.push_back({{"label", label}, {"sets", {"/" + label}}});
  return {{"levels", all}};
}

/// rate: 4, 2, 1; size: big, small.
class AdviceOf : public testing::Test {
 protected:
  AdviceOf() {
    chart = {{"title", "t"},
             {"scenario", "box"},
             {"samples", 3},
             {"figures", {{"peak", json::object()}, {"small", json::object()}}},
             {"settings", {{"rate", levels({"4", "2", "1"})}, {"size", levels({"big", "small"})}}},
             {"effects",
              {effect("rate", "4", 0.25, 0.08, 0.001), effect("rate", "2", 0.5, 0.02, 0.001),
               effect("size", "big", 0.5, 0.03, 0.001)}}};
  }
  /// For a description that has these levels.
  std::vector<Advice> advice(double tolerance, const std::string& rate = "/1", const std::string& size = "/small",
                             const std::vector<std::string>& figures = {}) {
    const OwnFolder folder;
    study = read_charted_study(folder.write("chart.json", chart.dump()), figures);
    return advise(study, tolerance,
                  [=](const std::vector<std::string>& sets) { return sets[0] == rate || sets[0] == size; });
  }
  json chart;
  ChartedStudy study;
};

TEST_F(AdviceOf, ATolerancePicksTheCheapestLevelWithin) {
  const auto narrow = advice(0.01);
  EXPECT_EQ(narrow[0].best, nullptr);
  EXPECT_EQ(narrow[1].best, nullptr);
  EXPECT_EQ(advice(0.05)[0].best->level, "2");
  EXPECT_EQ(advice(0.2)[0].best->level, "4");
  EXPECT_EQ(advice(0.05)[0].best->figure, "peak");
}

TEST_F(AdviceOf, ErrorsOfSettingsTakenTogetherAddUpToNoMoreThanTheTolerance) {
  const auto some = advice(0.04);
  EXPECT_TRUE(some[0].taken) << "saves as much with less error";
  EXPECT_FALSE(some[1].taken);
  EXPECT_TRUE(advice(0.06)[0].taken && advice(0.06)[1].taken);
}

TEST_F(AdviceOf, NothingCheaperThanWhatIsThereIsAdvised) {
  const auto some = advice(0.2, "/2", "/big");
  EXPECT_EQ(some[0].now->level, "2");
  EXPECT_EQ(some[0].best->level, "4");
  EXPECT_THAT(some[1].cheaper, IsEmpty());
}

TEST_F(AdviceOf, ADescriptionMayHaveWhatTheStudyDidNotTry) {
  const auto some = advice(0.2, "/7");
  EXPECT_EQ(some[0].now, nullptr);
  EXPECT_THAT(some[0].found, HasSubstr("it tried 4, 2, 1"));
}

TEST_F(AdviceOf, FiguresThatDoNotCountDoNotForbid) {
  EXPECT_EQ(advice(0.01, "/1", "/small", {"small"})[0].best->level, "4");
  EXPECT_THROW(advice(0.01, "/1", "/small", {"big"}), Error);
}

TEST_F(AdviceOf, LevelsThatFailedAreToldAndNeverTaken) {
  chart["effects"].erase(0);
  const auto some = advice(0.9);
  EXPECT_EQ(some[0].best->level, "2");
  ASSERT_EQ(some[0].cheaper.size(), 2u);
  EXPECT_EQ(some[0].cheaper[0]->level, "4");
  EXPECT_FALSE(some[0].cheaper[0]->known);
  const auto own = advice(0.9, "/4");
  EXPECT_EQ(own[0].now, nullptr);
  EXPECT_THAT(own[0].found, HasSubstr("4 here, with which the study's scene failed"));
}

TEST(Confidences, ComeFromErrorAndScatter) {
  const auto of = [](double error, double standard_error) {
    return confidence({"", {}, 1, error, standard_error, "peak"}, 0.1);
  };
  EXPECT_EQ(of(0.05, 0.02), Confidence::certain);
  EXPECT_EQ(of(0.05, 0.03), Confidence::likely);
  EXPECT_EQ(of(0.15, 0.08), Confidence::untold);
  EXPECT_EQ(of(0.15, 0.07), Confidence::impossible);
}

TEST(ChartFiles, OthersAreRefused) {
  const OwnFolder folder;
  EXPECT_THROW(read_charted_study(folder / "none.json", {}), FileError);
  EXPECT_THROW(read_charted_study(folder.write("run.json", R"({"status": "done"})"), {}), FileError);
}

}  // namespace
}  // namespace grit
