#include "lint/installed_studies.hpp"

#include <algorithm>
#include <filesystem>

#include "grit/error.hpp"
#include "plugins/loader.hpp"

namespace grit {

InstalledStudies installed_studies() {
  namespace fs = std::filesystem;
  const fs::path folder = library_directory() / "studies";
  std::vector<fs::path> files;
  if (fs::is_directory(folder))
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::ranges::sort(files);
  InstalledStudies studies;
  for (const auto& file : files) {
    try {
      studies.readable.push_back(read_evaluated_study(file, {}));
    } catch (const FileError& error) {  // the others are still used
      studies.unreadable.push_back(error.what());
    }
  }
  return studies;
}

bool is_of(const EvaluatedStudy& study, const std::string& scenario, const std::vector<std::string>& parts) {
  if (study.sweep || study.scenario != scenario) return false;
  return !scenario.empty() || study.parts == parts;
}

}  // namespace grit
