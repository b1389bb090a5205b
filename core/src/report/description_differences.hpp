// Values in which the descriptions of several runs differ.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "report/run_results.hpp"

namespace grit {

struct DescriptionDifference {
  std::string pointer;
  std::vector<std::string> values;  ///< by run; empty where a description has no such value
};

/// Compares the runs that have a description, without title and output. If all of them are of one scenario, the values
/// are those written, with units and without defaults, the scenario's own first; otherwise, or if these are equal,
/// those of the complete descriptions, in SI. None if the complete descriptions are equal.
std::vector<DescriptionDifference> description_differences(std::span<const RunResults> runs);

}  // namespace grit
