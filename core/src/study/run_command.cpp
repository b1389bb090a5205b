#include "study/run_command.hpp"

namespace grit {
namespace {

void add_common(std::vector<std::string>& words, const RunProgram& with) {
  words.insert(words.end(), {"--threads", std::to_string(with.threads)});
  for (const auto& path : with.plugin_paths) words.insert(words.end(), {"--plugin-path", path});
}

}  // namespace

std::vector<std::string> run_words(const RunProgram& with, const std::string& scene,
                                   const std::filesystem::path& folder, const std::vector<std::string>& sets,
                                   bool resume) {
  std::vector<std::string> words{
      with.program.string(), "run", scene, "--out", folder.string(), resume ? "--resume" : "--overwrite", "--quiet",
      "--no-report"};
  add_common(words, with);
  for (const auto& set : sets) words.insert(words.end(), {"--set", set});
  return words;
}

bool is_of_study(const std::vector<std::string>& words) {
  return words.size() >= 8 && words[1] == "run" && words[3] == "--out" && words[6] == "--quiet" &&
         words[7] == "--no-report";
}

std::vector<std::string> task_words(const RunProgram& with, const std::filesystem::path& study,
                                    const std::filesystem::path& out, bool overwrite) {
  std::vector<std::string> words{with.program.string(), "study", study.string(), "--out", out.string()};
  if (overwrite) words.push_back("--overwrite");
  add_common(words, with);
  words.push_back("--only");
  return words;
}

}  // namespace grit
