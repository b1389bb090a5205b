#include "calibration/description.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "calibration/observations.hpp"
#include "grit/error.hpp"
#include "support/own_folder.hpp"

namespace grit {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

class CalibrationDescriptions : public testing::Test {
 protected:
  CalibrationDescriptions() {
    written = {{"base", "sand.json"},
               {"parameters",
                {{"friction", {{"pointers", {"/a", "/b"}}, {"range", {"5 deg", "40 deg"}}, {"start", "9 deg"}}},
                 {"modulus", {{"pointers", {"/c"}}, {"range", {1e6, 1e8}}, {"scale", "log"}}}}},
               {"targets", {{"peak", {{"type", "maximum"}, {"of", "test/q"}, {"value", 3}, {"tolerance", 0.1}}}}}};
  }
  CalibrationDescription loaded() {
    folder.write("calibration.json", written.dump());
    return load_calibration(folder / "calibration.json");
  }
  /// What is reported with another value at a pointer.
  std::string fault(const std::string& pointer, const json& value) {
    const json before = written;
    written[json::json_pointer(pointer)] = value;
    std::string text = "none";
    try {
      loaded();
    } catch (const DescriptionError& error) {
      text = error.what();
    }
    written = before;
    return text;
  }
  OwnFolder folder;
  json written;
};

TEST_F(CalibrationDescriptions, HaveValuesInTheirUnits) {
  const auto calibration = loaded();
  const auto& friction = calibration.parameters.at("friction");
  EXPECT_EQ(friction.unit(), "deg");
  EXPECT_EQ(friction.first_value(), 9);
  EXPECT_EQ(friction.value(0.5), 22.5);
  EXPECT_EQ(friction.written(22.5), Description("22.5 deg"));
  const auto& modulus = calibration.parameters.at("modulus");
  EXPECT_NEAR(modulus.first_value(), 1e7, 1);
  EXPECT_NEAR(modulus.place(1e7), 0.5, 1e-12);
  EXPECT_NEAR(modulus.error_of_value(1e7, 0.01), 1e7 * std::log(100) * 0.01, 1);
  EXPECT_EQ(modulus.value(1.0 / 3), 4.64159e6) << "six digits";
  EXPECT_EQ(sets_of(calibration, {20, 1e7}),
            (std::vector<std::string>{"/a=\"20 deg\"", "/b=\"20 deg\"", "/c=10000000.0"}));
  EXPECT_EQ(calibration.samples.count, 3);
}

TEST_F(CalibrationDescriptions, ReportWhatIsWrong) {
  EXPECT_THAT(
      fault("/parameters/friction/range", {"40 deg", "5 deg"}),
      HasSubstr("calibration.json:1: /parameters/friction/range: found [\"40 deg\",\"5 deg\"], which is empty"));
  EXPECT_THAT(fault("/parameters/friction/range", {"5 deg", "1 rad"}), HasSubstr("the unit of the first, \"deg\""));
  EXPECT_THAT(fault("/parameters/friction/range", 5), HasSubstr("a list of two values"));
  EXPECT_THAT(fault("/parameters/friction/range", {"low", "5 deg"}), HasSubstr("/range/0: found the text \"low\""));
  EXPECT_THAT(fault("/parameters/modulus/range", {1, 1e300}),
              HasSubstr("/parameters/modulus/range/1: found the number 1e+300; allowed is a number of at most 1e+50"));
  EXPECT_THAT(fault("/parameters/friction/range", {"9 deg", "9.000001 deg"}), HasSubstr("wider than the six digits"));
  EXPECT_THAT(fault("/parameters/friction/start", "50 deg"),
              HasSubstr("/start: found the text \"50 deg\"; allowed is a value from \"5 deg\" to \"40 deg\""));
  EXPECT_THAT(fault("/parameters/friction/start", 9), HasSubstr("in the same unit"));
  EXPECT_THAT(fault("/parameters/modulus/range", {0, 1e8}), HasSubstr("a value above 0 with the scale \"log\""));
  EXPECT_THAT(fault("/parameters/modulus/pointers", {"/a/b"}), HasSubstr("a value that no other parameter"));
  EXPECT_THAT(fault("/samples/pointer", "/c"), HasSubstr("/samples/pointer: found /c, of which"));
  EXPECT_THAT(fault("/samples/count", 0), HasSubstr("/samples/count"));
  EXPECT_THAT(fault("/parameters", json::object()), HasSubstr("/parameters: found none"));
  EXPECT_THAT(fault("/targets/peak/type", "curve"), HasSubstr("/targets/peak/curve: found none"));
  EXPECT_THAT(fault("/targets/peak/of", "q"), HasSubstr("probe/channel"));
  EXPECT_THAT(fault("/optimizer/algorithm", "newton"), HasSubstr("bobyqa"));
  EXPECT_THAT(fault("/set", {{"/d", json::object()}}), HasSubstr("/set/~1d: found an object"));
  EXPECT_THAT(
      fault("/set", {{"/c", 1e7}}),
      HasSubstr("/set/~1c: found a value that /parameters/modulus/pointers/0 changes; allowed is a value that no "
                "parameter and no seed changes"));
  EXPECT_THAT(fault("/set", {{"/seed", 4}}), HasSubstr("/set/~1seed: found a value that /samples/pointer changes"));
  EXPECT_THAT(fault("/set", {{"/d", 4}}), HasSubstr("none"));
  EXPECT_THAT(fault("/sample", 3), HasSubstr("samples"));
}

TEST_F(CalibrationDescriptions, ExtendOthers) {
  folder.write("other.json", written.dump());
  written = {{"extends", "other.json"}, {"optimizer", {{"trials", 7}}}};
  EXPECT_EQ(loaded().optimizer.trials, 7);
  EXPECT_EQ(loaded().parameters.size(), 2u);
}

TEST_F(CalibrationDescriptions, ReadTargetsWithUnits) {
  written["targets"]["peak"].update({{"value", "200 kPa"}, {"tolerance", "5 kPa"}});
  const auto observations = observations_of(loaded(), {}, {{"test/q", "Pa"}});
  EXPECT_EQ(observations.front().value, 200e3);
  EXPECT_EQ(observations.front().tolerance, 5e3);
  written["targets"]["peak"].update({{"type", "position-of-maximum"}, {"value", "3 ms"}, {"tolerance", 1e-4}});
  EXPECT_EQ(observations_of(loaded(), {}, {{"test/q", "Pa"}, {"test/time", "s"}}).front().value, 3e-3);
  written["targets"]["peak"].update({{"against", "test/strain"}, {"value", "3 %"}});
  EXPECT_EQ(observations_of(loaded(), {}, {{"test/q", "Pa"}, {"test/strain", "1"}}).front().value, 0.03);
}

TEST_F(CalibrationDescriptions, RefuseTargetsThatCannotBeComputedWith) {
  const auto fault_of = [&](const json& value, const json& tolerance, const std::string& unit = "Pa") {
    written["targets"]["peak"].update({{"value", value}, {"tolerance", tolerance}});
    const auto calibration = loaded();
    try {
      observations_of(calibration, Document::load(folder / "calibration.json"), {{"test/q", unit}});
    } catch (const DescriptionError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_EQ(fault_of(1e40, 1e30), "none");
  EXPECT_EQ(fault_of(0, 1e-50), "none");
  EXPECT_THAT(
      fault_of(1e160, 0.1),
      HasSubstr("calibration.json:1: /targets/peak/value: found 1e+160; allowed is a magnitude of at most 1e+50"));
  EXPECT_THAT(fault_of(-1e51, 1e45), HasSubstr("/targets/peak/value: found 1e+51"));
  EXPECT_THAT(fault_of(3, 1e-300),
              HasSubstr("/targets/peak/tolerance: found 1e-300; allowed is a number from 3e-12 to 1e+50"));
  EXPECT_THAT(fault_of(0, 1e-60), HasSubstr("/targets/peak/tolerance: found 1e-60; allowed is a number from 1e-50"));
  EXPECT_THAT(fault_of(3, 1e300), HasSubstr("/targets/peak/tolerance: found 1e+300"));
  EXPECT_THAT(fault_of(3, 0), HasSubstr("/targets/peak/tolerance: found 0; allowed is a number above 0"));
  EXPECT_THAT(
      fault_of("3 mm", 0.1),
      HasSubstr("/targets/peak/value: found the text \"3 mm\"; allowed is a number in Pa, or a text with a number "
                "and one of Pa, kPa, MPa"));
  EXPECT_THAT(fault_of("much", "5 m"), AllOf(HasSubstr("/targets/peak/value: found the text \"much\""),
                                             HasSubstr("/targets/peak/tolerance: found the text \"5 m\"")));
  EXPECT_THAT(fault_of("3 Pa", 0.1, ""), HasSubstr("allowed is a number in the unit of the channel"));
  EXPECT_THAT(fault_of(json::array({1}), 0.1), HasSubstr("/targets/peak/value: found a list"));
  folder.write("lab.csv", "strain,stress\n0,0\n0.1,-1e160\n");
  written["targets"]["peak"] = {
      {"type", "curve"}, {"of", "test/q"}, {"curve", {{"file", "lab.csv"}, {"x", "strain"}, {"y", "stress"}}}};
  written["targets"]["peak"].erase("value");
  const auto calibration = [&] {
    written["targets"]["peak"]["tolerance"] = 1;
    return loaded();
  }();
  EXPECT_THROW(observations_of(calibration, {}, {{"test/q", "Pa"}}), DescriptionError);
}

TEST_F(CalibrationDescriptions, CompareCurvesWhereTheTargetHasOne) {
  folder.write("lab.csv", "strain,stress\n0,0\n0.1,200\n0.2,100\n");
  written["targets"] = {{"curve",
                         {{"type", "curve"},
                          {"of", "test/q"},
                          {"against", "test/strain"},
                          {"curve", {{"file", "lab.csv"}, {"x", "strain"}, {"y", "stress"}}},
                          {"tolerance", 10}}},
                        {"end", {{"type", "last"}, {"of", "test/q"}, {"value", 90}, {"tolerance", 5}}}};
  const auto calibration = loaded();
  const auto observations = observations_of(calibration, {}, {});
  ASSERT_EQ(observations.size(), 21u);
  double weight = 0;
  for (std::size_t i = 0; i < 20; ++i) weight += observations[i].weight;
  EXPECT_NEAR(weight, 1, 1e-12) << "a curve counts as one target";
  EXPECT_EQ(observations[19].at, 0.2);
  EXPECT_EQ(observations[19].value, 100);
  EXPECT_EQ(observations[20].target, 1u);
  std::map<std::string, Metric> metrics{{"curve", {{0, 0.195}, {0, 390}, "Pa", "1"}}, {"end", {{}, {77}, "Pa", ""}}};
  const auto found = found_in(calibration, observations, metrics);
  EXPECT_NEAR(found[10], 2000 * observations[10].at, 1e-9);
  EXPECT_EQ(found[19], 390) << "its last value";
  EXPECT_EQ(found[20], 77);
  metrics["curve"].x = {0, 0.1};
  try {
    found_in(calibration, observations, metrics);
    FAIL();
  } catch (const NumericsError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("test/q has abscissae from 0 to 0.1, the curve of the target curve from 0 to 0.2"));
  }
}

}  // namespace
}  // namespace grit
