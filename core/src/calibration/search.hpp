// The search for the least misfit.
#pragma once

#include "calibration/description.hpp"
#include "calibration/trials.hpp"

namespace grit {

/// Why a search ended.
enum class SearchEnd {
  fits,        ///< the targets are met within tolerance and scatter
  trials,      ///< none are left
  resolution,  ///< its steps are below the resolution, or no better place was found
};
/// "the fit is within tolerance and scatter"
const char* sentence_of(SearchEnd end);

/// Begins at the first values of the parameters. The same trials give the same search, so that one whose trials are
/// known is repeated at once. A failed trial counts as a place somewhat worse than the worst. Passes on what an
/// evaluation throws.
SearchEnd search(Trials& trials, const OptimizerDescription& optimizer);

}  // namespace grit
