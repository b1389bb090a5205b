// The values in which descriptions differ, as the page of several runs lists them.
#include "report/description_differences.hpp"

#include <gmock/gmock.h>

namespace grit::description_differences_tests {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

using Rows = std::vector<std::string>;

RunResults run_of(const std::string& description, const std::string& unexpanded = "null") {
  RunResults run;
  run.json["description"] = Description::parse(description);
  run.json["source"]["unexpanded"] = Description::parse(unexpanded);
  return run;
}

/// "/pointer: value of one | value of the other".
Rows rows(const std::vector<RunResults>& runs) {
  Rows rows;
  for (const DescriptionDifference& difference : description_differences(runs)) {
    rows.push_back(difference.pointer + ":");
    for (const std::string& value : difference.values)
      rows.back() += (&value == &difference.values.front() ? " " : " | ") + value;
  }
  return rows;
}

TEST(DescriptionDifferences, AreValuesByPointer) {
  EXPECT_THAT(rows({run_of(R"({"seed": 1, "materials": {"sand": {"density": 2600.0, "friction": 0.5}}})"),
                    run_of(R"({"seed": 2, "materials": {"sand": {"friction": 0.25, "density": 2600}}})")}),
              ElementsAre("/seed: 1 | 2", "/materials/sand/friction: 0.5 | 0.25"));
  EXPECT_THAT(rows({run_of(R"({"a": "x", "b": true, "c": 1e-6, "d/e": ""})"),
                    run_of(R"({"a": 5, "b": false, "c": 2e-6, "d/e": "y"})")}),
              ElementsAre("/a: x | 5", "/b: true | false", "/c: 1e-06 | 2e-06", "/d~1e: \"\" | y"));
}

TEST(DescriptionDifferences, HaveNoRowForTitlesAndOutput) {
  EXPECT_THAT(rows({run_of(R"({"title": "one", "output": {"picture": {"x": "test/time"}}})"),
                    run_of(R"({"title": "two", "output": {"picture": null}})")}),
              IsEmpty());
}

TEST(DescriptionDifferences, HaveOneRowForWhatOneRunLacks) {
  const std::string energy = R"({"probes": {"energy": {"type": "energy", "every_steps": 500}}})";
  EXPECT_THAT(rows({run_of(energy), run_of(R"({"probes": {}})")}),
              ElementsAre("/probes/energy: {type: energy, every_steps: 500} | "));
  EXPECT_THAT(
      rows({run_of(energy), run_of(R"({"probes": {}})"), run_of(R"({"probes": {"energy": {"type": "energy"}}})")}),
      ElementsAre("/probes/energy/type: energy |  | energy", "/probes/energy/every_steps: 500 |  | "));
}

TEST(DescriptionDifferences, HaveOneRowForAVector) {
  EXPECT_THAT(rows({run_of(R"({"point": [0, 0, 1.5]})"), run_of(R"({"point": [0, 0, 2]})")}),
              ElementsAre("/point: [0, 0, 1.5] | [0, 0, 2]"));
  EXPECT_THAT(rows({run_of(R"({"long": [0, 1, 2, 3, 4, 5, 6]})"), run_of(R"({"long": [0, 1, 2, 3, 9, 5, 6]})")}),
              ElementsAre("/long/4: 4 | 9"));
  EXPECT_THAT(rows({run_of(R"({"stages": [{"name": "fill", "limit": 1}]})"),
                    run_of(R"({"stages": [{"name": "fill", "limit": 2}]})")}),
              ElementsAre("/stages/0/limit: 1 | 2"));
  EXPECT_THAT(rows({run_of(R"({"long": [0, 1, 2, 3, 4, 5, 6]})"), run_of(R"({"long": [0]})")}),
              ElementsAre("/long: 7 entries | [0]"));
}

TEST(DescriptionDifferences, AreThoseOfTheScenarioAsWritten) {
  const auto silo = [](const char* width, int seed) {
    return R"({"seed": )" + std::to_string(seed) + R"(, "scenario": {"type": "silo", "width": ")" + width + "\"}}";
  };
  const auto one = run_of(R"({"walls": {"left": 0.1, "right": 0.2}, "seed": 1})", silo("30 cm", 1));
  const auto two = run_of(R"({"walls": {"left": 0.2, "right": 0.3}, "seed": 2})", silo("0.4 m", 2));
  EXPECT_THAT(rows({one, two}), ElementsAre("/scenario/width: 30 cm | 0.4 m", "/seed: 1 | 2"));

  const Rows complete{"/walls/left: 0.1 | 0.2", "/walls/right: 0.2 | 0.3", "/seed: 1 | 2"};
  auto other = two;
  other.json["source"]["unexpanded"]["scenario"]["type"] = "round-silo";
  EXPECT_EQ(rows({one, other}), complete) << "of two scenarios";
  other.json["source"]["unexpanded"] = nullptr;
  EXPECT_EQ(rows({one, other}), complete) << "of a scenario and a plain description";
  other.json.erase("source");
  EXPECT_EQ(rows({one, other}), complete) << "of an older program";
  other.json["source"]["unexpanded"] = one.json["source"]["unexpanded"];
  EXPECT_EQ(rows({one, other}), complete) << "the same as written";
  other.json["source"]["unexpanded"] = two.json["source"]["unexpanded"];
  other.json["description"] = one.json["description"];
  EXPECT_THAT(rows({one, other}), IsEmpty()) << "the same in another unit";
}

TEST(DescriptionDifferences, AreOfTheRunsWithADescription) {
  const auto one = run_of(R"({"seed": 1})"), two = run_of(R"({"seed": 2})");
  EXPECT_THAT(rows({one, RunResults(), two}), ElementsAre("/seed: 1 |  | 2"));
  EXPECT_THAT(rows({one, RunResults()}), IsEmpty());
  EXPECT_THAT(rows({}), IsEmpty());
}

}  // namespace
}  // namespace grit::description_differences_tests
