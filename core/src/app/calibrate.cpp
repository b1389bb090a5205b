#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <optional>
#include <thread>

#include "app/estimate.hpp"
#include "app/interrupt.hpp"
#include "app/options.hpp"
#include "app/progress_bar.hpp"
#include "app/runs_folder.hpp"
#include "app/study_runs.hpp"
#include "app/trial_runs.hpp"
#include "calibration/calibration.hpp"
#include "calibration/calibration_page.hpp"
#include "format/duration.hpp"
#include "format/number.hpp"
#include "grit/error.hpp"
#include "output/own_files.hpp"
#include "simulation/live_scene.hpp"
#include "storage/atomic_file.hpp"

namespace grit {
namespace {

constexpr const char* fitted_mark = "Fitted by grit calibrate: ";

/// Progress of the whole calibration, whose length is known as an upper bound only.
class CalibrationProgress {
 public:
  CalibrationProgress(std::size_t most, std::int64_t runs, bool quiet) : most_(most), runs_(runs), quiet_(quiet) {}
  void show(const Trials& trials, std::size_t ended) {
    if (quiet_ || !line_.is_due()) return;
    std::string text =
        fmt::format("trial {} of at most {}, {} of {} runs", trials.all().size() + 1, most_, ended, runs_);
    if (!trials.all_failed()) text += ", least misfit " + number(trials.misfit(trials.all()[trials.best()]));
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
    if (done_ > 0)
      text += ", at most " +
              duration_text(elapsed / static_cast<double>(done_) *
                            static_cast<double>(most_ - std::min(most_, trials.all().size()))) +
              " left";
    line_.show(text);
  }
  void trial_ended() { ++done_; }
  void end() { line_.end(); }

