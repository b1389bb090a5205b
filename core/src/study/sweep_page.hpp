// The results of a sweep as a self-contained HTML page without scripts.
#pragma once

#include <string>

#include "study/study_result.hpp"

namespace grit {

std::string sweep_page(const StudyResult& result);

}  // namespace grit
