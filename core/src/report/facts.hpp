// Key facts of a run: size, cost, reliability.
#pragma once

#include <string>
#include <vector>

#include "report/run_results.hpp"

namespace grit {

struct Fact {
  std::string name, value;
  std::string note;       ///< small, below the value
  bool doubtful = false;  ///< beyond usual limits
  std::string in_line{};  ///< in a line of text: "37 ms simulated"; may be empty
};

/// What was found: for each scalar channel of /output/summary and of the picture its value at the end of the last
/// stage, and the largest one with its abscissa. With enough samples the mean of the last tenth ± its standard error.
std::vector<Fact> result_facts(const RunResults& run);

/// Size and cost of the run, as far as the results contain them.
std::vector<Fact> cost_facts(const RunResults& run);

/// Estimates of error, of the channels that series.h5 has:
///   time step         over the critical time step; doubtful above 1
///   energy closure    closure_fraction, largest magnitude; doubtful above 1 %; without an energy balance, how to get
///   one inertial number   inertial_number, largest; doubtful above 1e-3 without gravity (with gravity, grains may
///   flow) stiffness level   least contact modulus of a material over the largest mean_stress largest overlap
///   largest_overlap over the mean diameter [m], if that is above 0; doubtful above 5 %
std::vector<Fact> trust_facts(const RunResults& run, double mean_diameter);

/// The status: "done", "failed", …; "unknown" without run.json.
std::string status_of(const RunResults& run);

/// The stage in which a run was interrupted, and the time since its start; empty if it was not interrupted.
std::string where_interrupted(const RunResults& run);

}  // namespace grit