 private:
  std::size_t most_, done_ = 0;
  std::int64_t runs_;
  bool quiet_;
  ProgressLine line_;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

std::size_t most_trials(const CalibrationDescription& calibration) {
  return static_cast<std::size_t>(calibration.optimizer.trials) + most_further_trials(calibration.parameters.size());
}

/// Throws FileError if the calibration would replace a file that none wrote, or the results of another one.
void refuse_foreign_files_of_calibration(const CalibrationPlace& place, bool overwrite) {
  const auto results = place.out / "calibration.json", fitted = place.out / "fitted.json";
  const auto refuse = [](const std::filesystem::path& path) {
    throw FileError(path.string() +
                    ": no calibration wrote this file: it would be lost; move it away, or choose another folder with "
                    "--out");
  };
  refuse_results_of_others(place.out, ResultsOf::calibration);
  refuse_foreign_page(place.out / "calibration.html");
  if (std::filesystem::exists(fitted))
    if (const Description json = json_at(fitted); !json.is_object() || !json.contains("//") ||
                                                  !json["//"].is_string() ||
                                                  !json["//"].get<std::string>().starts_with(fitted_mark))
      refuse(fitted);
  refuse_foreign_trials(place.out);
  if (!std::filesystem::exists(results)) return;
  if (!is_calibration_json(results)) refuse(results);
  if (json_at(results)["calibration"] != place.written.json() && !overwrite)
    throw FileError(place.out.string() +
                    ": holds another calibration, or an earlier version of this one; give --overwrite to remove its "
                    "trials, or choose another folder with --out");
}

void print_plan(const CalibrationPlace& place, const Scene& scene, const Registry& registry, std::size_t at_once,
                unsigned threads) {
  const auto samples = static_cast<std::size_t>(place.calibration.samples.count);
  const std::size_t most = most_trials(place.calibration);
  std::cout << fmt::format("at most {} runs: {} trials of the search and {} around its optimum, {} each\n",
                           most * samples, place.calibration.optimizer.trials,
                           most_further_trials(place.calibration.parameters.size()), counted(samples, "run", "runs"));
  try {
    const LiveScene live(scene);
    const Estimate one = estimate(live, scene, registry);
    const double seconds = (one.all_known ? one.least_body_steps : one.most_body_steps) / planning_speed(threads);
    const double rounds = std::ceil(static_cast<double>(samples) / static_cast<double>(at_once));
    std::cout << fmt::format("about {} a run, at most {} with {} at once\n", cost_text(seconds),
                             duration_text(seconds * rounds * static_cast<double>(most)), at_once);
  } catch (const NumericsError& error) {
    std::cout << "time of a run unknown: " << error.what() << '\n';
  }
}

/// Writes and prints the results.
void publish(const CalibrationPlace& place, const Trials& trials, const CalibrationOutcome& outcome) {
  const CalibrationDescription& calibration = place.calibration;
  const auto values = trials.all()[outcome.optimum].values;
  const auto base = std::filesystem::proximate(calibration.base, std::filesystem::absolute(place.out));
  Description fitted = {
      {"//", fitted_mark + fmt::format("{}", fmt::join(parameter_texts(calibration, trials, outcome), "; "))}};
  fitted.update(fitted_description(calibration, base, values));
  write_beside_others(place.out / "calibration.json",
                      to_json(calibration, place.written.json(), trials, &outcome).dump(2) + "\n");
  write_beside_others(place.out / "fitted.json", fitted.dump(2) + "\n");
  write_beside_others(place.out / "calibration.html", calibration_page(calibration, trials, outcome));
  for (const auto& texts :
       {parameter_texts(calibration, trials, outcome), target_texts(calibration, trials, outcome)}) {
    for (const std::string& text : texts) std::cout << "  " << text << '\n';
    std::cout << '\n';
  }
  for (const std::string& sentence : verdict(calibration, trials, outcome)) std::cout << sentence << '\n';
  std::cout << "fitted description: " << (place.out / "fitted.json").string()
            << "\npage: " << (place.out / "calibration.html").string() << '\n';
}

std::string values_text(const CalibrationDescription& calibration, const std::vector<double>& values) {
  std::vector<std::string> texts;
  std::size_t k = 0;
  for (const auto& [name, parameter] : calibration.parameters) {
    const Description value = parameter.written(values[k++]);
    texts.push_back(name + '=' + (value.is_string() ? value.get<std::string>() : value.dump()));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

CalibrationPlace place_of(const std::filesystem::path& file, const Options& options) {
  CalibrationPlace place;
  place.calibration = load_calibration(file);
  place.written = Document::load(file);
  place.out = options.has("out") ? std::filesystem::path(options.get<std::string>("out")) : default_results(file);
  return place;
}

}  // namespace

void calibrate_options(Options& options) {
  namespace po = boost::program_options;
  options.add()("out", po::value<std::string>()->value_name("DIR"),
                "folder of runs and results; default: results/NAME")(
      "jobs", po::value<std::string>()->value_name("N"), "concurrent runs; default: runs_at_once of the file")(
      "threads", po::value<std::string>()->default_value("1")->value_name("N"), "threads per run")(
      "dry-run", "print the number of runs and their time, and exit")(
      "overwrite", "remove the runs of trials in the folder")("quiet,q", "print results only, no progress");
}

ExitStatus calibrate_command(const Options& options) {
  outlive_readers();
  const std::filesystem::path file = options.only_word("calibration");
  options.warn_of_threads();
  const auto registry = options.registry();
  CalibrationPlace place = place_of(file, options);
  const CalibrationDescription& calibration = place.calibration;
  const auto at_once = options.has("jobs") ? options.number("jobs")
                       : calibration.optimizer.runs_at_once > 0
                           ? static_cast<unsigned>(calibration.optimizer.runs_at_once)
                           : std::max(1u, std::thread::hardware_concurrency());

  const bool quiet = options.has("quiet");
  const auto& interrupted = options.has("dry-run") ? end_on_interrupts() : catch_interrupts();
  CalibrationProgress progress(most_trials(calibration), calibration.samples.count, quiet);
  std::optional<Trials> trials;
  const TrialRuns runs(place, run_program(options), at_once, *registry, interrupted,
                       [&](std::size_t ended) { progress.show(*trials, ended); });
  CheckedTrials checked = runs.check();
  place.observations = std::move(checked.observations);
  if (options.has("dry-run")) {
    print_plan(place, checked.first, *registry, at_once, options.threads());
    return ExitStatus::done;
  }
  std::filesystem::create_directories(place.out);
  std::optional<FolderLock> lock;
  lock_folder(place.out, "grit calibrate", lock);
  refuse_foreign_files_of_calibration(place, options.has("overwrite"));
  if (options.has("overwrite")) remove_trials(place.out);
  if (!quiet)
    std::cerr << (calibration.title.empty() ? file.string() : calibration.title) << ": at most "
              << most_trials(calibration) << " trials of "
              << counted(static_cast<std::size_t>(calibration.samples.count), "run", "runs") << ", results in "
              << place.out.string() << std::endl;

  std::vector<ParameterDescription> parameters;
  for (const auto& [name, parameter] : calibration.parameters) parameters.push_back(parameter);
  const auto evaluate = [&](std::size_t number, const std::vector<double>& values) {
    write_beside_others(place.out / "calibration.json",
                        to_json(calibration, place.written.json(), *trials, nullptr).dump(2) + "\n");
    auto samples = runs(number, values);
    progress.trial_ended();
    for (const TrialSample& sample : samples)
      if (sample.found.empty()) {
        progress.end();
        std::cerr << fmt::format("grit: warning: trial {} ({}) failed, seed {:.0f}: {}", number + 1,
                                 values_text(calibration, values), sample.seed, sample.failure)
                  << std::endl;
        break;
      }
    return samples;
  };
  trials.emplace(parameters, place.observations, evaluate);
  try {
    const CalibrationOutcome outcome = calibrate(*trials, calibration.optimizer);
    progress.end();
    publish(place, *trials, outcome);
  } catch (const Interrupted&) {
    progress.end();
    std::cerr << "interrupted; run the same command again to continue" << std::endl;
    return ExitStatus::interrupted;
  }
  return ExitStatus::done;
}

}  // namespace grit
