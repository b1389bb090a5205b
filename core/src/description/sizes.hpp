// Distributions of diameters.
#pragma once

#include <vector>

#include "grit/parameters.hpp"

namespace grit {

struct UniformSizes {
  static constexpr const char* type_name = "uniform";
  static constexpr const char* type_doc = "all diameters from smallest to largest are equally frequent, by number";
  double smallest = 0.25e-3, largest = 0.75e-3;
  void declare(Parameters& p);
};
struct LinearSizes {
  static constexpr const char* type_name = "linear";
  static constexpr const char* type_doc =
      "the mass that passes a sieve increases linearly from the smallest to the largest diameter";
  double smallest = 0.25e-3, largest = 0.75e-3;
  void declare(Parameters& p);
};
struct LogNormalSizes {
  static constexpr const char* type_name = "log-normal";
  static constexpr const char* type_doc =
      "the logarithm of the diameter is normally distributed, by number; cut at the smallest and largest";
  double median = 0.5e-3, log_standard_deviation = 0.25, smallest = 0.25e-3, largest = 1e-3;
  void declare(Parameters& p);
};
struct SieveSizes {
  static constexpr const char* type_name = "sieve";
  static constexpr const char* type_doc = "sieve curve: the mass that passes increases linearly between the sieves";
  std::vector<double> diameters, passing;
  void declare(Parameters& p);
};
struct ListSizes {
  static constexpr const char* type_name = "list";
  static constexpr const char* type_doc = "diameters one by one";
  std::vector<double> diameters;
  void declare(Parameters& p);
};
struct ShapeSizes {
  static constexpr const char* type_name = "shape";
  static constexpr const char* type_doc = "all clumps have the size in which their shape is given, by a list or a file";
  void declare(Parameters&) {}
};
using Sizes = OneOf<UniformSizes, LinearSizes, LogNormalSizes, SieveSizes, ListSizes, ShapeSizes>;

}  // namespace grit
