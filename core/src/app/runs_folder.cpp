#include "app/runs_folder.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>

#include "app/command.hpp"
#include "format/number.hpp"
#include "grit/error.hpp"
#include "grit/toolkit/text_file.hpp"
#include "output/checkpoint.hpp"
#include "output/own_files.hpp"
#include "output/read_results.hpp"
#include "output/run_facts.hpp"
#include "plugins/build_facts.hpp"
#include "storage/parsed_json.hpp"
#include "study/run_command.hpp"

namespace grit {
namespace {

/// Of a run that did not begin there is only the log, with its messages.
bool is_only_log(const std::filesystem::path& log) {
  std::error_code none;
  const std::filesystem::directory_iterator entries(log.parent_path(), none);
  const std::string text = text_of(log);
  return std::filesystem::is_regular_file(log, none) && std::distance(begin(entries), end(entries)) == 1 &&
         (text.empty() || text.find("grit: ") != text.npos);
}

/// Identifies plugins by kind, name and checksum, whatever their paths.
std::set<std::string> builds(const Description& plugins) {
  std::set<std::string> all;
  for (const auto& plugin : plugins)
    all.insert(plugin.value("kind", "") + ' ' + plugin.value("name", "") + ' ' +
               plugin.value(Description::json_pointer("/build/checksum"), Description()).dump());
  return all;
}

/// Whether a run of these facts left a complete checkpoint that this build can resume.
bool can_resume(const std::filesystem::path& folder, const RunFacts& facts) {
  try {
    return last_checkpoint(folder, facts).has_value();
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

Description json_at(const std::filesystem::path& path) {
  std::string fault;
  return parsed_json(read_bytes(path, fault));
}

bool is_study_json(const std::filesystem::path& path) {
  const Description json = json_at(path);
  return json.is_object() && json.contains("variants") && json.contains("cheapest");
}

bool is_calibration_json(const std::filesystem::path& path) {
  const Description json = json_at(path);
  return json.is_object() && json.contains("calibration") && json.contains("observations");
}

void refuse_results_of_others(const std::filesystem::path& folder, ResultsOf own) {
  const auto refuse = [&](const char* whose) {
    throw FileError(folder.string() + ": holds the results of a " + whose +
                    ", with which others would be mixed; choose another folder with --out");
  };
  if (own != ResultsOf::run && holds_a_run(folder)) refuse("run");
  if (own != ResultsOf::study && is_study_json(folder / "study.json")) refuse("study");
  if (own != ResultsOf::calibration && is_calibration_json(folder / "calibration.json")) refuse("calibration");
}

bool has_series(const std::filesystem::path& folder) {
  try {
    const SeriesFile series(folder);
    return true;
  } catch (const FileError&) {
    return false;
  }
}

std::filesystem::path default_results(const std::filesystem::path& file) {
  const auto name = file.stem();
  if (name == "." || name == ".." || name.empty())
    throw UsageError(file.string() +
                     ": no folder of results can have this name; rename the file, or give a folder with --out");
  return "results" / name;
}

Progressed progressed(const std::filesystem::path& folder, const Description& description,
                      const std::vector<PluginUsed>& plugins) {
  const auto run = read_run_json(folder);
  if (!run || !run->contains("description")) return Progressed::nothing;
  const auto says = [&](const char* pointer) { return run->value(Description::json_pointer(pointer), Description()); };
  Description used = Description::array();
  for (const PluginUsed& one : plugins) used.push_back(plugin_facts(one));
  if (says("/description") != description || says("/grit/revision") != build_facts().revision ||
      !says("/plugins").is_array() || builds(says("/plugins")) != builds(used))
    return Progressed::other;
  if (says("/status") == "failed") return Progressed::ended;
  if (says("/status") == "done") return has_series(folder) ? Progressed::ended : Progressed::lost;
  // The run.json of a killed run still has the status "running".
  const bool stopped = says("/status") == "interrupted" || says("/status") == "running";
  return stopped && can_resume(folder, {.description = description, .plugins = plugins}) ? Progressed::begun
                                                                                         : Progressed::nothing;
}

void refuse_other_runs(const std::filesystem::path& out, std::size_t count, const std::filesystem::path& folder) {
  throw FileError(
      fmt::format("{}: holds {} of another description, another grit or another build of a plugin, the first "
                  "in {}; give --overwrite to replace them, or choose another folder with --out",
                  out.string(), counted(count, "run", "runs"), folder.string()));
}

std::string lost_series(const std::filesystem::path& folder) {
  return folder.string() + ": the run is done, but its series.h5 is missing or unreadable";
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string failed_run_text(const std::string& run, int status, const std::filesystem::path& log) {
  return run +
         (status < 0 ? fmt::format(" was killed by signal {}", -status)
                     : fmt::format(" ended with status {}", status)) +
         ":\n" + text_of(log) + "\nfrom " + log.string();
}

void lock_folder(const std::filesystem::path& out, const std::string& command, std::optional<FolderLock>& lock) {
  if (!lock.emplace(out).held())
    throw FileError(out.string() + ": another '" + command +
                    "', or one of its runs, is writing there; wait for it, or choose another folder with --out");
}

void refuse_foreign_run(const std::filesystem::path& folder) {
  const auto refuse = [](const std::filesystem::path& at, const char* what) {
    throw FileError(at.string() + what +
                    ", which would be replaced; move it away, or choose another folder with --out");
  };
  std::error_code none;
  for (const auto& at : {folder.parent_path(), folder})
    if (std::filesystem::is_symlink(at, none))
      refuse(at, ": no study or calibration made this symbolic link: it leads to results");
  if (!holds_a_run(folder)) {
    if (const auto log = folder / "log.txt"; std::filesystem::exists(log, none) && !is_only_log(log))
      refuse(log, ": no study or calibration wrote this file");
    return;
  }
  const auto run = read_run_json(folder);
  const auto commands = run ? run->value("commands", Description()) : Description();
  const bool is_own = commands.is_array()
                          ? std::ranges::any_of(commands,
                                                [](const Description& words) {
                                                  return words.is_array() &&
                                                         std::ranges::all_of(words, &Description::is_string) &&
                                                         is_of_study(words.get<std::vector<std::string>>());
                                                })
                          : std::filesystem::exists(folder / "log.txt", none);  // of earlier versions
  if (!is_own) refuse(folder, ": no study or calibration began this run");
}

}  // namespace grit
