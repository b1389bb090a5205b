#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <iostream>
#include <memory>
#include <new>

#include "app/curve_summary.hpp"
#include "app/idle_settings.hpp"
#include "app/interrupt.hpp"
#include "app/progress_bar.hpp"
#include "app/rank_facts.hpp"
#include "app/run_jobs.hpp"
#include "app/run_ranks.hpp"
#include "app/run_setup.hpp"
#include "app/wall_shapes.hpp"
#include "app/watch.hpp"
#include "format/duration.hpp"
#include "format/message.hpp"
#include "format/number.hpp"
#include "format/resources.hpp"
#include "grit/error.hpp"
#include "input/places.hpp"
#include "lint/late_densities.hpp"
#include "output/checkpoint.hpp"
#include "output/frame_space.hpp"
#include "output/own_files.hpp"
#include "output/plugins_used.hpp"
#include "output/read_results.hpp"
#include "output/reference_curve.hpp"
#include "output/shell_word.hpp"
#include "plugins/build_facts.hpp"
#include "report/report_page.hpp"
#include "simulation/parts.hpp"
#include "simulation/recorded_run.hpp"
#include "storage/atomic_file.hpp"

namespace grit {
namespace {

/// Writes the page of the results. The run does not depend on it: an error is only reported.
void make_report(const std::filesystem::path& folder) {
  const auto out = folder / "report.html";
  try {
    const ReportPage page = report_page(std::span(&folder, 1));
    refuse_foreign_page(out);
    write_atomically(out, page.html);
    for (const std::string& problem : page.problems) std::cerr << "grit: report: " << problem << '\n';
    std::cout << "report: " << out.string() << '\n';
  } catch (const std::exception& error) {
    std::cerr << "grit: no report: " << message_of(error) << std::endl;
  }
}

/// Does what a run that was killed after its last result left undone.
void complete(const std::filesystem::path& folder, const Options& options) {
  const FolderLock lock(folder);
  if (!lock.held()) refuse_busy(folder);
  if (std::filesystem::exists(folder / "final.h5")) remove_checkpoints(folder);
  if (!options.has("no-report") && !std::filesystem::exists(folder / "report.html")) make_report(folder);
}

/// Where --watch serves the page; none without it.
std::optional<Listener> listener_of(const Options& options) {
  if (!options.has("watch")) {
    if (options.has("port")) throw UsageError("--port needs --watch; give both");
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

/// The checkpoint from which a run continues. Without one the run starts from the beginning, which is reported. Throws
/// Error if it was complete, although its run.json does not say so.
std::optional<LastCheckpoint> resumed(const std::filesystem::path& folder, const RunFacts& facts) {
  if (auto last = last_checkpoint(folder, facts)) {
    if (!last->note.empty()) std::cerr << "grit: warning: " << last->note << std::endl;
    return last;
  }
  if (std::filesystem::exists(folder / "final.h5"))
    throw Error(
        folder.string() +
        ": holds the final state of a run, but its run.json is missing or damaged, so that the run would start from "
        "the beginning; put run.json back, choose another folder (--out DIR) or replace the run (--overwrite)");
  std::cerr << "no checkpoint in " << folder.string() << ": the run starts from the beginning" << std::endl;
  return std::nullopt;
}

/// Whether the folder, of this run.json, holds this run complete. Throws Error if it holds another run.
bool is_done(const Description& run_json, const std::filesystem::path& folder, const RunFacts& facts) {
  const bool done = run_json.value("status", "") == "done";
  const Description then = run_json.value("description", Description::object());
  const auto other = done ? differences(facts.description, then) : differences_on_the_way(facts.description, then);
  if (!other.empty())
    throw Error(folder.string() + ": holds a run of another description:" + other +
                advice_on_stages(facts.description, then) +
                "\n  continue with its own description ('grit run --resume " + shell_word(folder.string()) +
                "'), choose another folder (--out DIR) or replace it (--overwrite)");
  return done;
}

/// Advice after a guard that may only decide where a run ends: then it can be changed before resuming.
std::string resume_advice(Guard guard, const Description& description, const std::filesystem::path& folder) {
  if (guard != Guard::overlap && guard != Guard::travel && guard != Guard::energy) return "";
  if (!has_checkpoint(folder)) return "";
  const std::string name = guard == Guard::overlap ? "overlap" : guard == Guard::travel ? "travel" : "energy";
  const double usual = GuardsDescription().travel, any = 1e300, now = description.at("guards").at(name);
  const bool freely = can_go_on_with(description, name, any);
  if (!freely && !(guard == Guard::travel && now < usual && can_go_on_with(description, name, usual)))
    return "\n  --resume cannot go on with another /guards/" + name +
           ", as it is set by a stage or sets the time step: run all stages from the start with it in another folder "
           "(--out DIR)";
  return "\n  the last checkpoint is kept: change /guards/" + name +
         (freely ? "" : ", to at most " + number(usual) + ',') + " and continue with --resume";
}

/// How a run goes on that has failed for want of space or memory.
std::string way_on(const RunJob& job) {
  return has_checkpoint(job.folder)
             ? "continue from the last checkpoint: 'grit run --resume " + shell_word(job.folder.string()) + '\''
             : "run it again, as there is no checkpoint yet: 'grit run --overwrite " + shell_word(job.file) + '\'';
}

/// Runs the simulation. A file that cannot be written ends it, on a full disk for one, and so does want of memory; the
/// message says how to go on.
RunSummary run_or_advise(Simulation& simulation, const RunJob& job) try {
  return run_recorded(simulation);
} catch (const RefusedRecord& error) {
  throw FileError(error.what() + std::string(", then ") + way_on(job));
} catch (const FileError& error) {
  throw FileError(error.what() + std::string("\n  free space on the disk, or remove the cause, then ") + way_on(job));
} catch (const std::bad_alloc&) {
  throw FileError(out_of_memory() + "\n  then " + way_on(job));
}

RunFacts facts_of(const RunJob& job, unsigned threads, unsigned ranks, DeviceKind device,
                  const std::vector<std::string>& command_line) {
  const OpenedScene& opened = *job.opened;
  const SceneDescription& description = *opened.scene.description;
  return {.description = resolved(description),
          .plugins = plugins_used(description, *opened.registry),
          .seed = description.seed,
          .threads = threads,
          .ranks = ranks,
          .engine = device == DeviceKind::gpu ? "gpu" : device == DeviceKind::emulated ? "emulated device" : "cpu",
          .clumps = clumps_of(opened.live.components()),
          .source = job.source,
          .commands = {command_line}};
}

/// The ends of a colour's scale; none if the description sets none.
ScaleEnds scale_of(const std::string& color, const std::deque<ColorScaleDescription>& scales) {
  const auto found = std::ranges::find(scales, color, &ColorScaleDescription::of);
  return found == scales.end() ? ScaleEnds{} : ScaleEnds{found->low, found->high};
}

ResultsOptions results_of(const RunJob& job, RunFacts facts, const Bodies& bodies) {
  const OpenedScene& opened = *job.opened;
  const SceneDescription& description = *opened.scene.description;
  ResultsOptions results{.folder = job.folder,
                         .existing = job.existing,
                         .title = description.title,
                         .facts = std::move(facts),
                         .walls = wall_shapes(opened.scene, opened.live.geometries(), bodies),
                         .formats = description.output.frames.formats,
                         .picture = {}};
  if (const auto& picture = description.output.picture)
    results.picture = PictureRequest{picture->x, picture->y, picture->view, picture->color,
                                     scale_of(picture->color, description.output.color_scales)};
  return results;
}

std::string elapsed(double seconds) { return seconds < 60 ? cost_text(seconds) : duration_text(seconds); }

/// The time of the whole run, also before a checkpoint, and its speed, which counts the time of the steps only.
void print_speed(const RunSummary& summary) {
  double all = 1e-9, besides = 0;  // s
  for (const PhaseTime& phase : summary.phases) {
    all += phase.seconds;
    if (phase.name == "probes" || phase.name == "output") besides += phase.seconds;
  }
  std::cout << summary.steps << " steps of " << counted(summary.bodies, "body", "bodies") << " in "
            << elapsed(summary.wall_seconds + besides) << ", " << elapsed(summary.wall_seconds)
            << " of it for steps: " << std::round(1e-4 * summary.particle_steps_per_second) / 100
            << " M particle-steps/s (";
  for (std::size_t i = 0; i < summary.phases.size(); ++i)
    std::cout << (i > 0 ? ", " : "") << summary.phases[i].name << ' '
              << std::lround(100 * summary.phases[i].seconds / all) << " %";
  std::cout << ")\n";
}

/// A checkpoint as bytes, or that there is none.
std::vector<std::byte> bytes_of(const std::optional<LastCheckpoint>& last) {
  Archive archive;
  bool there = last.has_value();
  Checkpoint checkpoint = there ? last->checkpoint : Checkpoint{};
  archive(there, checkpoint.stage, checkpoint.time, checkpoint.step, checkpoint.state);
  return archive.bytes();
}

/// The part of another rank than the first in saving the state: it keeps nothing.
void send(const StateToSave& state) {
  Archive nowhere([](std::span<const std::byte>) {});
  state.save(nowhere);
}

/// What other ranks than the first do: the whole run, but they write nothing.
ExitStatus follow(const Options& options, RunRanks& ranks) {
  RunJob job;
  std::string failure;
  const ExitStatus opened = report([&] {
    job = named_job(options);
    open(job, options);
    return ExitStatus::done;
  });
  if (opened != ExitStatus::done) failure = ranks.messages();
  const auto given = ranks.agree(failure.empty() ? facts_to_agree_on(job) : std::vector<RankFact>(), failure, {});
  if (!given || given->empty()) return ExitStatus::done;  // the first one reports why
  Archive archive(*given);
  bool resumes = false;
  Checkpoint checkpoint;
  archive(resumes, checkpoint.stage, checkpoint.time, checkpoint.step, checkpoint.state);
  const std::atomic<bool>& interrupted = catch_interrupts();
  const StateRequest state = picture_state(*job.opened->scene.description);
  Simulation simulation(std::make_unique<Simulation::Parts>(
      job.opened, resumes ? job.opened->prepare_to_resume(state) : job.opened->prepare(state), ranks.threads(options),
      nullptr, ranks.communicator()));
  simulation.interrupt_when([&] { return interrupted.load(); });
  simulation.parts().checkpoints.set(&send, 0);
  if (resumes) simulation.resume(checkpoint);
  const RunSummary summary = run_recorded(simulation);
  if (summary.status == "interrupted") return ExitStatus::interrupted;
  return summary.status == "failed" ? ExitStatus::numerics : ExitStatus::done;
}

/// Before the first rank begins: compares the ranks, and gives them the checkpoint.
void begin_together(RunRanks& ranks, const RunJob& job, const std::optional<LastCheckpoint>& last) {
  if (ranks.several() && !ranks.agree(facts_to_agree_on(job), "", bytes_of(last)))
    throw Error(std::to_string(ranks.count()) + " ranks cannot run this together, see above");
}

ExitStatus run_one(RunJob job, const Options& options, const std::vector<std::string>& command_line,
                   const std::optional<Listener>& listener, RunRanks& ranks) {
  const std::atomic<bool>& interrupted = end_on_interrupts();
  if (interrupted.load()) return ExitStatus::interrupted;  // between two runs
  const std::filesystem::path& folder = job.folder;
  const Scene& scene = job.opened->scene;
  const SceneDescription& description = *scene.description;
  const unsigned threads = ranks.threads(options);
  const DeviceKind device = options.device();
  const bool quiet = options.has("quiet");
  const auto say = [&](const std::string& line) {
    if (!quiet) std::cerr << line << std::endl;
  };

  for (const auto& [pointer, why] : late_densities(scene)) warn_of_idle(scene.document, pointer, why);
  Description references = check_references(description.output);
  say(description.title.empty() ? job.file : job.file + ": " + description.title);
  RunFacts facts = facts_of(job, threads, ranks.count(), device, command_line);
  facts.references = std::move(references);
  std::optional<LastCheckpoint> last;
  if (job.existing == Existing::resume) {
    const auto before = read_run_json(folder);
    if (before && is_done(*before, folder, facts)) {
      std::cout << folder.string() << ": already complete\n";
      if (ranks.several()) ranks.agree(facts_to_agree_on(job), "", {});
      complete(folder, options);
      return ExitStatus::done;
    }
    if (before) continue_from(*before, job.file == (folder / "description.json").string(), facts);
    last = resumed(folder, facts);
    if (!last) refuse_inputs(folder, inputs_of(job)), job.existing = Existing::overwrite;
  }

  const StateRequest state = picture_state(description);
  Prepared prepared = last ? job.opened->prepare_to_resume(state) : job.opened->prepare(state);
  if (!prepared.note.empty()) say(prepared.note);
  if (!last) check_disk(scene, job.opened->live, prepared.bodies, folder);
  ResultsOptions written = results_of(job, std::move(facts), prepared.bodies);
  written.from_previous = last && !last->note.empty();
  begin_together(ranks, job, last);
  catch_interrupts();  // placing bodies takes long, and leaves nothing that would have to be saved
  ResultsFolder results(std::move(written));
  std::optional<Watch> watch;  // before the simulation, which makes threads
  if (listener) watch.emplace(*listener, folder, results.lock());
  ProgressBar bar;
  CurveSummary curves(results, scene, [&](const std::string& line) {
    bar.end();
    say(line);
  });

  Simulation simulation(std::make_unique<Simulation::Parts>(job.opened, std::move(prepared), threads, &curves,
                                                            ranks.communicator(), device));
  simulation.interrupt_when([&] { return interrupted.load(); });
  simulation.parts().checkpoints.set(
      [&](const StateToSave& now) { simulation.done() ? results.final_state(now) : results.checkpoint(now); },
      description.output.checkpoint_every);
  if (!quiet || watch)
    simulation.on_progress([&](const Progress& now) {
      if (!quiet) bar.show(now);
      if (watch) watch->say(progress_text(now));
    });
  if (last) {
    const Checkpoint& checkpoint = last->checkpoint;
    say("continues from step " + std::to_string(checkpoint.step) + ", stage \"" + checkpoint.stage + "\"");
    simulation.resume(checkpoint);
  }
  say(counted(simulation.world().ids().size(), "body", "bodies") + ", " +
      (ranks.several() ? std::to_string(ranks.count()) + " ranks of " : "") + counted(threads, "thread", "threads") +
      ", results in " + folder.string());
  const RunSummary summary = run_or_advise(simulation, job);
  bar.end();

  std::cout << curves.text();
  print_speed(summary);
  for (const std::string& warning : summary.warnings)
    std::cerr << "grit: warning: " << job.file << ": " << warning << std::endl;
  std::cout << "results: " << folder.string() << '\n';
  if (description.output.picture) std::cout << "picture: " << (folder / "picture.svg").string() << '\n';
  // Before the page, which takes time with many bodies: a second Ctrl-C skips it.
  if (summary.status == "interrupted")
    std::cerr << "interrupted; the results are saved in " << folder.string() << "; continue with 'grit run --resume "
              << shell_word(folder.string()) << "'" << std::endl;
  if (!options.has("no-report")) make_report(folder);
  if (summary.status == "interrupted") return ExitStatus::interrupted;
  if (summary.status == "failed")
    throw NumericsError(summary.message + resume_advice(summary.guard, resolved(description), folder));
  return ExitStatus::done;
}

}  // namespace

void run_options(Options& options) {
  namespace po = boost::program_options;
  options.add()("out", po::value<std::string>()->value_name("DIR"),
                "folder of the results; for several descriptions, a folder in it for each; default: results/NAME")(
      "overwrite", "replace existing results")(
      "resume",
      "continue from the last checkpoint, with the same bits as an uninterrupted run; FILE may be a folder of results")(
      "no-report", "do not write the page report.html")("quiet,q", "no progress, only the summary")(
      "watch", "serve the page of the run while it runs, for browsers on this machine")(
      "port", po::value<std::string>()->value_name("N"), "port of --watch; default: a free one");
  options.add_threads("number of threads; the results have the same bits for any number");
  options.add_device();
  options.add_set();
}

namespace {

ExitStatus run_jobs(const Options& options, RunRanks& ranks) {
  if (options.words().empty()) throw UsageError("no description given; see 'grit run --help'");
  options.warn_of_threads();
  if (options.device() != DeviceKind::none && ranks.several())
    throw UsageError("found --device with " + std::to_string(ranks.count()) + " ranks; a device is for one process");
  if (options.has("resume") && options.has("overwrite"))
    throw UsageError("--resume continues results, --overwrite replaces them; give one of them");
  if (ranks.several() && options.words().size() > 1)
    throw UsageError("found " + std::to_string(options.words().size()) + " descriptions for " +
                     std::to_string(ranks.count()) + " ranks, which run one; start them one by one");
  ranks.expect_agreement();
  if (!ranks.is_first()) return follow(options, ranks);
  auto jobs = jobs_of(options);
  open_all(jobs, options);
  const auto listener = listener_of(options);
  if (listener) std::cerr << "watch: http://127.0.0.1:" << listener->port() << "/ during the run" << std::endl;
  std::vector<std::string> command_line{program_invocation_name, "run"};
  command_line.insert(command_line.end(), options.command_line().begin(), options.command_line().end());
  ExitStatus status = ExitStatus::done;
  for (const RunJob& job : jobs) {
    const ExitStatus one = report([&] {
      try {
        return at_its_place(job.opened->scene.document,
                            [&] { return run_one(job, options, command_line, listener, ranks); });
      } catch (const NumericsError& error) {
        throw NumericsError(job.file + ": " + error.what());
      }
    });
    if (status == ExitStatus::done) status = one;
    // A numerical failure of one scene does not affect the next.
    if (one != ExitStatus::done && one != ExitStatus::numerics) break;
  }
  return status;
}

}  // namespace

ExitStatus run_command(const Options& options) {
  outlive_readers();
  RunRanks ranks;
  if (!ranks.several()) return run_jobs(options, ranks);
  const ExitStatus status = report([&] { return run_jobs(options, ranks); });
  // Ranks wait for the first one until it has compared them.
  if (ranks.is_awaited()) ranks.agree({}, "failed", {});
  return ranks.end(status);
}

}  // namespace grit
