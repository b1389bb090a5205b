#include "study/variants.hpp"

#include <gmock/gmock.h>

#include "grit/error.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

StudyDescription study_of(const std::string& settings, const std::string& more = "") {
  const OwnFolder folder;
  folder.write("scene.json", "{}");
  return load_study(folder.write("study.json", R"({"scene": "scene.json", "settings": )" + settings + R"(,
    "metrics": {"peak": {"type": "maximum", "of": "test/y"}})" +
                                                   more + "}"));
}

std::string problems_of(const std::string& settings, const std::string& more = "") {
  try {
    study_of(settings, more);
  } catch (const DescriptionError& error) {
    return error.what();
  }
  return "";
}

std::vector<std::string> names(const StudyDescription& study) {
  std::vector<std::string> all;
  for (const Variant& variant : variants(study)) all.push_back(variant.name);
  return all;
}

constexpr auto two_settings = R"({
  "rate": {"pointers": ["/rate"], "values": [3, 2, 1], "usual": "2"},
  "size": {"pointers": ["/a", "/b"], "values": [["1 mm", "2 mm"], [0.1, null]], "labels": ["coarse", "fine"]}
})";

TEST(Variants, OneAtATimeBeginsWithTheUsualAndEndsWithTheFinest) {
  EXPECT_THAT(names(study_of(two_settings)), ElementsAre("usual", "rate=3", "rate=1", "size=fine", "finest"));
}

TEST(Variants, CrossedHasEveryCombinationOnce) {
  EXPECT_THAT(names(study_of(two_settings, R"(, "vary": "crossed")")),
              ElementsAre("usual", "rate=3", "rate=1", "rate=3, size=fine", "size=fine", "finest"));
}

TEST(Variants, TheUsualMayBeTheFinest) {
  EXPECT_THAT(names(study_of(R"({"rate": {"pointers": ["/rate"], "values": [2, 1], "usual": "1"}})")),
              ElementsAre("rate=2", "usual"));
}

TEST(Variants, OfASweepHaveNoFinest) {
  constexpr auto one = R"({"rate": {"pointers": ["/rate"], "values": [3, 2, 1], "usual": "2"}})";
  EXPECT_THAT(names(study_of(one, R"(, "purpose": "sweep")")), ElementsAre("rate=3", "rate=2", "rate=1"));
  EXPECT_THAT(names(study_of(two_settings, R"(, "purpose": "sweep")")),
              ElementsAre("usual", "rate=3", "rate=1", "size=fine"));
  EXPECT_THAT(names(study_of(two_settings, R"(, "purpose": "sweep", "vary": "crossed")")),
              ElementsAre("rate=3, size=coarse", "rate=2, size=coarse", "rate=1, size=coarse", "rate=3, size=fine",
                          "rate=2, size=fine", "rate=1, size=fine"));
}

TEST(Variants, AreRefusedWhereNoMachineRunsThem) {
  std::string settings, level;
  for (int value = 1; value <= 100; ++value) level += (value > 1 ? "," : "") + std::to_string(value);
  for (int k = 0; k < 30; ++k) {
    const std::string name = "s" + std::to_string(k);
    settings += (k > 0 ? ",\"" : "\"") + name + R"(": {"pointers": ["/)" + name + R"("], "values": [)" + level + "]}";
  }
  EXPECT_THAT(problems_of("{" + settings + "}", R"(, "vary": "crossed")"),
              HasSubstr("/settings: found 3e+60 runs, of all levels and seeds; allowed is at most 10000; take fewer "
                        "levels or seeds, vary one at a time, or divide the study"));
  EXPECT_EQ(problems_of("{" + settings + "}"), "") << "one at a time: 2972 variants";
}

TEST(Variants, SetTheValuesOfTheStudyTheLevelsAndTheSeed) {
  const auto study = study_of(two_settings, R"(, "set": {"/title": "x"}, "seeds": {"pointer": "/s", "values": [4]})");
  EXPECT_THAT(sets_of(study, variants(study).back(), 4),
              ElementsAre("/title=\"x\"", "/rate=1", "/a=0.1", "/b=null", "/s=4"));
  EXPECT_THAT(sets_of(study, variants(study).front(), 4),
              ElementsAre("/title=\"x\"", "/rate=2", "/a=\"1 mm\"", "/b=\"2 mm\"", "/s=4"));
}

TEST(Variants, HaveFoldersWithoutOddCharacters) {
  EXPECT_EQ(folder_of({{}, "modulus=300 MPa, a/b=../x"}, 2), "runs/modulus=300_MPa,_a_b=.._x/seed-2");
}

