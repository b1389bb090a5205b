#include "app/study_runs.hpp"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <algorithm>
#include <boost/dll/runtime_symbol_info.hpp>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <ranges>
#include <utility>

#include "app/idle_settings.hpp"
#include "app/metric_checks.hpp"
#include "app/progress_bar.hpp"
#include "app/run_setup.hpp"
#include "app/runs_folder.hpp"
#include "grit/error.hpp"
#include "grit/toolkit/did_you_mean.hpp"
#include "input/places.hpp"
#include "output/checkpoint.hpp"
#include "output/plugins_used.hpp"
#include "output/read_results.hpp"

namespace grit {
namespace {

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

/// Throws DescriptionError if the runs of two variants would have the same folder, or one that no disk can have.
void refuse_folders(const StudyPlace& place, const std::vector<Variant>& all) {
  constexpr std::size_t longest = 255;  // bytes of a name
  const auto refuse = [&](const std::string& found, const std::string& allowed) {
    throw DescriptionError({Document::load(place.file).problem("/settings", fault_text(found, allowed))});
  };
  std::map<std::filesystem::path, std::string> names;
  for (const Variant& variant : all) {
    const auto folder = folder_of(variant, place.study.seeds.values.front()).parent_path();
    if (const auto [other, is_new] = names.emplace(folder, variant.name); !is_new)
      refuse(fmt::format("the variants \"{}\" and \"{}\", whose runs would both be in {}", other->second, variant.name,
                         (place.out / folder).string()),
             "levels whose values or labels differ in more than punctuation");
    if (const std::size_t length = folder.filename().native().size(); length > longest)
      refuse(fmt::format("the variant \"{}\", whose folder would have a name of {} bytes", variant.name, length),
             fmt::format("up to {}; give the levels shorter labels", longest));
  }
}

/// Calls `work(variant, seed, folder within the study)` for every run. Throws as refuse_folders() does.
template <class Work>
void for_each_run(const StudyPlace& place, const Work& work) {
  const auto all = variants(place.study);
  refuse_folders(place, all);
  for (const Variant& variant : all)
    for (const double seed : place.study.seeds.values) work(variant, seed, folder_of(variant, seed));
}

/// A scene of the study, and its description as in run.json, whose numbers were converted to text.
struct VariantScene {
  Scene scene;
  std::string text;
  Description description;
};

VariantScene scene_of(const StudyPlace& place, const Variant& variant, double seed, const Registry& registry) {
  VariantScene one{
      of_variant(place.file, variant,
                 [&] { return load_scene(place.study.scene, sets_of(place.study, variant, seed), registry); }),
      {},
      {}};
  one.text = resolved(*one.scene.description).dump();
  one.description = Description::parse(one.text);
  return one;
}

/// Shows how many runs are checked.
class CheckedRuns {
 public:
  CheckedRuns(const StudyPlace& place, bool quiet)
      : all_(variants(place.study).size() * place.study.seeds.values.size()), quiet_(quiet) {}
  void next() {
    if (!quiet_ && checked_ > 0 && line_.is_due()) line_.show(fmt::format("{} of {} runs checked", checked_, all_));
    ++checked_;
  }
  std::size_t count() const { return checked_; }
  void end() { line_.end(); }

