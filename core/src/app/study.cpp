#include <spdlog/fmt/fmt.h>

#include <boost/dll/runtime_symbol_info.hpp>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <ranges>
#include <set>
#include <utility>

#include "app/interrupt.hpp"
#include "app/options.hpp"
#include "app/progress_bar.hpp"
#include "app/run_setup.hpp"
#include "bodies/make_bodies.hpp"
#include "description/placed_error.hpp"
#include "format/duration.hpp"
#include "format/number.hpp"
#include "format/symbols.hpp"
#include "grit/error.hpp"
#include "grit/toolkit/did_you_mean.hpp"
#include "grit/toolkit/text_file.hpp"
#include "input/places.hpp"
#include "input/scene.hpp"
#include "kernel/kernel.hpp"
#include "output/checkpoint.hpp"
#include "output/folder_lock.hpp"
#include "output/own_files.hpp"
#include "output/read_results.hpp"
#include "output/reference_curve.hpp"
#include "output/run_facts.hpp"
#include "plugins/build_facts.hpp"
#include "run/observer.hpp"
#include "simulation/live_scene.hpp"
#include "simulation/prepared_sample.hpp"
#include "storage/atomic_file.hpp"
#include "storage/parsed_json.hpp"
#include "study/batch.hpp"
#include "study/study_page.hpp"
#include "study/study_result.hpp"
#include "study/study_sentences.hpp"

