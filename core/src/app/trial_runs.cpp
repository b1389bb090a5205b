#include "app/trial_runs.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include "app/idle_settings.hpp"
#include "app/metric_checks.hpp"
#include "app/runs_folder.hpp"
#include "calibration/observations.hpp"
#include "description/placed_error.hpp"
#include "grit/error.hpp"
#include "input/places.hpp"
#include "output/own_files.hpp"
#include "output/plugins_used.hpp"
#include "simulation/live_scene.hpp"
#include "study/batch.hpp"
#include "study/study_result.hpp"

namespace grit {
namespace {

/// Places at which each parameter is checked before the first run: both ends, and values with digits between.
constexpr std::array tried_places{0.0, 1.0, 0.618034, 0.0618034};
constexpr const char* within_range =
    ". A calibration tries all values of the range; choose one within which all are allowed, or vary the value in a "
    "study";

std::filesystem::path folder_of(const std::filesystem::path& out, std::size_t number) {
  return out / "trials" / fmt::format("{:04}", number + 1);
}

std::filesystem::path folder_of(const std::filesystem::path& trial, double seed) {
  return trial / fmt::format("seed-{:.0f}", seed);
}

std::filesystem::path log_in(const std::filesystem::path& run) { return run / "log.txt"; }

/// Folders in which runs of trials are, by their names.
std::vector<std::filesystem::path> runs_of_trials(const std::filesystem::path& out) {
  std::vector<std::filesystem::path> all;
  const auto named = [](const std::filesystem::path& path, const std::string& beginning) {
    const std::string name = path.filename().string();
    return std::filesystem::is_directory(path) && name.starts_with(beginning) && name != beginning &&
           name.find_first_not_of("0123456789", beginning.size()) == name.npos;
  };
  if (!std::filesystem::is_directory(out / "trials")) return all;
  for (const auto& trial : std::filesystem::directory_iterator(out / "trials"))
    if (named(trial.path(), ""))
      for (const auto& run : std::filesystem::directory_iterator(trial.path()))
        if (named(run.path(), "seed-")) all.push_back(run.path());
  return all;
}

/// Whether one of two values is part of the other.
bool overlap(const std::string& one, const std::string& other) {
  return (one + '/').starts_with(other + '/') || (other + '/').starts_with(one + '/');
}

/// Where a calibration names a pointer of a parameter.
std::string place_of_pointer(const std::string& parameter, std::size_t index) {
  return fmt::format("/parameters/{}/pointers/{}", pointer_token(parameter), index);
}

/// Where a calibration names the value at a pointer; empty if it does not.
std::string place_of(const CalibrationDescription& calibration, const std::string& pointer) {
  for (const auto& [name, parameter] : calibration.parameters)
    for (std::size_t i = 0; i < parameter.pointers.size(); ++i)
      if (overlap(pointer, parameter.pointers[i])) return place_of_pointer(name, i);
  if (pointer == calibration.samples.pointer) return "/samples/pointer";
  for (const auto& [own, value] : calibration.set.items())
    if (overlap(pointer, own)) return "/set/" + pointer_token(own);
  return "";
}

}  // namespace

TrialRuns::TrialRuns(const CalibrationPlace& place, RunProgram program, std::size_t at_once, const Registry& registry,
                     const std::atomic<bool>& interrupted, std::function<void(std::size_t)> waiting)
    : place_(place),
      base_(Document::load(place.calibration.base).json()),
      program_(std::move(program)),
      at_once_(at_once),
      registry_(registry),
      interrupted_(interrupted),
      waiting_(std::move(waiting)) {}

std::vector<std::string> TrialRuns::sets(const std::vector<double>& values, double seed) const {
  auto all = sets_of(place_.calibration, values);
  all.push_back(fmt::format("{}={:.0f}", place_.calibration.samples.pointer, seed));
  return all;
}

Scene TrialRuns::scene(const std::vector<double>& values) const try {
  return load_scene(place_.calibration.base, sets(values, 1), registry_);
} catch (const DescriptionError& error) {
  auto problems = error.problems();
  for (Problem& problem : problems)
    if (const std::string own = place_of(place_.calibration, problem.pointer); problem.file == "--set" && !own.empty())
      problem = place_.written.problem(own, problem.pointer + ": " + problem.message);
  throw DescriptionError(std::move(problems));
}

CheckedTrials TrialRuns::check() const {
  const CalibrationDescription& calibration = place_.calibration;
  std::vector<double> first;
  for (const auto& [name, parameter] : calibration.parameters) first.push_back(parameter.first_value());
  Scene usual = scene(first);
  std::size_t k = 0;
  for (const auto& [name, parameter] : calibration.parameters) {
    for (const double at : tried_places) {
      auto values = first;
      values[k] = parameter.value(at);
      try {
        scene(values);
      } catch (const DescriptionError& error) {
        // A scenario may refuse a combination of values that the search never meets.
        if (std::ranges::none_of(error.problems(),
                                 [&](const Problem& one) { return place_.written.sources().contains(one.file); }))
          continue;
        if (at == 0 || at == 1) throw;
        auto problems = error.problems();
        for (Problem& one : problems) one.message += within_range;
        throw DescriptionError(std::move(problems));
      }
    }
    ++k;
  }
  const auto metrics = calibration.metrics();
  const MetricsToCheck targets{&metrics, &place_.written, "/targets"};
  check_probes(targets, *usual.description);
  const LiveScene live(usual);
  std::map<std::string, std::string> units;
  at_its_place(usual.document, [&] { units = check_channels(targets, live, registry_); });
  refuse_ignored(first);
  return {std::move(usual), observations_of(calibration, place_.written, units)};
}

std::map<std::string, std::string> TrialRuns::ignored(const std::vector<double>& values) const try {
  const CalibrationDescription& calibration = place_.calibration;
  const SceneSource source{calibration.base, sets(values, 1), registry_};
  const auto idle = idle_settings(source);
  std::map<std::string, std::string> all;
  const auto add = [&](const std::string& pointer, const std::string& at) {
    if (const auto why = why_idle(idle, pointer)) all[at] = *why;
  };
  const auto run_with = [&](const std::string& pointer, const Description& value) {
    Description seen = resolved(*source.with({pointer + '=' + value.dump()}).description);
    for (const char* shown_only : {"title", "output"}) seen.erase(shown_only);
    return seen;
  };
  for (const auto& [name, parameter] : calibration.parameters)
    for (std::size_t i = 0; i < parameter.pointers.size(); ++i) {
      const std::string &pointer = parameter.pointers[i], at = place_of_pointer(name, i);
      if (run_with(pointer, parameter.written(parameter.low())) ==
          run_with(pointer, parameter.written(parameter.high())))
        all[at] = pointer + ": no run depends on it";
      add(pointer, at);
    }
  for (const auto& [pointer, value] : calibration.set.items()) add(pointer, "/set/" + pointer_token(pointer));
  return all;
} catch (const DescriptionError&) {
  return {};  // of which a trial says more
}

void TrialRuns::refuse_ignored(const std::vector<double>& first) const {
  std::vector<double> middle;
  for (const auto& [name, parameter] : place_.calibration.parameters) middle.push_back(parameter.value(0.5));
  std::vector<Problem> problems;
  if (const auto once = ignored(first); !once.empty())
    // A parameter may have no effect while another one is 0.
    for (const auto& [at, why] : ignored(middle)) {
      if (!once.contains(at)) continue;
      if (at.starts_with("/set/")) warn_of_idle(place_.written, at, why);
      else problems.push_back(place_.written.problem(at, why + "; allowed is a value that changes the run"));
    }
  if (!problems.empty()) throw DescriptionError(std::move(problems));
}

std::vector<TrialSample> TrialRuns::operator()(std::size_t number, const std::vector<double>& values) const {
  const auto folder = folder_of(place_.out, number);
  std::vector<BatchJob> jobs;
  std::vector<std::string> names;
  const auto failed = [&](const std::string& why) {
    return std::vector<TrialSample>{{.seed = 1, .found = {}, .failure = why, .core_seconds = 0}};
  };
  if (Document::load(place_.calibration.base).json() != base_)
    throw FileError(
        place_.calibration.base +
        ": was edited while the calibration ran, so that its trials would differ; run the same command again, "
        "with --overwrite if the change is wanted");
  try {
    for (std::int64_t seed = 1; seed <= place_.calibration.samples.count; ++seed) {
      const auto run = folder_of(folder, static_cast<double>(seed));
      const Scene one = load_scene(place_.calibration.base, sets(values, static_cast<double>(seed)), registry_);
      // As in run.json, whose numbers were converted to text.
      const auto description = Description::parse(resolved(*one.description).dump());
      const Progressed so_far = progressed(run, description, plugins_used(*one.description, registry_));
      if (so_far == Progressed::ended) continue;
      refuse_foreign_run(run);
      if (so_far == Progressed::other) refuse_other_runs(place_.out, 1, run);
      jobs.push_back({run_words(program_, place_.calibration.base, run, sets(values, static_cast<double>(seed)),
                                so_far == Progressed::begun),
                      log_in(run)});
      names.push_back(fmt::format("trial {}, seed {}", number + 1, seed));
    }
  } catch (const DescriptionError& error) {
    return failed(error.what());  // the scenario refuses this combination of values
  }
  std::string trouble;
  std::size_t ended = static_cast<std::size_t>(place_.calibration.samples.count) - jobs.size();
  run_batch(jobs, at_once_, interrupted_,
            {.ended =
                 [&](std::size_t i, int status) {
                   ++ended;
                   if (status == static_cast<int>(ExitStatus::done) ||
                       status == static_cast<int>(ExitStatus::numerics) ||
                       status == static_cast<int>(ExitStatus::interrupted))
                     return true;
                   if (trouble.empty()) trouble = failed_run_text(names[i], status, jobs[i].log);
                   return false;
                 },
             .waiting = [&](std::size_t) { waiting_(ended); }});
  if (interrupted_.load()) throw Interrupted();
  if (!trouble.empty()) throw FileError(trouble);
  return results(folder);
}

std::vector<TrialSample> TrialRuns::results(const std::filesystem::path& folder) const {
  std::vector<TrialSample> all;
  for (std::int64_t count = 1; count <= place_.calibration.samples.count; ++count) {
    const auto seed = static_cast<double>(count);
    const Sample run = read_sample(place_.calibration.metrics(), seed, folder_of(folder, seed));
    // Another process may have stopped it.
    if (run.status == "under way" || run.status == "missing") throw Interrupted();
    TrialSample sample{.seed = seed, .found = {}, .failure = run.message, .core_seconds = run.core_seconds};
    if (!run.lacks.empty()) {
      sample.failure = run.lacks.begin()->second;
    } else if (run.status == "done") {
      try {
        sample.found = found_in(place_.calibration, place_.observations, run.metrics);
        sample.failure.clear();
      } catch (const NumericsError& error) {
        sample.failure = error.what();
      }
    }
    all.push_back(std::move(sample));
  }
  return all;
}

void refuse_foreign_trials(const std::filesystem::path& out) {
  for (const auto& run : runs_of_trials(out)) refuse_foreign_run(run);
}

void remove_trials(const std::filesystem::path& out) {
  for (const auto& run : runs_of_trials(out)) {
    if (!holds_a_run(run)) continue;
    refuse_foreign_files(run);
    std::error_code none;
    std::filesystem::remove(log_in(run), none);
    remove_run(run);
    std::filesystem::remove(run.parent_path(), none);  // if it is empty
  }
}

}  // namespace grit