TEST(Studies, ReportErrors) {
  EXPECT_THAT(problems_of(R"({"r": {"pointers": ["/r"], "values": [1]}})"), HasSubstr("/settings/r/values"));
  EXPECT_THAT(problems_of(R"({"r": {"pointers": ["/r"], "values": [1, 1]}})"), HasSubstr("the level \"1\" twice"));
  EXPECT_THAT(problems_of(R"({"r": {"pointers": ["/r"], "values": [1, 2], "usual": "3"}})"),
              HasSubstr("/settings/r/usual: found \"3\"; allowed is one of the labels: 1, 2"));
  EXPECT_THAT(problems_of(R"({"r": {"pointers": ["/r", "/s"], "values": [[1, 2], 3]}})"),
              HasSubstr("/settings/r/values/1: found 3; allowed is a list of 2 values"));
  EXPECT_THAT(problems_of(R"({"r": {"pointers": ["/r"], "values": [1, 2], "labels": ["a"]}})"), HasSubstr("1 label;"));
  EXPECT_THAT(problems_of("{}"), HasSubstr("/settings"));
  EXPECT_THAT(problems_of(two_settings, R"(, "purpose": "calibration")"),
              HasSubstr("/purpose: found \"calibration\"; allowed is one of accuracy, sweep"));
  EXPECT_THAT(problems_of(two_settings, R"(, "seeds": {"values": [1, 1]})"), HasSubstr("/seeds/values/0"));
  EXPECT_THAT(problems_of(two_settings, R"(, "seeds": {"values": [1.5]})"), HasSubstr("found 1.5; allowed"));
  EXPECT_THAT(problems_of(two_settings, R"(, "seeds": {"values": [1e300]})"), HasSubstr("from 0 to 1000000000000000"));
  EXPECT_THAT(problems_of(two_settings, R"(, "colour": 1)"), HasSubstr("/colour"));
}

TEST(Studies, NothingIsChangedTwice) {
  EXPECT_THAT(
      problems_of(R"({"r": {"pointers": ["/a", "/r"], "values": [[1, 1], [2, 2]]},
                              "s": {"pointers": ["/r"], "values": [3, 4]}})"),
      HasSubstr("/settings/s/pointers/0: found /r, of which /settings/r/pointers/1 changes /r; allowed is a value that "
                "no other setting and no seed changes"));
  EXPECT_THAT(
      problems_of(R"({"r": {"pointers": ["/t/step"], "values": [1, 2]}, "s": {"pointers": ["/t"], "values": [3, 4]}})"),
      HasSubstr("/settings/s/pointers/0: found /t, of which /settings/r/pointers/0 changes /t/step"));
  EXPECT_THAT(problems_of(R"({"r": {"pointers": ["/seed"], "values": [1, 2]}})"),
              HasSubstr("/seeds/pointer: found /seed, of which /settings/r/pointers/0 changes /seed"));
  EXPECT_EQ(problems_of(R"({"r": {"pointers": ["/t/step"], "values": [1, 2]}, "s": {"pointers": ["/t/steps"],
    "values": [3, 4]}})",
                        R"(, "set": {"/t": {}, "/t/step": 3})"),
            "")
      << "what is set for all runs may be varied in some";
}

TEST(Studies, AMetricIsOfAChannelAndHasTheReferenceOfItsKind) {
  const auto metric = [](const std::string& text) {
    const OwnFolder folder;
    folder.write("scene.json", "{}");
    try {
      load_study(folder.write("study.json", R"({"scene": "scene.json", "settings": {"r": {"pointers": ["/r"],
        "values": [1, 2]}}, "metrics": {"f": )" +
                                                text + "}}"));
    } catch (const DescriptionError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(metric(R"({"type": "curve", "of": "test/y", "against": "test/x"})"), "");
  EXPECT_THAT(metric(R"({"type": "last", "of": "y"})"), HasSubstr("/metrics/f/of: found \"y\""));
  EXPECT_THAT(metric(R"({"type": "curve", "of": "test/y", "value": 1})"), HasSubstr("/metrics/f/value"));
  EXPECT_THAT(metric(R"({"type": "last", "of": "test/y", "value": 0})"),
              HasSubstr("/metrics/f/value: found 0 without a scale"));
  EXPECT_EQ(metric(R"({"type": "last", "of": "test/y", "value": 0, "scale": 2})"), "");
  EXPECT_EQ(metric(R"({"type": "last", "of": "test/y", "value": "0 kPa", "scale": "2 kPa"})"), "");
  EXPECT_THAT(metric(R"({"type": "last", "of": "test/y", "value": true})"),
              HasSubstr("/metrics/f/value: found true; allowed is a number in the unit of the channel"));
  EXPECT_THAT(metric(R"({"type": "last", "of": "test/y", "scale": -2})"),
              HasSubstr("/metrics/f/scale: found the number -2; allowed is a value above 0"));
  EXPECT_THAT(metric(R"({"type": "value", "of": "test/y", "at": [1]})"), HasSubstr("/metrics/f/at: found "));
  EXPECT_THAT(metric(R"({"type": "largest", "of": "test/y"})"), HasSubstr("unknown metric \"largest\""));
}

}  // namespace
}  // namespace grit
