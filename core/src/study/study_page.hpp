// The results of a study as a self-contained HTML page without scripts.
#pragma once

#include <string>

#include "study/study_result.hpp"

namespace grit {

std::string study_page(const StudyResult& result);

}  // namespace grit
