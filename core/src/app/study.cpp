#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "app/estimate.hpp"
#include "app/interrupt.hpp"
#include "app/options.hpp"
#include "app/progress_bar.hpp"
#include "app/runs_folder.hpp"
#include "app/study_runs.hpp"
#include "app/submit.hpp"
#include "format/duration.hpp"
#include "format/number.hpp"
#include "format/symbols.hpp"
#include "grit/error.hpp"
#include "output/own_files.hpp"
#include "storage/atomic_file.hpp"
#include "study/batch.hpp"
#include "study/study_page.hpp"
#include "study/study_result.hpp"
#include "study/study_sentences.hpp"

namespace grit {
namespace {

/// Progress of the whole study.
class StudyProgress {
 public:
  StudyProgress(std::size_t all, std::size_t missing, bool quiet) : all_(all), missing_(missing), quiet_(quiet) {}
  void ended() { ++ended_; }
  void show(std::size_t running) {
    if (quiet_ || !line_.is_due()) return;
    std::string text = fmt::format("{} of {} runs, {} running", all_ - missing_ + ended_, all_, running);
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
    if (ended_ > 0)
      text += ", about " +
              duration_text(elapsed / static_cast<double>(ended_) * static_cast<double>(missing_ - ended_)) + " left";
    line_.show(text);
  }
  /// The same where only the number of those that have ended is known.
  void show_ended(std::size_t ended) {
    if (!quiet_ && line_.is_due()) line_.show(fmt::format("{} of {} runs", all_ - missing_ + ended, all_));
  }
  void end() { line_.end(); }

