// What a reader of a report wants to know first: what ran, what it cost, how far to trust it.
#pragma once

#include <string>
#include <vector>

#include "report/run_results.hpp"

namespace grit {

struct Fact {
  std::string name, value;
  std::string note;       ///< small, below the value
  bool doubtful = false;  ///< beyond what is usually asked for
  std::string in_line{};  ///< value, unit and what it is of: "37 ms simulated"; of what is told in a line
};

/// What ran and what it cost. Only what the results say.
std::vector<Fact> cost_facts(const RunResults& run);

/// Estimates of error, of the channels that series.h5 has:
///   time step         over the critical one; doubtful above 1
///   energy closure    closure_share, largest in size; doubtful above 1 %; where no ledger is kept, how to have one
///   inertial number   inertial_number, largest; doubtful above 1e-3 without gravity, under which grains are to flow
///   stiffness level   least contact modulus of a material over the largest mean_stress
///   largest overlap   largest_overlap over the mean diameter [m], if that is above 0; doubtful above 5 %
std::vector<Fact> trust_facts(const RunResults& run, double mean_diameter);

/// The status as a word: "done", "failed", …; "unknown" without run.json.
std::string status_of(const RunResults& run);

/// In which of its stages a run was stopped, and how long after that began; empty of one that was not interrupted.
std::string where_interrupted(const RunResults& run);

}  // namespace grit
