// Numbers and sentences of a chart, as people like to read them.
#pragma once

#include <string>
#include <vector>

namespace grit {

struct Chart;
struct StudyDescription;
struct VariantResult;

/// What a deviation from the finest is called: where what is modelled varies, not how, it is no error.
std::string word_for_error(const StudyDescription& study);

/// "peak, end: its reference is 0 …": the figures that could not be charted, a line for each reason.
std::vector<std::string> not_charted(const Chart& chart);

/// "damping=0.01, which is finer, is 6.5 % ± 0.7 % off (bottom_share)": why a variant is not within the tolerance
/// though its own error may be; empty where that is not so.
std::string finer_that_is_not(const Chart& chart, const VariantResult& one);

/// What there is to say where seeds changed nothing; empty elsewhere.
std::string of_samples(const Chart& chart);

/// The settings whose first level costs so much more than their last that they may be in the wrong order; empty if
/// none.
std::string of_order(const Chart& chart);

/// Some sentences: the cheapest variant that is good enough, what it saves, and what is unsure of that.
std::string verdict(const Chart& chart);

}  // namespace grit
