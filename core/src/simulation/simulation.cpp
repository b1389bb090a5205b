#include "grit/simulation.hpp"

#include <utility>

#include "grit/error.hpp"
#include "input/scene.hpp"
#include "simulation/first_instant.hpp"
#include "simulation/parts.hpp"
#include "simulation/standard_registry.hpp"

namespace grit {
namespace {

constexpr const char* sets_by = "sets";  // the member of SimulationOptions, in messages

std::shared_ptr<const Registry> registry_of(const SimulationOptions& options) {
  for (const std::string& folder : options.plugin_path)
    if (const std::string fault = fault_of_plugin_directory(folder); !fault.empty())
      throw FileError("plugin_path: found \"" + folder + "\", " + fault + "; allowed are folders of plugins");
  return standard_registry(options.plugin_path, "plugin_path");
}

std::unique_ptr<Simulation::Parts> made(std::shared_ptr<const Registry> registry, Document document,
                                        const SimulationOptions& options, bool resumes, Recorder* record) {
  Scene scene = read_scene(std::move(document), *registry);
  const auto opened = std::make_shared<OpenedScene>(std::move(registry), std::move(scene));
  return std::make_unique<Simulation::Parts>(
      opened, resumes ? opened->prepare_to_resume(options.state) : opened->prepare(options.state), options.threads,
      record, nullptr, options.device);
}

std::unique_ptr<Simulation::Parts> made(Document written, const SimulationOptions& options, bool resumes,
                                        Recorder* record = nullptr) {
  auto registry = registry_of(options);
  Document document = expanded_document(std::move(written), options.sets, *registry, sets_by);
  return made(std::move(registry), std::move(document), options, resumes, record);
}

std::unique_ptr<Simulation::Parts> resumed(std::unique_ptr<Simulation::Parts> parts, const SimulationOptions& options) {
  if (options.checkpoint) parts->resume(*options.checkpoint);
  return parts;
}

}  // namespace

std::unique_ptr<Simulation::Parts> open_parts(const std::filesystem::path& file, const SimulationOptions& options,
                                              bool resumes, Recorder* record) {
  auto registry = registry_of(options);
  Document document = load_document(file, options.sets, *registry, sets_by);
  return made(std::move(registry), std::move(document), options, resumes, record);
}

std::unique_ptr<Simulation::Parts> open_parts(const Description& description, const SimulationOptions& options,
                                              bool resumes, Recorder* record) {
  return made(Document(description, "description"), options, resumes, record);
}

Simulation::Simulation(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

Simulation Simulation::open(const std::filesystem::path& file, const SimulationOptions& options) {
  return Simulation(resumed(open_parts(file, options, options.checkpoint.has_value()), options));
}

Simulation Simulation::from_text(const std::string& text, const SimulationOptions& options, const std::string& name) {
  return Simulation(resumed(made(Document::parse(text, name), options, options.checkpoint.has_value()), options));
}

Simulation::Simulation(const Description& description, const SimulationOptions& options)
    : Simulation(resumed(open_parts(description, options, options.checkpoint.has_value()), options)) {}

Forecast Simulation::check() {
  Parts& parts = *parts_;
  if (!parts.started) at_first_instant(parts.opened->scene.document, [&] { parts.kernel.find_forces(); });
  return {.bodies = parts.kernel.bodies(),
          .contacts = parts.kernel.contact_count(),
          .time_step = world().dt(),
          .critical_time_step = parts.kernel.critical_time_step(),
          .bytes = parts.kernel.state().bytes()};
}

bool Simulation::run_stage() {
  parts_->start();
  while (!done()) {
    const StageRunner::Event event = parts_->next(parts_->wants_to_stop());
    if (event == StageRunner::Event::stopped) return false;
    if (event == StageRunner::Event::stage_ended) return true;
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
  parts_->show_instant();
  return taken;
}

bool Simulation::done() const { return parts_->runner.done(); }

const World& Simulation::world() const { return parts_->kernel.world(); }

std::shared_ptr<const void> Simulation::keep(WorldArray array) { return parts_->kernel.keep(array); }

Description Simulation::description() const { return resolved(*parts_->opened->scene.description); }

void Simulation::set(const std::string& pointer, const Description& value) {
  if (done()) throw Error("the simulation is done; a value that is set now would have no effect");
  parts_->set(pointer, value);
}

void Simulation::set_engine(const std::string& name, std::shared_ptr<Engine> engine) {
  if (done()) throw Error("the simulation is done; an engine would have no effect now");
  parts_->set_engine(name, std::move(engine));
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

void Simulation::on_checkpoint(std::function<void(const Checkpoint&)> keep, double interval) {
  CheckpointTimer::Keep keep_saved;
  if (keep) keep_saved = [keep = std::move(keep)](const StateToSave& state) { keep(saved(state)); };
  parts_->checkpoints.set(std::move(keep_saved), interval);
}

void Simulation::interrupt_when(std::function<bool()> condition) { parts_->interrupted = std::move(condition); }

Checkpoint Simulation::save() { return parts_->save(); }

void Simulation::resume(const Checkpoint& checkpoint) { parts_->resume(checkpoint); }

}  // namespace grit
