#include "app/submit.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include "format/duration.hpp"
#include "format/number.hpp"
#include "format/resources.hpp"
#include "grit/error.hpp"
#include "grit/toolkit/did_you_mean.hpp"
#include "output/own_files.hpp"
#include "output/shell_word.hpp"
#include "storage/atomic_file.hpp"
#include "study/batch.hpp"

namespace grit {
namespace {

namespace fs = std::filesystem;

fs::path cluster_folder(const fs::path& out) { return fs::absolute(out).lexically_normal() / "cluster"; }
/// Has the number of the job that was submitted last.
fs::path job_file(const fs::path& out) { return cluster_folder(out) / "slurm-job.txt"; }

std::string content_of(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

struct ToolOutcome {
  int status = -1;  ///< or minus the signal that killed it
  std::string output;
};

/// Runs a short program.
ToolOutcome run_tool(std::vector<std::string> words) {
  const ScratchFile log;
  ToolOutcome outcome;
  const std::atomic<bool> never{false};
  const BatchJob job{std::move(words), log.path()};
  run_batch(
      std::span(&job, 1), 1, never,
      {.ended = [&](std::size_t, int status) { return outcome.status = status, true; }, .waiting = [](std::size_t) {}});
  outcome.output = content_of(log.path());
  return outcome;
}

constexpr const char* log_heading = "# Output of the runs of 'grit study'\n";

bool is_own_log(const fs::path& path) { return content_of(path).starts_with(log_heading); }

bool is_own_job(const fs::path& path) {
  const std::string text = content_of(path), job = job_in(text);
  return !job.empty() && text == job + '\n';
}

/// Whether GNU parallel wrote it, for runs of a study alone.
bool is_own_joblog(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  if (!line.starts_with("Seq\tHost\t")) return false;
  while (std::getline(file, line))
    if (line.find(" --only ") == line.npos) return false;
  return true;
}

void write_script(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  write_beside_others(path, text);
  fs::permissions(path, fs::perms::owner_exec, fs::perm_options::add);
}

Submission submission_of(const StudyPlace& place, const std::vector<StudyRun>& runs, const Options& options) {
  Submission of{.name = place.file.stem().string(),
                .directory = fs::current_path(),
                .folder = cluster_folder(place.out),
                .command = task_words(run_program(options), place.file, place.out, options.has("overwrite")),
                .runs = {},
                .threads = options.threads()};
  for (const StudyRun& run : runs) of.runs.push_back(run.within.string());
  return of;
}

std::optional<unsigned> at_once(const Options& options) {
  return options.given("jobs") ? std::optional(options.number("jobs")) : std::nullopt;
}

/// Throws FileError unless `parallel` is GNU parallel: moreutils has another program of this name.
void expect_gnu_parallel(const fs::path& program) {
  if (run_tool({program.string(), "--version"}).output.starts_with("GNU parallel")) return;
  throw FileError(
      "--submit parallel: " + program.string() +
      " is not GNU parallel, but another program of this name; install GNU parallel (package \"parallel\"), "
      "or put it first in PATH");
}

}  // namespace

void add_submit_options(Options& options) {
  namespace po = boost::program_options;
  options.add()(
      "submit", po::value<std::string>()->value_name("slurm|parallel"),
      "do the missing runs by a scheduler: as one job array of Slurm, or by GNU parallel. With --dry-run only "
      "its script is written")(
      "sbatch", po::value<std::vector<std::string>>()->composing()->value_name("OPTIONS"),
      "options for sbatch, such as --sbatch='--partition=long --account=soil'; they replace those of grit; may be "
      "repeated")("hosts", po::value<std::string>()->value_name("HOSTS"),
                  "hosts for GNU parallel, which share the folder of results: a file with one a line, or a list with "
                  "commas")("only", po::value<std::string>()->value_name("RUN"),
                            "do one run, or continue it, and evaluate nothing: its folder, such as runs/usual/seed-1");
}

void check_submit_options(const Options& options) {
  const bool submits = options.has("submit");
  const std::string how = submits ? options.get<std::string>("submit") : "";
  const std::vector<std::string> known{"slurm", "parallel"};
  if (submits && std::ranges::find(known, how) == known.end())
    throw UsageError("--submit takes slurm or parallel, not \"" + how + '"' + did_you_mean(how, known));
  if (options.has("sbatch") && how != "slurm")
    throw UsageError("--sbatch has options for Slurm; give --submit slurm, too");
  if (options.has("hosts") && how != "parallel")
    throw UsageError("--hosts has hosts for GNU parallel; give --submit parallel, too");
  if (submits && options.has("collect"))
    throw UsageError("--submit starts the missing runs, --collect starts none; give one of them");
  for (const std::string& line : options.list("sbatch"))
    if (!line.starts_with('-') || line.find('\n') != line.npos)
      throw UsageError("--sbatch takes options for sbatch in one line, such as '--partition=long', not \"" + line +
                       '"');
  if (options.has("only"))
    for (const char* other : {"submit", "collect", "dry-run"})
      if (options.has(other)) throw UsageError(std::string("--only does one run; give it without --") + other);
  if (!submits || options.has("dry-run")) return;
  const bool slurm = how == "slurm";
  if (program_in_path(slurm ? "sbatch" : "parallel").empty())
    throw FileError(
        fmt::format("--submit {}: no program \"{}\" was found in PATH; {}, or give --dry-run to write its "
                    "script only",
                    how, slurm ? "sbatch" : "parallel",
                    slurm ? "log in to a machine of the cluster that has it, or load its module"
                          : "install GNU parallel (package \"parallel\")"));
}

void refuse_queued_job(const fs::path& out) {
  const std::string job = job_in(content_of(job_file(out)));
  if (job.empty() || program_in_path("squeue").empty()) return;
  const ToolOutcome queue = run_tool({"squeue", "--noheader", "--jobs=" + job, "--format=%i %T"});
  if (queue.status != 0) {
    // Slurm forgets a job some minutes after its end.
    if (queue.output.find("Invalid job id") == std::string::npos)
      std::cerr << "grit: warning: squeue cannot tell whether job " << job << " of this study goes on: " << queue.output
                << std::flush;
    return;
  }
  if (queue.output.empty()) return;
  throw FileError(
      fmt::format("{}: the job {} of this study is in the queue of Slurm:\n{}wait for it, or cancel it with "
                  "'scancel {}'; --collect evaluates what is done",
                  out.string(), job, queue.output, job));
}

std::string collect_command(const StudyPlace& place, const Options& options) {
  return "grit study " + shell_word(place.file.string()) +
         (options.has("out") ? " --out " + shell_word(place.out.string()) : "") + " --collect";
}

void submit_to_slurm(const StudyPlace& place, const std::vector<StudyRun>& runs, const Options& options,
                     const TaskLimits& estimated) {
  const Submission of = submission_of(place, runs, options);
  const TaskLimits limits{time_limit(estimated.seconds), memory_limit(estimated.bytes)};
  const fs::path script = of.folder / "slurm.sh";
  refuse_foreign_file(script, is_own_script);
  refuse_foreign_file(job_file(place.out), is_own_job);
  write_script(script, slurm_script(of, {limits, at_once(options), options.list("sbatch")}));
  std::cout << fmt::format(
                   "time limit: {} a run, three times the estimate of the longest, {}, but 10 min to 24 h; a run "
                   "that needs more continues from its checkpoint\n",
                   duration_text(limits.seconds), duration_text(estimated.seconds))
            << fmt::format("memory: {} a run, twice the estimate of the largest, {}, and 256 MB\n",
                           bytes_text(limits.bytes), bytes_text(estimated.bytes))
            << "script: " << script.string() << '\n';
  if (options.has("dry-run")) {
    std::cout << "submit:  sbatch " << shell_word(script.string()) << '\n';
    return;
  }
  const ToolOutcome sbatch = run_tool({"sbatch", "--parsable", script.string()});
  const std::string job = job_in(sbatch.output);
  if (sbatch.status != 0 || job.empty())
    throw FileError(
        fmt::format("sbatch did not accept {}:\n{}change the options with --sbatch{}", script.string(),
                    sbatch.output.empty() || sbatch.output.ends_with('\n') ? sbatch.output : sbatch.output + '\n',
                    of.runs.size() > 1000 ? "; arrays have a largest size, see 'scontrol show config | grep "
                                            "MaxArraySize'"
                                          : ""));
  write_beside_others(job_file(place.out), job + '\n');
  std::cout << fmt::format("job {}: {}\n", job, counted(of.runs.size(), "run", "runs"))
            << fmt::format("watch:   squeue --jobs={}; logs: {}\n", job,
                           shell_word((of.folder / (job + "_*.txt")).string()))
            << fmt::format("cancel:  scancel {}\n", job) << "collect: " << collect_command(place, options) << '\n';
}

void run_in_parallel(const StudyPlace& place, const std::vector<StudyRun>& runs, const Options& options,
                     const std::atomic<bool>& interrupted, const std::function<void(std::size_t)>& waiting) {
  const Submission of = submission_of(place, runs, options);
  const std::string hosts = options.has("hosts") ? options.get<std::string>("hosts") : "";
  const fs::path script = of.folder / "parallel.sh", joblog = of.folder / "joblog.txt",
                 log = of.folder / "parallel.txt";
  refuse_foreign_file(script, is_own_script);
  refuse_foreign_file(joblog, is_own_joblog);
  refuse_foreign_file(log, is_own_log);
  write_script(script, parallel_script(of, {at_once(options), hosts}));
  std::cout << "script: " << script.string() << '\n';
  if (options.has("dry-run")) {
    std::cout << "run:     " << shell_word(script.string()) << "\ncollect: " << collect_command(place, options) << '\n';
    return;
  }
  expect_gnu_parallel(program_in_path("parallel"));
  fs::remove(joblog);  // of other runs: those that are done are not in the script
  const BatchJob job{{script.string()}, log, log_heading};
  int outcome = 0;
  run_batch(std::span(&job, 1), 1, interrupted,
            {.ended = [&](std::size_t, int status) { return outcome = status, true; },
             .waiting =
                 [&](std::size_t) {
                   const std::string lines = content_of(joblog);
                   const auto count = std::ranges::count(lines, '\n');
                   waiting(count > 0 ? static_cast<std::size_t>(count) - 1 : 0);  // the first line has the names
                 }});
  // Up to 101 the status counts the runs that failed; their results say why.
  if (!interrupted.load() && (outcome < 0 || outcome > 101))
    throw FileError(fmt::format("parallel ended with status {}:\n{}", outcome, content_of(job.log)));
}

}  // namespace grit
