#include "run/driver.hpp"

#include <unistd.h>

#include <csignal>
#include <iostream>

#include "app/curve_summary.hpp"
#include "app/options.hpp"
#include "app/progress_bar.hpp"
#include "app/run_setup.hpp"
#include "grit/error.hpp"
#include "input/scene.hpp"
#include "output/results_folder.hpp"
#include "scene/make_bodies.hpp"

namespace grit {
namespace {

std::atomic<bool> interrupted{false};

// The second Ctrl-C gets what it wants at once.
extern "C" void on_interrupt(int signal) {
  interrupted.store(true);
  std::signal(signal, SIG_DFL);
}

std::vector<WallShape> wall_shapes(const SceneDescription& scene) {
  std::vector<WallShape> shapes;
  for (const auto& [name, wall] : scene.walls) shapes.push_back({name, wall.geometry->triangles()});
  return shapes;
}

ExitStatus run_one(const std::filesystem::path& file, const Options& options, const Registry& registry,
                   const std::filesystem::path& folder) {
  const unsigned threads = options.get<unsigned>("threads");
  const Scene scene = load_scene(file, options.list("set"), registry);
  const SceneDescription& description = *scene.description;
  if (description.stages.empty())
    throw Error(file.string() + ": /stages is empty, so that there is nothing to run; add a stage");

  ResultsOptions results{.folder = folder,
                         .existing = options.has("overwrite") ? Existing::overwrite : Existing::refuse,
                         .title = description.title,
                         .facts = {.description = resolved(description),
                                   .plugins = plugins_used(description, registry),
                                   .seed = description.seed,
                                   .threads = threads},
                         .walls = wall_shapes(description),
                         .picture = {}};
  if (const auto& picture = description.output.picture)
    results.picture = PictureRequest{picture->x, picture->y, picture->view, picture->color};
  ResultsFolder recorder(std::move(results));

  std::cerr << file.string() << ": " << description.title << std::endl;
  Simulation simulation(description, make_bodies(description, run_state(description)), threads);
  std::cerr << simulation.positions().size() << " bodies, " << threads << (threads == 1 ? " thread" : " threads")
            << ", results in " << folder.string() << std::endl;

  ProgressBar bar(isatty(STDERR_FILENO) != 0);
  CurveSummary summary_curves(recorder, description.output.summary, [&](const std::string& line) {
    bar.end();
    std::cerr << line << std::endl;
  });
  RunControl control;
  control.interrupted = &interrupted;
  if (!options.has("quiet")) control.progress = [&](const Progress& now) { bar.show(now); };
  const RunSummary summary = run(scene, simulation, summary_curves, control);
  bar.end();

  std::cout << summary_curves.text();
  const auto share = [&](double seconds) {
    return std::to_string(static_cast<int>(std::lround(100 * seconds / std::max(summary.wall_seconds, 1e-9)))) + " %";
  };
  std::cout << summary.steps << " steps of " << summary.bodies << " bodies in " << duration_text(summary.wall_seconds)
            << ", " << std::round(1e-4 * summary.particle_steps_per_second) / 100 << " M particle-steps/s (";
  for (std::size_t i = 0; i < summary.phases.size(); ++i)
    std::cout << (i > 0 ? ", " : "") << summary.phases[i].name << ' ' << share(summary.phases[i].seconds);
  std::cout << ")\nresults: " << folder.string() << '\n';
  if (description.output.picture) std::cout << "picture: " << (folder / "picture.svg").string() << '\n';
  if (summary.status == "failed") throw NumericsError(summary.message);
  if (summary.status == "interrupted") {
    std::cerr << "interrupted; what was reached is saved in " << folder.string() << std::endl;
    return ExitStatus::interrupted;
  }
  return ExitStatus::done;
}

}  // namespace

ExitStatus run_command(const std::vector<std::string>& words) {
  namespace po = boost::program_options;
  Options options(command("run"));
  options.add()("out", po::value<std::string>()->value_name("DIR"),
                "folder of the results; for several descriptions, a folder in it for each; default: results/NAME")(
      "threads", po::value<unsigned>()->default_value(std::max(1u, std::thread::hardware_concurrency()))->value_name("N"),
      "threads; results are the same bits for any number")(
      "set", po::value<std::vector<std::string>>()->composing()->value_name("/POINTER=VALUE"),
      "change a value of the description; may be given again")("overwrite", "replace results that are there")(
      "quiet,q", "no progress");
  if (!options.read(words)) return ExitStatus::done;
  if (options.words().empty()) throw UsageError("no description was given; see 'grit run --help'");
  if (options.get<unsigned>("threads") < 1 || options.get<unsigned>("threads") > 1024)
    throw UsageError("--threads takes a number from 1 to 1024");
  const auto registry = options.registry();
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  for (const std::string& word : options.words()) {
    const std::filesystem::path file(word);
    std::filesystem::path folder =
        options.has("out") ? std::filesystem::path(options.get<std::string>("out")) : std::filesystem::path("results");
    if (!options.has("out") || options.words().size() > 1) folder /= file.stem();
    const ExitStatus status = run_one(file, options, *registry, folder);
    if (status != ExitStatus::done) return status;
  }
  return ExitStatus::done;
}

}  // namespace grit
