#include <charconv>
#include <cmath>
#include <iostream>
#include <memory>

#include "app/curve_summary.hpp"
#include "app/interrupt.hpp"
#include "app/progress_bar.hpp"
#include "app/run_jobs.hpp"
#include "app/run_setup.hpp"
#include "app/wall_shapes.hpp"
#include "app/watch.hpp"
#include "format/duration.hpp"
#include "grit/error.hpp"
#include "input/places.hpp"
#include "output/atomic_file.hpp"
#include "output/checkpoint.hpp"
#include "output/read_results.hpp"
#include "output/reference_curve.hpp"
#include "output/shell_word.hpp"
#include "report/report_page.hpp"
#include "simulation/parts.hpp"
#include "simulation/recorded_run.hpp"

namespace grit {
namespace {

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

RunFacts facts_of(const OpenedScene& opened, unsigned threads) {
  const SceneDescription& description = *opened.scene.description;
  return {.description = resolved(description),
          .plugins = plugins_used(description, *opened.registry),
          .seed = description.seed,
          .threads = threads,
          .clumps = clumps_of(opened.live.components())};
}

ResultsOptions results_of(const RunJob& job, RunFacts facts, const Bodies& bodies) {
  const OpenedScene& opened = *job.opened;
  const SceneDescription& description = *opened.scene.description;
  ResultsOptions results{.folder = job.folder,
                         .existing = job.existing,
                         .title = description.title,
                         .facts = std::move(facts),
                         .walls = wall_shapes(opened.scene, opened.live.geometries(), bodies),
                         .picture = {}};
  if (const auto& picture = description.output.picture)
    results.picture = PictureRequest{picture->x, picture->y, picture->view, picture->color};
  return results;
}

void print_speed(const RunSummary& summary) {
  double all = 1e-9;
  for (const PhaseTime& phase : summary.phases) all += phase.seconds;
  std::cout << summary.steps << " steps of " << summary.bodies << " bodies in " << duration_text(summary.wall_seconds)
            << ", " << std::round(1e-4 * summary.particle_steps_per_second) / 100 << " M particle-steps/s (";
  for (std::size_t i = 0; i < summary.phases.size(); ++i)
    std::cout << (i > 0 ? ", " : "") << summary.phases[i].name << ' '
              << std::lround(100 * summary.phases[i].seconds / all) << " %";
  std::cout << ")\n";
}

ExitStatus run_one(RunJob job, const Options& options, const std::optional<Listener>& listener,
                   const std::atomic<bool>& interrupted) {
  const std::filesystem::path& folder = job.folder;
  const Scene& scene = job.opened->scene;
  const SceneDescription& description = *scene.description;
  const unsigned threads = options.threads();
  const bool quiet = options.has("quiet");
  const auto say = [&](const std::string& line) {
    if (!quiet) std::cerr << line << std::endl;
  };

  for (const auto& [name, reference] : description.output.references)
    if (reference.curve) read_reference(*reference.curve);  // a slip in it shows now
  say(description.title.empty() ? job.file : job.file + ": " + description.title);
  RunFacts facts = facts_of(*job.opened, threads);
  std::optional<Checkpoint> checkpoint;
  if (job.existing == Existing::resume) {
    if (is_done(folder, facts)) {
      std::cout << folder.string() << ": done already\n";
      return ExitStatus::done;
    }
    checkpoint = resumed(folder, facts);
    if (!checkpoint) job.existing = Existing::overwrite;
  }

  Bodies bodies = job.opened->make_bodies(picture_state(description));
  ResultsFolder results(results_of(job, std::move(facts), bodies));
  std::optional<Watch> watch;  // before the simulation, which makes threads
  if (listener) watch.emplace(*listener, folder);
  ProgressBar bar;
  CurveSummary curves(results, scene.document, description.output, [&](const std::string& line) {
    bar.end();
    say(line);
  });

  Simulation simulation(std::make_unique<Simulation::Parts>(job.opened, std::move(bodies), threads, &curves));
  say(std::to_string(simulation.world().positions().size()) + " bodies, " + std::to_string(threads) +
      (threads == 1 ? " thread" : " threads") + ", results in " + folder.string());
  simulation.interrupt_when([&] { return interrupted.load(); });
  simulation.on_checkpoint([&](const Checkpoint& now) { results.checkpoint(now); },
                           description.output.checkpoint_every);
  if (!quiet || watch)
    simulation.on_progress([&](const Progress& now) {
      if (!quiet) bar.show(now);
      if (watch) watch->say(progress_text(now));
    });
  if (checkpoint) {
    say("goes on from step " + std::to_string(checkpoint->step) + ", stage \"" + checkpoint->stage + "\"");
    simulation.resume(*checkpoint);
  }
  const RunSummary summary = run_recorded(simulation);
  bar.end();

  std::cout << curves.text();
  print_speed(summary);
  std::cout << "results: " << folder.string() << '\n';
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
  open_all(jobs, options);
  const auto listener = listener_of(options);
  if (listener) std::cerr << "watch: http://127.0.0.1:" << listener->port() << "/ while the run goes" << std::endl;
  const auto& interrupted = catch_interrupts();
  ExitStatus status = ExitStatus::done;
  for (const RunJob& job : jobs) {
    const ExitStatus one = report([&] {
      try {
        return at_its_place(job.opened->scene.document, [&] { return run_one(job, options, listener, interrupted); });
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