namespace grit {
namespace {

/// One run of the study.
struct Run {
  std::string name;
  std::filesystem::path folder;
  BatchJob job;
};

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The state of a run on disk.
enum class Progressed {
  nothing,  ///< no run, or one of another description, another grit or another build of a plugin
  begun,    ///< interrupted or killed; can be resumed
  lost,     ///< done, but its series is missing or unreadable
  ended,    ///< done or failed numerically
};

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

bool has_series(const std::filesystem::path& folder) {
  try {
    const SeriesFile series(folder);
    return true;
  } catch (const FileError&) {
    return false;
  }
}

/// The state of the run of this description with these plugins in a folder.
Progressed progressed(const std::filesystem::path& folder, const Description& description,
                      const std::vector<PluginUsed>& plugins) {
  const auto run = read_run_json(folder);
  if (!run) return Progressed::nothing;
  const auto says = [&](const char* pointer) { return run->value(Description::json_pointer(pointer), Description()); };
  Description used = Description::array();
  for (const PluginUsed& one : plugins) used.push_back(plugin_facts(one));
  if (says("/description") != description || says("/grit/revision") != build_facts().revision ||
      !says("/plugins").is_array() || builds(says("/plugins")) != builds(used))
    return Progressed::nothing;
  if (says("/status") == "failed") return Progressed::ended;
  if (says("/status") == "done") return has_series(folder) ? Progressed::ended : Progressed::lost;
  // The run.json of a killed run still has the status "running".
  const bool stopped = says("/status") == "interrupted" || says("/status") == "running";
  return stopped && can_resume(folder, {.description = description, .plugins = plugins}) ? Progressed::begun
                                                                                         : Progressed::nothing;
}

/// Whether a description has all values of an older one; keys that the older one lacks are newer than it.
bool has_all_of(const Description& now, const Description& then) {
  if (now.is_object() && then.is_object()) {
    for (const auto& [key, value] : then.items())
      if (!now.contains(key) || !has_all_of(now.at(key), value)) return false;
    return true;
  }
  if (now.is_array() && then.is_array()) return std::ranges::equal(now, then, has_all_of);
  return now == then;
}

std::string lost_series(const std::filesystem::path& folder) {
  return folder.string() + ": the run is done, but its series.h5 is missing or unreadable";
}

/// Checks an existing run of any revision. Throws Error if it is of another description, FileError if its series is
/// missing.
void expect_same(const std::filesystem::path& folder, const Description& description) {
  const auto run = read_run_json(folder);
  if (!run || !run->contains("description")) return;
  if (run->value("status", "") == "done" && !has_series(folder))
    throw FileError(lost_series(folder) + "; run it again: the same command without --collect");
  if (has_all_of(description, run->at("description"))) return;
  throw Error(folder.string() +
              ": holds a run of another description:" + differences(description, run->at("description")) +
              "\n  remove it, or run it again: the same command without --collect");
}

/// Does the work for a variant. A DescriptionError of a value that the study sets names the study and the variant.
template <class Work>
auto of_variant(const std::filesystem::path& file, const Variant& variant, const Work& work) {
  try {
    return work();
  } catch (const DescriptionError& error) {
    auto problems = error.problems();
    for (Problem& problem : problems)
      if (problem.file == "--set") problem.file = file.string() + ", " + variant.name;
    throw DescriptionError(std::move(problems));
  }
}

std::string pointer_of(const std::string& metric, const std::string& key) {
  return "/metrics/" + pointer_token(metric) + '/' + key;
}

/// `; did you mean "color"? Allowed is one of color, view`
std::string one_of(const std::string& found, const std::vector<std::string>& names) {
  return did_you_mean(found, names, fmt::format("allowed is one of {}", fmt::join(names, ", ")));
}

/// Checks probes and reference files of the metrics before any run. Throws DescriptionError.
void check_metrics(const StudyDescription& study, const Document& written, const SceneDescription& scene) {
  std::vector<Problem> problems;
  const auto probes = std::views::keys(scene.probes);
  for (const auto& [name, metric] : study.metrics) {
    if (metric.curve) try {
        read_reference(*metric.curve);
      } catch (const FileError& error) {
        problems.push_back(
            written.problem(pointer_of(name, "curve/file"), missing_file_text(error, metric.curve->file)));
      }
    for (const auto& [key, channel] : {std::pair("of", &metric.of), std::pair("against", &metric.against)}) {
      const std::string probe = channel->substr(0, channel->find('/'));
      if (probe.empty() || scene.probes.contains(probe)) continue;
      problems.push_back(written.problem(pointer_of(name, key),
                                         fmt::format("found the probe \"{}\", which is not in the scene", probe) +
                                             one_of(probe, {probes.begin(), probes.end()})));
    }
  }
  if (!problems.empty()) throw DescriptionError(std::move(problems));
}

/// Checks channels, which probes know only once they are bound to a world.
void check_channels(const StudyDescription& study, const Document& written, const LiveScene& live,
                    const Registry& registry) try {
  const SceneDescription& scene = live.now();
  const Components& components = live.components();
  const Kernel kernel(scene, components, prepare(live, registry, run_state(scene, components)), 1);
  std::vector<std::string> all;
  std::set<std::string> wide;  // several values per sample
  for (const auto& [name, probe] : scene.probes) {
    for (const char* channel : {"time", "step"}) all.push_back(name + '/' + channel);
    for (const Channel& channel : Observer(name, probe, components.probes.at(name), kernel.world()).group().channels) {
      all.push_back(name + '/' + channel.name);
      if (std::ranges::any_of(channel.shape, [](std::size_t n) { return n != 1; })) wide.insert(all.back());
    }
  }
  std::vector<Problem> problems;
  for (const auto& [name, metric] : study.metrics) {
    const bool profile = std::holds_alternative<ProfileMetric>(metric.what.value());
    for (const auto& [key, channel] : {std::pair("of", metric.of), std::pair("against", metric.against)}) {
      if (channel.empty()) continue;
      const std::string probe = channel.substr(0, channel.find('/') + 1);
      std::vector<std::string> own;
      std::ranges::copy_if(all, std::back_inserter(own), [&](const auto& one) { return one.starts_with(probe); });
      if (std::ranges::find(own, channel) == own.end())
        problems.push_back(written.problem(
            pointer_of(name, key),
            fmt::format("found \"{}\", which is not a channel of the probe", channel) + one_of(channel, own)));
      else if (!profile && wide.contains(channel))
        problems.push_back(
            written.problem(pointer_of(name, key),
                            fmt::format("found \"{}\", which has several values per sample; allowed is a channel with "
                                        "one value, or the type profile",
                                        channel)));
    }
  }
  if (!problems.empty()) throw DescriptionError(std::move(problems));
} catch (const NumericsError&) {
  // If the usual settings fail at once, other variants may not.
}

/// The missing runs; `all` counts all runs. With --collect none, but existing runs must be of this study. Throws
/// DescriptionError if a run or a metric is invalid.
std::vector<Run> missing_runs(const StudyDescription& study, const std::filesystem::path& file,
                              const std::filesystem::path& out, const Options& options, const Registry& registry,
                              std::size_t& all) {
  std::vector<Run> runs;
  std::set<std::filesystem::path> folders;
  std::map<std::string, std::string> described;  // variants by the description of their first sample
  const unsigned threads = options.threads();
  const Document written = Document::load(file);
  const auto asked = variants(study);
  ProgressLine line;
  for (const Variant& variant : asked)
    for (const double seed : study.seeds.values) {
      if (!options.has("quiet") && all > 0 && line.is_due())
        line.show(fmt::format("{} of {} runs checked", all, asked.size() * study.seeds.values.size()));
      const auto sets = sets_of(study, variant, seed);
      const auto folder = out / folder_of(variant, seed);
      ++all;
      if (!folders.insert(folder).second)
        throw UsageError("two variants would both write to " + folder.string() +
                         "; give their levels labels that differ in more than punctuation");
      const Scene scene = of_variant(file, variant, [&] { return load_scene(study.scene, sets, registry); });
      const auto live = of_variant(file, variant, [&] { return std::make_unique<LiveScene>(scene); });
      check_metrics(study, written, *scene.description);
      // As in run.json, whose numbers were converted to text.
      const std::string text = resolved(*scene.description).dump();
      const auto description = Description::parse(text);
      if (seed == study.seeds.values.front())
        if (const auto [other, is_new] = described.emplace(text, variant.name); !is_new)
          throw DescriptionError({written.problem(
              "/settings", fmt::format("found {} and {}, which are the same run; allowed are levels with different "
                                       "values",
                                       other->second, variant.name))});
      if (all == 1 && !options.has("collect"))
        of_variant(file, variant,
                   [&] { at_its_place(scene.document, [&] { check_channels(study, written, *live, registry); }); });
      if (options.has("collect")) {
        expect_same(folder, description);
        continue;
      }
      const Progressed so_far = progressed(folder, description, plugins_used(*scene.description, registry));
      if (so_far == Progressed::ended) continue;
      if (so_far == Progressed::lost) std::cerr << "grit: " << lost_series(folder) << "; it is run again" << std::endl;
      Run run{variant.name + ", seed " + std::to_string(static_cast<long long>(seed)), folder, {}};
      run.job.log = folder / "log.txt";
      run.job.words = {boost::dll::program_location().string(),
                       "run",
                       study.scene,
                       "--out",
                       folder.string(),
                       so_far == Progressed::begun ? "--resume" : "--overwrite",
                       "--quiet",
                       "--no-report",
                       "--threads",
                       std::to_string(threads)};
      for (const auto& set : sets) run.job.words.insert(run.job.words.end(), {"--set", set});
      for (const auto& path : options.list("plugin-path"))
        run.job.words.insert(run.job.words.end(), {"--plugin-path", path});
      runs.push_back(std::move(run));
    }
  line.end();
  return runs;
}

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
  void end() { line_.end(); }

