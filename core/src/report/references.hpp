// References of a description for its curves.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/run_results.hpp"

namespace grit {

/// A value, or a curve read from its file, in the units of the channels.
struct Reference {
  std::string name;     ///< readable
  std::string of;       ///< "probe/channel"
  std::string against;  ///< the abscissa of a curve, "probe/channel"; empty: time
  std::optional<double> value;
  std::vector<double> x = {}, y = {};
};

/// The references of a run. Unreadable ones are added to its problems.
std::vector<Reference> references_of(RunResults& run);

}  // namespace grit
