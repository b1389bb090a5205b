// The charts of studies that came with grit.
#pragma once

#include <string>
#include <vector>

#include "study/advice.hpp"

namespace grit {

/// All of them, by name. Says on stderr which cannot be read, and leaves those out.
std::vector<ChartedStudy> shipped_studies();
/// Whether a study is one of method, of scenes like this: of the same scenario, or of the same parts (parts_of()) where
/// there is none.
bool is_of(const ChartedStudy& study, const std::string& scenario, const std::vector<std::string>& parts);

}  // namespace grit
