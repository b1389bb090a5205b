// Description of a calibration: parameters of a scene, and the targets that its runs are to meet.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "grit/description.hpp"
#include "grit/parameters.hpp"
#include "study/description.hpp"

namespace grit {

/// Of parameters, targets, tolerances and what runs find: squares of their ratios stay far within the range of numbers.
inline constexpr double most_magnitude = 1e50, least_tolerance = 1e-50;
/// A tolerance below this part of its target is lost in the digits of numbers.
inline constexpr double least_relative_tolerance = 1e-12;

/// A parameter between two values. The search sees it as a place from 0 to 1 in its range.
struct ParameterDescription {
  std::string doc;
  std::vector<std::string> pointers;
  Description range = Description::array(), start;
  std::string scale = "linear";

  void declare(Parameters& p);
  bool is_logarithmic() const { return scale == "log"; }
  /// As written; empty without one.
  std::string unit() const;
  double low() const;
  double high() const;
  /// Where the search begins: `start`, or the middle of the range.
  double first_value() const;
  /// The value at a place, with the six digits with which it is written.
  double value(double place) const;
  double place(double value) const;
  /// The standard error of a value whose place has this one, to first order.
  double error_of_value(double value, double error_of_place) const;
  /// A value as in a description: a number, or a text with the unit.
  Description written(double value) const;

 private:
  double logarithmic_length() const;
};

struct TargetDescription {
  MetricDescription metric;      ///< with the target curve
  Description value, tolerance;  ///< in the unit of the metric's channel

  void declare(Parameters& p);
};

struct SamplesDescription {
  std::string pointer = "/seed";
  std::int64_t count = 3;
  void declare(Parameters& p);
};

struct OptimizerDescription {
  std::string algorithm = "bobyqa";
  std::int64_t trials = 40, runs_at_once = 0;
  double resolution = 0.01;
  void declare(Parameters& p);
};

struct CalibrationDescription {
  std::string title, base;
  Description set = Description::object();
  std::map<std::string, ParameterDescription> parameters;
  std::map<std::string, TargetDescription> targets;
  SamplesDescription samples;
  OptimizerDescription optimizer;

  void declare(Parameters& p);
  /// What is measured in each run, by target.
  std::map<std::string, MetricDescription> metrics() const;
  std::vector<std::string> names() const;
};

/// Throws FileError and DescriptionError with all problems.
CalibrationDescription load_calibration(const std::filesystem::path& path);

/// The values of `grit run --set` with these values of the parameters, in their order.
std::vector<std::string> sets_of(const CalibrationDescription& calibration, const std::vector<double>& values);

}  // namespace grit
