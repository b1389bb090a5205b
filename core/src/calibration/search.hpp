// The search for the least misfit.
#pragma once

#include "calibration/description.hpp"
#include "calibration/trials.hpp"

namespace grit {

/// Why a search ended.
enum class SearchEnd {
  fits,        ///< the targets are met
  trials,      ///< none are left
  resolution,  ///< its steps are below the resolution, or no better place was found
};
/// "the targets are met"
const char* sentence_of(SearchEnd end);

/// First step of a search, as a part of each range.
inline constexpr double first_step = 0.2;

/// Begins at the best trial, or without one at the first values of the parameters. The same trials give the same
/// search, so that one whose trials are known is repeated at once. A failed trial counts as a place somewhat worse than
/// the worst. Passes on what an evaluation throws.
SearchEnd search(Trials& trials, const OptimizerDescription& optimizer, double step = first_step);

}  // namespace grit
