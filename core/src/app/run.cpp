#include <charconv>
#include <iostream>
#include <memory>

#include "app/curve_summary.hpp"
#include "app/interrupt.hpp"
#include "app/options.hpp"
#include "app/progress_bar.hpp"
#include "app/run_setup.hpp"
#include "app/wall_shapes.hpp"
#include "app/watch.hpp"
#include "bodies/make_bodies.hpp"
#include "format/duration.hpp"
#include "grit/error.hpp"
#include "input/places.hpp"
#include "input/scene.hpp"
#include "output/atomic_file.hpp"
#include "output/checkpoint.hpp"
#include "output/folder_lock.hpp"
#include "output/read_results.hpp"
#include "output/reference_curve.hpp"
#include "output/results_folder.hpp"
#include "output/shell_word.hpp"
#include "report/report_page.hpp"
#include "simulation/driver.hpp"
#include "simulation/first_instant.hpp"
#include "study/figures.hpp"

namespace grit {
namespace {

/// A description that was read, and where its results go.
struct Job {
  std::string file;
  std::filesystem::path folder;
  Scene scene;
  std::unique_ptr<LiveScene> live;
  Existing existing = Existing::refuse;
};

/// A description's file, or with --resume the folder of a run, which has its description.
Job job_of(const std::string& word, const Options& options) {
  Job job;
  if (options.has("resume") ? std::filesystem::is_directory(word)
                            : std::filesystem::exists(std::filesystem::path(word) / "run.json")) {
    if (!options.has("resume"))
      throw UsageError(word + " is a folder; give a description, or go on with its run: --resume");
    if (options.has("out")) throw UsageError(word + " is a folder, where its run goes on; leave out --out");
    job.folder = std::filesystem::path(word).lexically_normal();
    if (job.folder.filename().empty()) job.folder = job.folder.parent_path();
    job.file = (job.folder / "description.json").string();
    return job;
  }
  job.file = word;
  job.folder = options.has("out") ? options.get<std::string>("out") : std::string("results");
  if (!options.has("out") || options.words().size() > 1) job.folder /= std::filesystem::path(word).stem();
  return job;
}

std::vector<Job> jobs_of(const Options& options) {
  const auto& files = options.words();
  std::vector<Job> jobs;
  for (const std::string& file : files) {
    Job job = job_of(file, options);
    for (const Job& other : jobs)
      if (job.folder == other.folder)
        throw UsageError(other.file + " and " + file + " would both write to " + job.folder.string() +
                         "; run them one by one, each with its own --out");
    if (!FolderLock(job.folder).held()) refuse_busy(job.folder);  // now, not once grains are made
    if (options.has("overwrite")) job.existing = Existing::overwrite;
    else if (options.has("resume")) job.existing = Existing::resume;
    else if (std::filesystem::exists(job.folder / "run.json"))
      throw FileError(job.folder.string() +
                      " holds the results of a run; choose another folder (--out DIR), go on with it (--resume) or "
                      "replace them (--overwrite)");
    jobs.push_back(std::move(job));
  }
  return jobs;
}

/// All of them before the first is run, so that a slip in the last shows at once.
void read_all(std::vector<Job>& jobs, const Options& options, const Registry& registry) {
  std::vector<Problem> problems;
  for (Job& job : jobs) try {
      job.scene = load_scene(job.file, options.list("set"), registry);
      job.live = std::make_unique<LiveScene>(job.scene);
    } catch (const DescriptionError& error) {
      for (const Problem& problem : error.problems()) problems.push_back(problem);
    }
  if (!problems.empty()) throw DescriptionError(std::move(problems));
}

/// The page beside the results. The run is whole without it: what keeps it from being made is only said.
void make_report(const std::filesystem::path& folder) {
  const auto out = folder / "report.html";
  try {
    const ReportPage page = report_page(std::span(&folder, 1));
    write_atomically(out, page.html);
    for (const std::string& problem : page.problems) std::cerr << "grit: report: " << problem << '\n';
    std::cout << "report: " << out.string() << '\n';
  } catch (const std::exception& error) {
    std::cerr << "grit: no report: " << error.what() << std::endl;
  }
}

/// Where the page is served while runs go on; nothing where it is not asked for.
std::optional<Listener> listener_of(const Options& options) {
  if (!options.has("watch")) {
    if (options.has("port")) throw UsageError("--port is where the page of --watch is served: give both");
    return std::nullopt;
  }
  std::uint16_t port = 0;
  if (options.has("port")) {
    const auto text = options.get<std::string>("port");
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
    if (error != std::errc() || end != text.data() + text.size() || port == 0)
      throw UsageError("--port takes a number from 1 to 65535, not \"" + text + '"');
  }
  return std::optional<Listener>(std::in_place, port);
}

/// What a run goes on from; nothing where it begins at the beginning, which is said.
std::optional<Checkpoint> resumed(const std::filesystem::path& folder, const RunFacts& facts) {
  const auto path = folder / "checkpoint.h5";
  if (std::filesystem::exists(path)) return read_checkpoint(path, facts);
  std::cerr << "no checkpoint in " << folder.string() << ": the run begins at the beginning" << std::endl;
  return std::nullopt;
}

/// Whether the folder has all of this run already. Throws Error where it has another one.
bool is_done(const std::filesystem::path& folder, const RunFacts& facts) {
  const auto run = read_run_json(folder);
  if (!run) return false;
  const bool done = run->value("status", "") == "done";
  const Description then = run->value("description", Description::object());
  const auto other = done ? differences(facts.description, then) : differences_on_the_way(facts.description, then);
  if (!other.empty())
    throw Error(folder.string() + ": holds a run of another description:" + other +
                "\n  go on with the description that it began with ('grit run --resume " + shell_word(folder.string()) +
                "'), choose another folder (--out DIR) or replace it (--overwrite)");
  return done;
}

/// What may be done where a guard has stopped a run that changes nothing but where a run ends.
std::string way_on(Guard guard, const std::filesystem::path& folder) {
  if (guard != Guard::travel && guard != Guard::energy) return "";
  if (!std::filesystem::exists(folder / "checkpoint.h5")) return "";
  return std::string("\n  its last checkpoint is kept: with another /guards/") +
         (guard == Guard::travel ? "travel" : "energy") + " --resume goes on from there";
}

ExitStatus run_one(const Job& job, const Options& options, const Registry& registry,
                   const std::optional<Listener>& listener, const std::atomic<bool>& interrupted) {
  const auto& [file, folder, scene, live_scene, existing] = job;
  const unsigned threads = options.threads();
  const bool quiet = options.has("quiet");
  const SceneDescription& description = *scene.description;
  LiveScene& live = *live_scene;

  ResultsOptions results{.folder = folder,
                         .existing = existing,
                         .title = description.title,
                         .facts = {.description = resolved(description),
                                   .plugins = plugins_used(description, registry),
                                   .seed = description.seed,
                                   .threads = threads,
                                   .clumps = clumps_of(live.components())},
                         .walls = {},
                         .picture = {}};
  if (const auto& picture = description.output.picture)
    results.picture = PictureRequest{picture->x, picture->y, picture->view, picture->color};
  for (const auto& [name, reference] : description.output.references)
    if (reference.curve) read_reference(*reference.curve);  // a slip in it shows now
  const auto say = [&](const std::string& line) {
    if (!quiet) std::cerr << line << std::endl;
  };
  say(description.title.empty() ? file : file + ": " + description.title);
  std::optional<Checkpoint> checkpoint;
  if (existing == Existing::resume) {
    if (is_done(folder, results.facts)) {
      std::cout << folder.string() << ": done already\n";
      return ExitStatus::done;
    }
    checkpoint = resumed(folder, results.facts);
    if (!checkpoint) results.existing = Existing::overwrite;
  }
  Bodies bodies = make_bodies(description, live.components(), run_state(description, live.components()));
  results.walls = wall_shapes(scene, live.geometries(), bodies);
  ResultsFolder recorder(std::move(results));
  std::optional<Watch> watch;
  if (listener) watch.emplace(*listener, folder);

  Kernel kernel(at_first_instant(scene.document,
                                 [&] { return Kernel(live.now(), live.components(), std::move(bodies), threads); }));
  say(std::to_string(kernel.world().positions().size()) + " bodies, " + std::to_string(threads) +
      (threads == 1 ? " thread" : " threads") + ", results in " + folder.string());
  if (checkpoint)
    say("goes on from step " + std::to_string(checkpoint->step) + ", stage \"" + checkpoint->stage + "\"");

  ProgressBar bar;
  CurveSummary summary_curves(recorder, scene.document, description.output, [&](const std::string& line) {
    bar.end();
    say(line);
  });
  RunControl control;
  control.interrupted = &interrupted;
  control.checkpoint_every = description.output.checkpoint_every;
  control.resume = checkpoint ? &*checkpoint : nullptr;
  if (!quiet || watch)
    control.progress = [&](const Progress& now) {
      if (!quiet) bar.show(now);
      if (watch) watch->say(progress_text(now));
    };
  const RunSummary summary = run(scene, live, kernel, summary_curves, control);
  bar.end();

  std::cout << summary_curves.text();
  double all = 1e-9;
  for (const PhaseTime& phase : summary.phases) all += phase.seconds;
  const auto share = [&](double seconds) {
    return std::to_string(static_cast<int>(std::lround(100 * seconds / all))) + " %";
  };
  std::cout << summary.steps << " steps of " << summary.bodies << " bodies in " << duration_text(summary.wall_seconds)
            << ", " << std::round(1e-4 * summary.particle_steps_per_second) / 100 << " M particle-steps/s (";
  for (std::size_t i = 0; i < summary.phases.size(); ++i)
    std::cout << (i > 0 ? ", " : "") << summary.phases[i].name << ' ' << share(summary.phases[i].seconds);
  std::cout << ")\nresults: " << folder.string() << '\n';
  if (description.output.picture) std::cout << "picture: " << (folder / "picture.svg").string() << '\n';
  // Said before the page is made, which takes time with many grains: who cannot wait presses Ctrl-C again.
  if (summary.status == "interrupted")
    std::cerr << "interrupted; what was reached is saved in " << folder.string() << "; 'grit run --resume "
              << shell_word(folder.string()) << "' goes on" << std::endl;
  if (!options.has("no-report")) make_report(folder);
  if (summary.status == "interrupted") return ExitStatus::interrupted;
  if (summary.status == "failed") throw NumericsError(summary.message + way_on(summary.guard, folder));
  return ExitStatus::done;
}

}  // namespace

ExitStatus run_command(const std::vector<std::string>& words) {
  namespace po = boost::program_options;
  Options options(command("run"));
  options.add()("out", po::value<std::string>()->value_name("DIR"),
                "folder of the results; for several descriptions, a folder in it for each; default: results/NAME")(
      "overwrite", "replace results that are there")(
      "resume",
      "go on from the last checkpoint to the same bits as if never stopped; also with a folder of results for FILE")(
      "no-report", "do not make the page report.html")("quiet,q", "no progress, only what came of it")(
      "watch", "serve the page of the run while it goes, for browsers on this machine")(
      "port", po::value<std::string>()->value_name("N"), "where --watch serves it; default: one that is free");
  options.add_threads("threads; results are the same bits for any number");
  options.add_set();
  if (!options.read(words)) return ExitStatus::done;
  if (options.words().empty()) throw UsageError("no description was given; see 'grit run --help'");
  options.threads();
  if (options.has("resume") && options.has("overwrite"))
    throw UsageError("--resume goes on with results, --overwrite replaces them: give one of them");
  auto jobs = jobs_of(options);
  const auto registry = options.registry();
  read_all(jobs, options, *registry);
  const auto listener = listener_of(options);
  if (listener) std::cerr << "watch: http://127.0.0.1:" << listener->port() << "/ while the run goes" << std::endl;
  const auto& interrupted = catch_interrupts();
  ExitStatus status = ExitStatus::done;
  for (const Job& job : jobs) {
    const ExitStatus one = report([&] {
      try {
        return at_its_place(job.scene.document,
                            [&] { return run_one(job, options, *registry, listener, interrupted); });
      } catch (const NumericsError& error) {
        throw NumericsError(job.file + ": " + error.what());
      }
    });
    if (status == ExitStatus::done) status = one;
    // What went wrong with the numerics of one scene says nothing of the next.
    if (one != ExitStatus::done && one != ExitStatus::numerics) break;
  }
  return status;
}

}  // namespace grit