 private:
  std::size_t all_, missing_, ended_ = 0;
  bool quiet_;
  ProgressLine line_;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

bool is_own_table(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string head;
  std::getline(file, head);
  return head.starts_with("variant,") && head.find(",metric,") != std::string::npos;
}

std::filesystem::path log_of(const StudyRun& run) { return run.folder / "log.txt"; }

/// Throws FileError if the study would replace a file that no study wrote.
void refuse_foreign_files_of_study(const std::filesystem::path& out, const std::vector<StudyRun>& runs) {
  refuse_results_of_others(out, ResultsOf::study);
  const auto check = [](const std::filesystem::path& path, const auto& is_own) {
    if (std::filesystem::exists(path) && !(std::filesystem::is_regular_file(path) && is_own(path)))
      throw FileError(path.string() +
                      ": no study wrote this file: it would be lost; move it away, or choose another folder with "
                      "--out");
  };
  check(out / "study.json", is_study_json);
  check(out / "study.csv", is_own_table);
  refuse_foreign_page(out / "study.html");
  for (const StudyRun& run : runs) refuse_foreign_run(run.folder);
}

/// Throws FileError, also if the first finished run lacks a channel of a metric.
void run_missing(const StudyDescription& study, const std::vector<StudyRun>& runs, std::size_t all,
                 const Options& options, const std::atomic<bool>& interrupted) {
  std::vector<BatchJob> jobs;
  for (const StudyRun& run : runs) jobs.push_back({run.words, log_of(run)});
  StudyProgress progress(all, runs.size(), options.has("quiet"));
  std::string trouble;
  bool seen = false;
  const auto inspect = [&](const StudyRun& run) {
    for (const auto& [name, metric] : study.metrics) try {
        take_metric(metric, run.folder);
      } catch (const FileError& error) {
        trouble = error.what();
      } catch (const NumericsError&) {
        // This run did not get far enough; others may.
      }
    return trouble.empty();
  };
  const auto ended = [&](std::size_t i, int status) {
    progress.ended();
    if (status == static_cast<int>(ExitStatus::done)) return std::exchange(seen, true) || inspect(runs[i]);
    if (status == static_cast<int>(ExitStatus::numerics) || status == static_cast<int>(ExitStatus::interrupted))
      return true;
    if (trouble.empty() && !interrupted.load()) trouble = failed_run_text(runs[i].name, status, log_of(runs[i]));
    return false;
  };
  run_batch(jobs, options.number("jobs"), interrupted,
            {.ended = ended, .waiting = [&](std::size_t running) { progress.show(running); }});
  progress.end();
  if (!trouble.empty()) throw FileError(trouble);
}

/// "peak 21.4 ± 0.3 kPa" of each metric with one value.
std::vector<std::string> value_texts(const VariantResult& one) {
  std::vector<std::string> texts;
  for (const auto& [name, value] : one.values) {
    const ReadableUnit shown = readable(value.unit, std::abs(value.mean));
    const double spread = shown.factor * value.standard_error();
    texts.push_back(fmt::format("{} {:.4g} ± {}{}", name, shown.factor * value.mean,
                                std::isfinite(spread) ? fmt::format("{:.2g}", spread) : "?",
                                shown.unit.empty() || shown.unit == "1" ? "" : " " + shown.unit));
  }
  return texts;
}

void print(const StudyResult& result) {
  for (const VariantResult& one : result.variants) {
    std::cout << "  " << one.variant.name << ": ";
    if (result.study.is_sweep() && (!one.values.empty() || !one.curves.empty())) {
      auto texts = value_texts(one);
      texts.push_back(cost_text(one.core_seconds) + " on one core");
      std::cout << fmt::format("{}\n", fmt::join(texts, ", "));
      continue;
    }
    if (one.complete() && !result.study.is_sweep()) {
      std::cout << fmt::format("{} on one core, largest {} {} ± {} ({})\n", cost_text(one.core_seconds),
                               result.study.compares_with_finest() ? "error" : "difference",
                               percent(one.of_worst().error), percent(one.of_worst().standard_error), one.worst);
      continue;
    }
    const auto failed = std::ranges::find_if(one.samples, [](const Sample& s) { return s.status != "done"; });
    std::cout << (failed == one.samples.end() ? "no reference"
                  : failed->message.empty()   ? failed->status
                                              : failed->message)
              << '\n';
  }
  if (const std::string conclusion = verdict(result); !conclusion.empty()) std::cout << conclusion << '\n';
}

/// What the largest of the runs takes.
void enlarge(TaskLimits& most, const LiveScene& live, const Scene& scene, const Registry& registry, unsigned threads) {
  try {
    const Estimate one = estimate(live, scene, registry);
    const double body_steps = one.all_known ? one.least_body_steps : one.most_body_steps;
    most.seconds = std::max(most.seconds, body_steps / planning_speed(threads));
    most.bytes = std::max({most.bytes, one.memory_now, one.memory_dense});
  } catch (const NumericsError&) {
    // A variant that fails at once takes nothing.
  }
}

/// Whether the results of a study have what it is about.
bool is_evaluated(const StudyResult& result) {
  if (!result.study.is_sweep()) return !result.reference.empty();
  return std::ranges::any_of(result.variants,
                             [](const VariantResult& one) { return !one.values.empty() || !one.curves.empty(); });
}

/// Writes and prints the results.
StudyResult evaluate(const StudyPlace& place, const std::map<std::filesystem::path, std::string>& unusable) {
  std::set<std::filesystem::path> omitted;
  for (const auto& [folder, why] : unusable) {
    std::cerr << "grit: warning: " << why << "\n  the run counts as missing" << std::endl;
    omitted.insert(folder);
  }
  StudyResult result = evaluate_study(place.study, place.out, omitted);
  write_beside_others(place.out / "study.json", to_json(result).dump(2) + "\n");
  write_beside_others(place.out / "study.csv", to_csv(result));
  write_beside_others(place.out / "study.html", study_page(result));
  print(result);
  for (const std::string& line : failed_runs(result)) std::cerr << "grit: failed: " << line << std::endl;
  for (const std::string& line : not_evaluated(result)) std::cerr << "grit: not evaluated: " << line << std::endl;
  std::cout << "page: " << (place.out / "study.html").string() << '\n';
  return result;
}

std::size_t unfinished(const StudyResult& result) { return result.count("missing") + result.count("under way"); }

/// Evaluates what is there, also while runs go on.
ExitStatus collect(const StudyPlace& place, const Options& options, const Registry& registry) {
  if (!std::filesystem::is_directory(place.out / "runs"))
    throw FileError(place.out.string() +
                    ": has no runs of the study; omit --collect to run them, or give the folder that has them with "
                    "--out");
  std::optional<FolderLock> lock;
  lock_folder(place.out, "grit study", lock);
  refuse_foreign_files_of_study(place.out, {});
  const StudyResult result = evaluate(place, unusable_runs(place, options, registry));
  return is_evaluated(result) || unfinished(result) > 0 ? ExitStatus::done : ExitStatus::numerics;
}

/// Runs the missing runs by GNU parallel.
ExitStatus do_in_parallel(const StudyPlace& place, const std::vector<StudyRun>& runs, std::size_t all,
                          const Options& options, const Registry& registry) {
  const auto& interrupted = catch_interrupts();
  StudyProgress progress(all, runs.size(), options.has("quiet"));
  run_in_parallel(place, runs, options, interrupted, [&](std::size_t ended) { progress.show_ended(ended); });
  progress.end();
  if (options.has("dry-run")) return ExitStatus::done;
  if (interrupted.load()) {
    std::cerr << "interrupted; run the same command again to continue" << std::endl;
    return ExitStatus::interrupted;
  }
  const StudyResult result = evaluate(place, unusable_runs(place, options, registry));
  if (const std::size_t left = unfinished(result); left > 0)
    throw FileError(fmt::format("{} did not end; see {}, and run the same command again to continue",
                                counted(left, "run", "runs"), (place.out / "cluster/parallel.txt").string()));
  return is_evaluated(result) ? ExitStatus::done : ExitStatus::numerics;
}

}  // namespace

void study_options(Options& options) {
  namespace po = boost::program_options;
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  options.add()("out", po::value<std::string>()->value_name("DIR"),
                "folder of runs and results; default: results/NAME")(
      "jobs", po::value<std::string>()->default_value(std::to_string(cores), "all cores")->value_name("N"),
      "concurrent runs")("threads", po::value<std::string>()->default_value("1")->value_name("N"), "threads per run")(
      "dry-run", "list the missing runs and exit")(
      "overwrite", "replace runs of another description, another grit or another build of a plugin")(
      "collect", "evaluate existing runs of any revision of grit, also while others go on; start no runs")(
      "quiet,q", "print results only, no progress");
  add_submit_options(options);
}

ExitStatus study_command(const Options& options) {
  outlive_readers();
  const std::filesystem::path file = options.only_word("study");
  if (options.has("dry-run") && options.has("collect"))
    throw UsageError("--dry-run lists the missing runs, --collect starts none; give one of them");
  options.number("jobs"), options.threads();
  check_submit_options(options);
  const std::string how = options.has("submit") ? options.get<std::string>("submit") : "";
  if (how.empty()) options.warn_of_threads();
  const auto registry = options.registry();
  const StudyPlace place{
      load_study(file), file,
      options.has("out") ? std::filesystem::path(options.get<std::string>("out")) : default_results(file)};
  const std::filesystem::path& out = place.out;
  if (options.has("only")) return do_only(place, options.get<std::string>("only"), options, *registry);
  if (options.has("collect")) return collect(place, options, *registry);
  std::optional<FolderLock> lock;  // taken before missing runs are listed; but an invalid study creates no folder
  if (!options.has("dry-run") && std::filesystem::is_directory(out)) lock_folder(out, "grit study", lock);
  std::size_t all = 0;
  TaskLimits estimated;
  std::function<void(const LiveScene&, const Scene&)> measure;
  if (how == "slurm")
    measure = [&](const LiveScene& live, const Scene& scene) {
      enlarge(estimated, live, scene, *registry, options.threads());
    };
  const auto runs = missing_runs(place, options, *registry, all, measure);
  if (!runs.empty()) warn_of_idle_settings(place, *registry);
  if (options.has("dry-run")) {
    for (const StudyRun& run : runs) std::cout << run.name << '\n';
    std::cout << runs.size() << " of " << all << " runs are missing in " << out.string() << '\n';
    if (const auto others = std::ranges::count_if(runs, &StudyRun::replaces); others > 0)
      std::cout << others << " of them replace runs of another description, and need --overwrite\n";
    if (how.empty() || runs.empty()) return ExitStatus::done;
  }
  if (!lock) {
    std::filesystem::create_directories(out);
    lock_folder(out, "grit study", lock);
  }
  refuse_foreign_files_of_study(out, runs);
  if (!options.has("overwrite"))
    if (const auto first = std::ranges::find_if(runs, &StudyRun::replaces); first != runs.end())
      refuse_other_runs(out, static_cast<std::size_t>(std::ranges::count_if(runs, &StudyRun::replaces)), first->folder);
  if (!options.has("dry-run")) {
    if (!runs.empty()) refuse_queued_job(out);
    if (!options.has("quiet"))
      std::cerr << (place.study.title.empty() ? file.string() : place.study.title) << ": " << runs.size() << " of "
                << all << " runs to do, results in " << out.string() << std::endl;
  }
  if (how == "slurm" && !runs.empty()) {
    submit_to_slurm(place, runs, options, estimated);
    return ExitStatus::done;
  }
  if (how == "parallel" && !runs.empty()) return do_in_parallel(place, runs, all, options, *registry);
  const auto& interrupted = catch_interrupts();
  run_missing(place.study, runs, all, options, interrupted);
  if (interrupted.load()) {
    std::cerr << "interrupted; run the same command again to continue" << std::endl;
    return ExitStatus::interrupted;
  }
  // The scene may have been edited meanwhile.
  return is_evaluated(evaluate(place, unusable_runs(place, options, *registry))) ? ExitStatus::done
                                                                                 : ExitStatus::numerics;
}

}  // namespace grit
