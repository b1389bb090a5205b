// What a description has its curves compared with.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/run_results.hpp"

namespace grit {

/// A value, or a curve that was read from its file; in the units of the channels.
struct Reference {
  std::string name;     ///< as people write it
  std::string of;       ///< "probe/channel"
  std::string against;  ///< the abscissa of a curve, "probe/channel"; empty: time
  std::optional<double> value;
  std::vector<double> x = {}, y = {};
};

/// Those of a run. What cannot be read is among its problems.
std::vector<Reference> references_of(RunResults& run);

}  // namespace grit
