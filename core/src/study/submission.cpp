#include "study/submission.hpp"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <initializer_list>
#include <ranges>

#include "grit/error.hpp"
#include "output/shell_word.hpp"

namespace grit {
namespace {

constexpr const char* script_mark = "# Written by 'grit study'";
/// Before the time limit, for a checkpoint. Slurm may send the signal up to a minute early.
constexpr int seconds_to_save = 120;
constexpr double time_margin = 3, least_time = 600, most_time = 86400;
constexpr double memory_margin = 2, program_memory = 256e6, memory_step = 100e6;

void refuse_line_feeds(const Submission& of) {
  for (const std::string& path : {of.directory.string(), of.folder.string()})
    if (path.find('\n') != path.npos) throw Error(path + ": has a line feed, which a script cannot hold; rename it");
  for (const std::string& word : of.command)
    if (word.find('\n') != word.npos) throw Error(word + ": has a line feed, which a script cannot hold; rename it");
}

std::string shell_words(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + shell_word(word);
  return line;
}

/// The path of logs in a line of options of sbatch, where % begins a pattern.
std::string log_pattern(const std::filesystem::path& folder) {
  const std::string path = folder.string();
  if (path.find('\\') != path.npos)
    throw Error(path +
                ": has a backslash, which Slurm does not accept in the path of a log; choose another folder with "
                "--out");
  std::string text;
  for (const char c : path) text += c == '%' ? "%%" : c == '"' ? "\\\"" : std::string(1, c);
  return '"' + text + "/%A_%a.txt\"";
}

/// Whether one of the lines has an option of sbatch, written in one of these ways.
bool is_given(const std::vector<std::string>& lines, std::initializer_list<const char*> ways) {
  return std::ranges::any_of(lines, [&](const std::string& line) {
    return std::ranges::any_of(ways, [&](const char* way) { return (' ' + line).find(way) != std::string::npos; });
  });
}

std::string job_name(const std::string& study) {
  std::string name = study;
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && std::string("._-").find(c) == std::string::npos) c = '_';
  return name;
}

std::string hours(double seconds) {
  const auto minutes = static_cast<long>(std::ceil(seconds / 60 - 1e-9));
  return fmt::format("{:02}:{:02}:00", minutes / 60, minutes % 60);
}

}  // namespace

double time_limit(double estimated) {
  const double wanted = std::isfinite(estimated) ? time_margin * estimated : most_time;
  return 60 * std::ceil(std::clamp(wanted, least_time, most_time) / 60);
}

double memory_limit(double estimated) {
  return memory_step * std::ceil((memory_margin * estimated + program_memory) / memory_step);
}

std::string slurm_script(const Submission& of, const SlurmOptions& options) {
  refuse_line_feeds(of);
  std::string text = "#!/bin/bash\n";
  text += fmt::format("{} for Slurm: one task per run. Submit with 'sbatch FILE', or run grit again.\n", script_mark);
  const auto option = [&](const std::string& line) { text += "#SBATCH " + line + '\n'; };
  option("--job-name=" + job_name(of.name));
  option(
      fmt::format("--array=0-{}{}", of.runs.size() - 1, options.at_once ? fmt::format("%{}", *options.at_once) : ""));
  option("--output=" + log_pattern(of.folder));
  option("--open-mode=append");
  option("--requeue");
  option(fmt::format("--signal=B:USR1@{}", seconds_to_save));
  option("--ntasks=1");
  option(fmt::format("--cpus-per-task={}", of.threads));
  if (!is_given(options.sbatch, {" --time=", " --time ", " -t"})) option("--time=" + hours(options.limits.seconds));
  // Options that start with "mem" exclude each other.
  if (!is_given(options.sbatch, {" --mem"}))
    option(fmt::format("--mem={:.0f}M", std::ceil(options.limits.bytes / 1e6)));
  for (const std::string& line : options.sbatch) option(line);
  text += "\nruns=(\n";
  for (const std::string& run : of.runs) text += "  " + shell_word(run) + '\n';
  text += ")\n";
  text += "cd " + shell_word(of.directory.string()) + " || exit 5\n";
  text += R"(
# Slurm sends USR1 to this shell alone when the time is nearly up. When it preempts or cancels a task it sends TERM to
# all processes. HUP makes grit save a checkpoint and end, however often it is sent.
signalled='' out_of_time=''
trap 'signalled=yes out_of_time=yes; kill -HUP "$!" 2> /dev/null' USR1
trap 'signalled=yes; kill -HUP "$!" 2> /dev/null' TERM
)";
  text += shell_words(of.command) + " \"${runs[SLURM_ARRAY_TASK_ID]}\" &\n";
  text += R"(wait "$!"
status=$?
while [[ -n $signalled ]]; do  # a signal ends 'wait'
  signalled=''
  wait "$!"
  status=$?
done
if [[ -n $out_of_time && $status -gt 128 ]]; then
  echo "out of time: the run is put back into the queue, and continues from its checkpoint"
  scontrol requeue "$SLURM_JOB_ID" && sleep 60  # which ends this script
fi
exit "$status"
)";
  return text;
}

std::string parallel_script(const Submission& of, const ParallelOptions& options) {
  refuse_line_feeds(of);
  std::string text = "#!/bin/bash\n";
  text += fmt::format("{} for GNU parallel: one line per run. Run it again to continue.\n", script_mark);
  text += "cd " + shell_word(of.directory.string()) + " || exit 5\n";
  std::vector<std::string> words{"parallel"};
  if (options.at_once) words.insert(words.end(), {"--jobs", std::to_string(*options.at_once)});
  else words.insert(words.end(), {"--jobs", fmt::format("{}%", std::max(1u, 100 / of.threads))});
  words.insert(words.end(), {"--joblog", (of.folder / "joblog.txt").string(), "--resume-failed"});
  // Time to save a checkpoint.
  words.insert(words.end(), {"--termseq", "TERM,60000,KILL,25"});
  if (!options.hosts.empty()) {
    const bool is_file = std::filesystem::is_regular_file(options.hosts);
    words.insert(words.end(),
                 {"--workdir", of.directory.string(), is_file ? "--sshloginfile" : "--sshlogin",
                  is_file ? std::filesystem::absolute(options.hosts).lexically_normal().string() : options.hosts});
  }
  text += "export PARALLEL_SHELL=/bin/sh\n";
  text += "exec " + shell_words(words) + " << 'end_of_runs'\n";
  for (const std::string& run : of.runs) text += shell_words(of.command) + ' ' + shell_word(run) + '\n';
  return text + "end_of_runs\n";
}

bool is_own_script(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  std::getline(file, line);
  return line.starts_with(script_mark);
}

std::string job_in(const std::string& output) {
  std::string job;
  for (const auto line : std::views::split(output, '\n')) {
    const std::string text(line.begin(), line.end());
    const std::string id = text.substr(0, text.find(';'));  // a semicolon precedes the name of a cluster
    if (!id.empty() && id.find_first_not_of("0123456789") == id.npos) job = id;
  }
  return job;
}

std::filesystem::path program_in_path(const std::string& name) {
  const char* const path = std::getenv("PATH");
  for (const auto part : std::views::split(std::string_view(path == nullptr ? "" : path), ':')) {
    const auto file = std::filesystem::path(std::string(part.begin(), part.end())) / name;
    if (std::filesystem::is_regular_file(file) && ::access(file.c_str(), X_OK) == 0) return file;
  }
  return {};
}

}  // namespace grit