 private:
  std::size_t all_, missing_, ended_ = 0;
  bool quiet_;
  ProgressLine line_;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

/// Throws FileError if another process holds the lock.
void lock_folder(const std::filesystem::path& out, std::optional<FolderLock>& lock) {
  if (!lock.emplace(out).held())
    throw FileError(out.string() +
                    ": another 'grit study', or one of its runs, is writing there; wait for it, or choose another "
                    "folder with --out");
}

bool is_own_json(const std::filesystem::path& path) {
  std::string fault;
  const Description json = parsed_json(read_bytes(path, fault));
  return json.is_object() && json.contains("variants") && json.contains("cheapest");
}

bool is_own_table(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string head;
  std::getline(file, head);
  return head.starts_with("variant,") && head.find(",metric,") != std::string::npos;
}

/// Of a run that did not begin there is only the log.
bool is_own_log(const std::filesystem::path& log) {
  const std::filesystem::directory_iterator entries(log.parent_path());
  return holds_a_run(log.parent_path()) || std::distance(begin(entries), end(entries)) == 1;
}

/// Throws FileError if the study would replace a file that no study wrote.
void refuse_foreign_files_of_study(const std::filesystem::path& out, const std::vector<Run>& runs) {
  const auto check = [](const std::filesystem::path& path, const auto& is_own) {
    if (std::filesystem::exists(path) && !(std::filesystem::is_regular_file(path) && is_own(path)))
      throw FileError(path.string() +
                      ": no study wrote this file: it would be lost; move it away, or choose another folder with "
                      "--out");
  };
  check(out / "study.json", is_own_json);
  check(out / "study.csv", is_own_table);
  if (!std::filesystem::exists(out / "study.json")) refuse_foreign_page(out / "study.html");
  for (const Run& run : runs) check(run.job.log, is_own_log);
}

/// Throws FileError, also if the first finished run lacks a channel of a metric.
void run_missing(const StudyDescription& study, const std::vector<Run>& runs, std::size_t all, const Options& options,
                 const std::atomic<bool>& interrupted) {
  std::vector<BatchJob> jobs;
  for (const Run& run : runs) jobs.push_back(run.job);
  StudyProgress progress(all, runs.size(), options.has("quiet"));
  std::string trouble;
  bool seen = false;
  const auto inspect = [&](const Run& run) {
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
    if (trouble.empty() && !interrupted.load())
      trouble = runs[i].name +
                (status < 0 ? fmt::format(" was killed by signal {}", -status)
                            : fmt::format(" ended with status {}", status)) +
                ":\n" + text_of(runs[i].job.log) + "\nfrom " + runs[i].job.log.string();
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

}  // namespace

ExitStatus study_command(const std::vector<std::string>& words) {
  namespace po = boost::program_options;
  Options options(command("study"));
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  options.add()("out", po::value<std::string>()->value_name("DIR"),
                "folder of runs and results; default: results/NAME")(
      "jobs", po::value<std::string>()->default_value(std::to_string(cores))->value_name("N"), "concurrent runs")(
      "threads", po::value<std::string>()->default_value("1")->value_name("N"), "threads per run")(
      "dry-run", "list the missing runs and exit")(
      "collect", "evaluate existing runs of any revision of grit; start no runs")("quiet,q",
                                                                                  "print results only, no progress");
  if (!options.read(words)) return ExitStatus::done;
  const std::filesystem::path file = options.only_word("study");
  if (options.has("dry-run") && options.has("collect"))
    throw UsageError("--dry-run lists the missing runs, --collect starts none; give one of them");
  options.number("jobs"), options.warn_of_threads();
  const auto registry = options.registry();
  const StudyDescription study = load_study(file);
  const std::filesystem::path out =
      options.has("out") ? std::filesystem::path(options.get<std::string>("out")) : "results" / file.stem();
  std::optional<FolderLock> lock;  // taken before missing runs are listed; but an invalid study creates no folder
  if (!options.has("dry-run") && std::filesystem::is_directory(out)) lock_folder(out, lock);
  std::size_t all = 0;
  const auto runs = missing_runs(study, file, out, options, *registry, all);
  if (options.has("dry-run")) {
    for (const Run& run : runs) std::cout << run.name << '\n';
    std::cout << runs.size() << " of " << all << " runs are missing in " << out.string() << '\n';
    return ExitStatus::done;
  }
  if (options.has("collect") && !std::filesystem::is_directory(out / "runs"))
    throw FileError(out.string() +
                    ": has no runs of the study; omit --collect to run them, or give the folder that has them with "
                    "--out");
  if (!lock) {
    std::filesystem::create_directories(out);
    lock_folder(out, lock);
  }
  refuse_foreign_files_of_study(out, runs);
  if (!options.has("quiet") && !options.has("collect"))
    std::cerr << (study.title.empty() ? file.string() : study.title) << ": " << runs.size() << " of " << all
              << " runs to do, results in " << out.string() << std::endl;
  const auto& interrupted = catch_interrupts();
  run_missing(study, runs, all, options, interrupted);
  if (interrupted.load()) {
    std::cerr << "interrupted; run the same command again to continue" << std::endl;
    return ExitStatus::interrupted;
  }
  const StudyResult result = evaluate_study(study, out);
  write_atomically(out / "study.json", to_json(result).dump(2) + "\n");
  write_atomically(out / "study.csv", to_csv(result));
  write_atomically(out / "study.html", study_page(result));
  print(result);
  for (const std::string& line : not_evaluated(result)) std::cerr << "grit: not evaluated: " << line << std::endl;
  std::cout << "page: " << (out / "study.html").string() << '\n';
  const bool any =
      result.study.is_sweep()
          ? std::ranges::any_of(result.variants,
                                [](const VariantResult& one) { return !one.values.empty() || !one.curves.empty(); })
          : !result.reference.empty();
  return any ? ExitStatus::done : ExitStatus::numerics;
}

}  // namespace grit
