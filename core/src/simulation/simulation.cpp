#include "grit/simulation.hpp"

#include <utility>

#include "bodies/make_bodies.hpp"
#include "description/placed_error.hpp"
#include "grit/error.hpp"
#include "input/places.hpp"
#include "simulation/first_instant.hpp"
#include "simulation/progress_reporter.hpp"
#include "simulation/stage_runner.hpp"
#include "simulation/standard_registry.hpp"

namespace grit {

namespace {

/// Nothing is written.
class NoRecorder final : public Recorder {
 public:
  void begin(const World&, std::span<const ProbeGroup>) override {}
  void sample(std::size_t, const World&, std::span<const std::span<const double>>) override {}
  void frame(const World&, std::span<const FieldGroup>) override {}
  void stage_ended(const World&, const std::string&) override {}
  void finish(const World&, const RunSummary&) override {}
};

}  // namespace

/// Members are made in this order, and refer to those before.
struct Simulation::Parts {
  Parts(std::unique_ptr<Registry> plugins, Document document, unsigned threads)
      : registry(std::move(plugins)),
        scene(read_scene(std::move(document), *registry)),
        live(scene),
        kernel(at_first_instant(
            scene.document,
            [&] {
              return Kernel(live.now(), live.components(),
                            make_bodies(live.now(), live.components(), requested_state(live.components())), threads);
            })),
        runner(scene, live, kernel, recorder),
        progress(runner, kernel.world(), scene.stages.size()) {
    at_first_instant(scene.document, [this] { runner.prepare(); });
  }

  void start() {
    if (started) return;
    at_first_instant(scene.document, [this] { runner.start(); });
    started = true;
    progress.enter_stage();
  }
  /// One step, or the end of a stage. `stop` as StageRunner has it.
  StageRunner::Event next(bool stop) {
    return at_its_place(scene.document, [&] {
      try {
        return runner.next(stop);
      } catch (PlacedError& error) {
        error.begun(runner.stages_begun());
        throw;
      }
    });
  }
  bool wants_to_stop() const { return interrupted && interrupted(); }

  std::unique_ptr<Registry> registry;
  Scene scene;
  LiveScene live;
  Kernel kernel;
  NoRecorder recorder;
  StageRunner runner;
  ProgressReporter progress;
  bool started = false;
  std::function<bool()> interrupted;
};

Simulation::Simulation(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

Simulation Simulation::open(const std::filesystem::path& file, const SimulationOptions& options) {
  auto registry = standard_registry(options.plugin_path);
  Document document = load_document(file, options.sets, *registry);
  return Simulation(std::make_unique<Parts>(std::move(registry), std::move(document), options.threads));
}

Simulation Simulation::from_text(const std::string& text, const SimulationOptions& options, const std::string& name) {
  auto registry = standard_registry(options.plugin_path);
  Document document = expanded_document(Document::parse(text, name), options.sets, *registry);
  return Simulation(std::make_unique<Parts>(std::move(registry), std::move(document), options.threads));
}

Simulation::Simulation(const Description& description, const SimulationOptions& options) {
  auto registry = standard_registry(options.plugin_path);
  Document document = expanded_document(Document(description, "description"), options.sets, *registry);
  parts_ = std::make_unique<Parts>(std::move(registry), std::move(document), options.threads);
}

Forecast Simulation::check() {
  Parts& parts = *parts_;
  if (!parts.started) at_first_instant(parts.scene.document, [&] { parts.kernel.find_forces(); });
  return {.bodies = world().positions().size(),
          .contacts = parts.kernel.state().pairs.touching_count(),
          .time_step = world().dt(),
          .critical_time_step = parts.kernel.critical_time_step(),
          .bytes = parts.kernel.state().bytes()};
}

bool Simulation::run_stage() {
  parts_->start();
  while (!done()) {
    const StageRunner::Event event = parts_->next(parts_->wants_to_stop());
    if (event == StageRunner::Event::stopped) return false;
    if (event == StageRunner::Event::stage_ended) {
      parts_->progress.enter_stage();
      return true;
    }
    parts_->progress.step();
  }
  return true;
}

bool Simulation::run() {
  while (!done())
    if (!run_stage()) return false;
  return true;
}

std::uint64_t Simulation::step(std::uint64_t steps) {
  parts_->start();
  std::uint64_t taken = 0;
  while (taken < steps && !done()) taken += parts_->next(false) == StageRunner::Event::stepped ? 1 : 0;
  parts_->kernel.find_forces();
  return taken;
}

bool Simulation::done() const { return parts_->runner.done(); }

const World& Simulation::world() const { return parts_->kernel.world(); }

Description Simulation::description() const { return resolved(*parts_->scene.description); }

void Simulation::set(const std::string& pointer, const Description& value) {
  parts_->start();
  if (!done()) parts_->runner.set(pointer, value);
}

void Simulation::every_time(double seconds, Observer observer) {
  parts_->runner.call({.every_time = seconds}, std::move(observer));
}

void Simulation::every_steps(std::uint64_t steps, Observer observer) {
  parts_->runner.call({.every_steps = static_cast<std::int64_t>(steps)}, std::move(observer));
}

void Simulation::at_stage_end(Observer observer) { parts_->runner.call({}, std::move(observer)); }

void Simulation::on_progress(std::function<void(const Progress&)> report, double interval) {
  parts_->progress.set(std::move(report), interval);
}

void Simulation::interrupt_when(std::function<bool()> condition) { parts_->interrupted = std::move(condition); }

Checkpoint Simulation::save() {
  parts_->start();
  return parts_->runner.save();
}

void Simulation::resume(const Checkpoint& checkpoint) {
  parts_->runner.resume(checkpoint);
  parts_->started = true;
}

}  // namespace grit
