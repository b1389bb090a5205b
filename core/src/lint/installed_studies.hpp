// The studies that are installed with grit.
#pragma once

#include <string>
#include <vector>

#include "study/advice.hpp"

namespace grit {

struct InstalledStudies {
  std::vector<EvaluatedStudy> readable;  ///< by file name
  std::vector<std::string> unreadable;   ///< reasons, one message per file
};
InstalledStudies installed_studies();

/// Whether a study varies numerical settings for similar scenes: of the same scenario, or without one of the same
/// components (parts_of()).
bool is_of(const EvaluatedStudy& study, const std::string& scenario, const std::vector<std::string>& parts);

}  // namespace grit
