// Sentences of a study's page and report.
#pragma once

#include <string>
#include <vector>

namespace grit {

struct StudyResult;
struct StudyDescription;
struct VariantResult;

/// What a study of accuracy compares: "error of peak", or "difference of peak from its reference" if the description
/// gives the reference. `metric`: empty for the largest of all metrics.
std::string deviation_title(const StudyDescription& study, const std::string& metric);

/// The metrics that could not be evaluated, one line per reason: "peak, end: its reference is 0 …".
std::vector<std::string> not_evaluated(const StudyResult& result);

/// The runs that failed and why, one line each: "radius=2 mm, seed 1: …".
std::vector<std::string> failed_runs(const StudyResult& result);

/// Why a variant is rejected although its own error may be within the tolerance, e.g. "damping=0.01, which is finer,
/// deviates by 6.5 % ± 0.7 % (bottom_fraction)"; empty if it is not.
std::string finer_that_is_not(const StudyResult& result, const VariantResult& one);

/// A remark if the seeds had no effect; else empty.
std::string of_samples(const StudyResult& result);

/// A warning for settings whose first level is much more expensive than their last, which may be in the wrong order;
/// empty if there are none.
std::string of_order(const StudyResult& result);

/// How many runs are done, and which are failed, under way or missing, ten of each; empty if all are done.
std::string of_progress(const StudyResult& result);

/// The conclusion in sentences: the cheapest variant within the tolerance, its saving, and uncertainties; of a sweep
/// the variants closest to given values.
std::string verdict(const StudyResult& result);

}  // namespace grit