 private:
  std::size_t all_, checked_ = 0;
  bool quiet_;
  ProgressLine line_;
};

}  // namespace

RunProgram run_program(const Options& options) {
  RunProgram with{boost::dll::program_location().string(), options.threads()};
  // Another machine may have neither this variable nor this working directory.
  std::vector<std::string> folders = options.list("plugin-path");
  const char* const more = std::getenv("GRIT_PLUGIN_PATH");
  for (const auto part : std::views::split(std::string_view(more == nullptr ? "" : more), ':'))
    if (!part.empty()) folders.emplace_back(part.begin(), part.end());
  for (const std::string& folder : folders)
    with.plugin_paths.push_back(std::filesystem::absolute(folder).lexically_normal().string());
  return with;
}

std::vector<StudyRun> missing_runs(const StudyPlace& place, const Options& options, const Registry& registry,
                                   std::size_t& all,
                                   const std::function<void(const LiveScene&, const Scene&)>& each_variant) {
  const StudyDescription& study = place.study;
  std::vector<StudyRun> runs;
  std::map<std::string, std::string> described;  // variants by the description of their first sample
  std::string measured;                          // the variant that each_variant has seen last
  const RunProgram program = run_program(options);
  const Document written = Document::load(place.file);
  const MetricsToCheck metrics{&study.metrics, &written, "/metrics"};
  check_curves(metrics);
  CheckedRuns line(place, options.has("quiet"));
  for_each_run(place, [&](const Variant& variant, double seed, const std::filesystem::path& within) {
    line.next();
    const auto folder = place.out / within;
    const VariantScene one = scene_of(place, variant, seed, registry);
    const auto live = of_variant(place.file, variant, [&] { return std::make_unique<LiveScene>(one.scene); });
    check_probes(metrics, *one.scene.description);
    if (seed == study.seeds.values.front())
      if (const auto [other, is_new] = described.emplace(one.text, variant.name); !is_new)
        throw DescriptionError({written.problem(
            "/settings", fmt::format("found {} and {}, which are the same run; allowed are levels with different "
                                     "values",
                                     other->second, variant.name))});
    if (line.count() == 1)
      of_variant(place.file, variant,
                 [&] { at_its_place(one.scene.document, [&] { check_channels(metrics, *live, registry); }); });
    const Progressed so_far = progressed(folder, one.description, plugins_used(*one.scene.description, registry));
    if (so_far == Progressed::ended) return;
    if (so_far == Progressed::lost) std::cerr << "grit: " << lost_series(folder) << "; it is run again" << std::endl;
    if (each_variant && std::exchange(measured, variant.name) != variant.name)
      of_variant(place.file, variant,
                 [&] { at_its_place(one.scene.document, [&] { each_variant(*live, one.scene); }); });
    runs.push_back({fmt::format("{}, seed {:.0f}", variant.name, seed), within, folder,
                    run_words(program, study.scene, folder, sets_of(study, variant, seed), so_far == Progressed::begun),
                    so_far == Progressed::other});
  });
  line.end();
  all = line.count();
  return runs;
}

void warn_of_idle_settings(const StudyPlace& place, const Registry& registry) {
  const StudyDescription& study = place.study;
  std::map<std::string, std::string> pointers;  // by where the study names them
  for (const auto& [name, setting] : study.settings)
    for (std::size_t i = 0; i < setting.pointers.size(); ++i)
      pointers[fmt::format("/settings/{}/pointers/{}", pointer_token(name), i)] = setting.pointers[i];
  for (const auto& [pointer, value] : study.set.items()) pointers["/set/" + pointer_token(pointer)] = pointer;
  std::map<std::string, std::string> reasons;
  for (const Variant& variant : variants(study)) {
    const auto idle = idle_settings({study.scene, sets_of(study, variant, study.seeds.values.front()), registry});
    std::erase_if(pointers, [&](const auto& one) {
      const auto why = why_idle(idle, one.second);
      if (why) reasons[one.first] = *why;
      return !why;
    });
    if (pointers.empty()) return;
  }
  const Document written = Document::load(place.file);
  for (const auto& [where, pointer] : pointers) warn_of_idle(written, where, reasons.at(where));
}

std::map<std::filesystem::path, std::string> unusable_runs(const StudyPlace& place, const Options& options,
                                                           const Registry& registry) {
  std::map<std::filesystem::path, std::string> unusable;
  const Document written = Document::load(place.file);
  const MetricsToCheck metrics{&place.study.metrics, &written, "/metrics"};
  check_curves(metrics);
  CheckedRuns line(place, options.has("quiet"));
  for_each_run(place, [&](const Variant& variant, double seed, const std::filesystem::path& within) {
    line.next();
    const VariantScene one = scene_of(place, variant, seed, registry);
    check_probes(metrics, *one.scene.description);
    const auto folder = place.out / within;
    const auto run = read_run_json(folder);
    if (!run || !run->contains("description")) return;
    if (run->value("status", "") == "done" && !has_series(folder)) unusable[folder] = lost_series(folder);
    else if (!has_all_of(one.description, run->at("description")))
      unusable[folder] = folder.string() +
                         ": holds a run of another description:" + differences(one.description, run->at("description"));
  });
  line.end();
  return unusable;
}

ExitStatus do_only(const StudyPlace& place, const std::string& within, const Options& options,
                   const Registry& registry) {
  const auto wanted = (std::filesystem::path(within) / "").lexically_normal().parent_path();
  std::optional<std::pair<Variant, double>> found;
  std::vector<std::string> names;
  for_each_run(place, [&](const Variant& variant, double seed, const std::filesystem::path& own) {
    names.push_back(own.string());
    if (own == wanted) found = {variant, seed};
  });
  if (!found)
    throw UsageError("--only takes the folder of a run of the study, not \"" + within + '"' +
                     did_you_mean(within, names, "such as " + names.front()));
  const auto& [variant, seed] = *found;
  const auto folder = place.out / wanted;
  const VariantScene one = scene_of(place, variant, seed, registry);
  const Progressed so_far = progressed(folder, one.description, plugins_used(*one.scene.description, registry));
  if (so_far == Progressed::ended) {
    const auto run = read_run_json(folder);
    const bool done = run && run->value("status", "") == "done";
    std::cout << folder.string() << (done ? ": already complete\n" : ": has failed already; see run.json there\n");
    return done ? ExitStatus::done : ExitStatus::numerics;
  }
  refuse_foreign_run(folder);
  if (so_far == Progressed::other && !options.has("overwrite")) refuse_other_runs(place.out, 1, folder);
  const auto words = run_words(run_program(options), place.study.scene, folder, sets_of(place.study, variant, seed),
                               so_far == Progressed::begun);
  std::vector<char*> arguments;
  for (const auto& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  std::cout.flush();
  // In place of this process, so that signals of a scheduler reach the run.
  ::execv(arguments.front(), arguments.data());
  throw FileError(words.front() + " cannot be started: " + std::strerror(errno));
}

}  // namespace grit
