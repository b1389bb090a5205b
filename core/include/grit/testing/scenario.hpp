// Tests that every scenario must pass, and functions to read one in a test. A plugin's test lists its cases:
//   INSTANTIATE_TEST_SUITE_P(Heap, ScenarioContract, testing::Values(ScenarioCase{"defaults", make_scenario<Heap>}),
//   scenario_case_name);
// expect_golden() compares with expansion.json in the working directory of the test: for a plugin, its own folder.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "grit/error.hpp"
#include "grit/scenario.hpp"
#include "grit/testing/reading.hpp"

namespace grit {

/// A scenario whose parameters were read, and the problems with them.
template <class S>
struct ReadScenario {
  std::unique_ptr<S> scenario = std::make_unique<S>();
  std::vector<Problem> problems;
};

template <class S>
ReadScenario<S> read_scenario(const Description& keys) {
  ReadScenario<S> result;
  Parameters parameters;
  result.scenario->declare(parameters);
  result.problems = read_parameters(keys, parameters);
  return result;
}

template <class S>
std::unique_ptr<S> made_scenario(const Description& keys = Description::object()) {
  auto result = read_scenario<S>(keys);
  for (const Problem& problem : result.problems) ADD_FAILURE() << problem.pointer << ' ' << problem.message;
  return std::move(result.scenario);
}

/// "POINTER MESSAGE" of each problem found on reading; "" if there is none.
template <class S>
std::string problems_of(const Description& keys) {
  std::string all;
  for (const Problem& problem : read_scenario<S>(keys).problems)
    all += (all.empty() ? "" : "\n") + problem.pointer + ' ' + problem.message;
  return all;
}

/// The message of the error that expand() throws; "" if it throws none.
template <class S>
std::string refusal(const Description& keys) {
  try {
    made_scenario<S>(keys)->expand();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Compares the expansion `now` of all defaults with expansion.json, so that changes are noticed. After an intended
/// change, replace expansion.json by the file that this function writes.
inline void expect_golden(const Description& now, const std::string& name) {
  const auto written = std::filesystem::temp_directory_path() / (name + "-expansion.json");
  std::ofstream(written) << now.dump(2) << '\n';
  const std::string advice = "the present expansion is in " + written.string();
  std::ifstream file("expansion.json");
  ASSERT_TRUE(file) << "there is no expansion.json; " << advice;
  const Description flat_now = now.flatten(), flat_golden = Description::parse(file).flatten();
  EXPECT_EQ(flat_now.size(), flat_golden.size()) << advice;
  for (const auto& [pointer, golden] : flat_golden.items()) {
    ASSERT_TRUE(flat_now.contains(pointer)) << pointer << "; " << advice;
    const auto& value = flat_now[pointer];
    if (golden.is_number_float()) {  // machines with and without fused multiplication differ in the last digits
      EXPECT_NEAR(value.get<double>(), golden.get<double>(), 1e-12 * std::abs(golden.get<double>())) << pointer;
    } else {
      EXPECT_EQ(value, golden) << pointer << "; " << advice;
    }
  }
}

/// A scenario with keys that expand to a description.
struct ScenarioCase {
  std::string name;
  std::function<std::unique_ptr<Scenario>()> make;
  Description keys = Description::object();  ///< keys that differ from their defaults or have none
};

inline void PrintTo(const ScenarioCase& one, std::ostream* out) { *out << one.name; }
inline std::string scenario_case_name(const testing::TestParamInfo<ScenarioCase>& info) { return info.param.name; }

/// Function that creates the scenario of a case.
template <class S>
std::unique_ptr<Scenario> make_scenario() {
  return std::make_unique<S>();
}

/// What every scenario must fulfil.
class ScenarioContract : public testing::TestWithParam<ScenarioCase> {
 protected:
  /// The scenario with the keys of the case.
  static std::unique_ptr<Scenario> made() {
    auto scenario = GetParam().make();
    Parameters parameters;
    scenario->declare(parameters);
    for (const Problem& problem : read_parameters(GetParam().keys, parameters))
      ADD_FAILURE() << problem.pointer << ' ' << problem.message;
    return scenario;
  }
};

/// Links the tests into a program that includes this file.
int scenario_contract();
inline const int scenario_contract_is_linked = scenario_contract();

}  // namespace grit
