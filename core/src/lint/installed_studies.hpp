// The studies that are installed with grit.
#pragma once

#include <string>
#include <vector>

#include "study/advice.hpp"

namespace grit {

struct InstalledStudies {
  std::vector<ChartedStudy> readable;   ///< by name of the file
  std::vector<std::string> unreadable;  ///< why, one message a file
};
InstalledStudies installed_studies();

/// Whether a study varies the method of computation, for scenes like this one: of the same scenario, or of the same
/// parts (parts_of()) where there is none.
bool is_of(const ChartedStudy& study, const std::string& scenario, const std::vector<std::string>& parts);

}  // namespace grit
