// What all ranks of a run must have alike.
#pragma once

#include <vector>

#include "app/run_jobs.hpp"
#include "app/run_ranks.hpp"

namespace grit {

/// Programs, system, plugins, description and the files that it names.
std::vector<RankFact> facts_to_agree_on(const RunJob& job);

}  // namespace grit
