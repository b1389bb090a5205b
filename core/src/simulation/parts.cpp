#include "simulation/parts.hpp"

#include <cstdint>
#include <tuple>
#include <utility>

#include "grit/error.hpp"
#include "simulation/first_instant.hpp"
#include "simulation/no_recorder.hpp"

namespace grit {
namespace {

Recorder& no_recorder() {
  static NoRecorder none;
  return none;
}

}  // namespace

Simulation::Parts::Parts(std::shared_ptr<OpenedScene> scene, Prepared prepared, unsigned threads, Recorder* record,
                         Communicator* ranks, DeviceKind device)
    : opened(std::move(scene)),
      recorder(record != nullptr ? *record : no_recorder()),
      kernel(at_first_instant(opened->scene.document,
                              [&] {
                                const LiveScene& live = opened->live;
                                return Kernel(live.now(), live.components(), std::move(prepared), threads, ranks);
                              })),
      runner(opened->scene, opened->live, kernel, recorder),
      progress(runner, kernel, opened->scene.stages.size()) {
  at_first_instant(opened->scene.document, [&] { kernel.use(device); });
  placed([this] { runner.prepare(); });
}

void Simulation::Parts::start() {
  refuse_failed();
  if (started) return;
  try {
    at_first_instant(opened->scene.document, [this] { runner.start(); });
  } catch (...) {
    failure = std::current_exception();
    throw;
  }
  started = true;
  progress.enter_stage(), checkpoints.restart();
}

void Simulation::Parts::resume(const Checkpoint& checkpoint) {
  if (started) throw Error("a simulation that has begun cannot resume from a checkpoint; open the description again");
  started = true;
  try {
    placed([&] { runner.resume(checkpoint); });
  } catch (...) {
    failure = std::current_exception();
    throw;
  }
  progress.enter_stage(), checkpoints.restart();
}

StageRunner::Event Simulation::Parts::next(bool stop) try {
  refuse_failed();
  bool saves = checkpoints.is_due(stop);
  if (kernel.ranks() > 1) {
    // By clocks and signals, of which ranks have different ones. Not at each step, as messages take time.
    constexpr std::uint64_t asked_every = 8;
    if (kernel.world().step() % asked_every == 0) std::tie(stop, saves) = kernel.any_rank(stop, saves);
    else stop = saves = false;
  }
  // Saved before the step, so that the checkpoint is the state at which the simulation stops.
  if (saves) checkpoints.save(runner.to_save());
  const StageRunner::Event event = placed([&] { return runner.next(stop); });
  if (event == StageRunner::Event::stage_ended) progress.enter_stage();
  else if (event == StageRunner::Event::stepped) {
    const auto alone = kernel.alone();
    progress.step();
  }
  return event;
} catch (const NumericsError& error) {
  // A time step that is too large can be set again; a stage that fails otherwise would fail again.
  if (error.guard() != Guard::critical_step || runner.is_midway()) failure = std::current_exception();
  throw;
} catch (const PluginError&) {
  failure = std::current_exception();
  throw;
} catch (...) {
  if (runner.is_midway()) failure = std::current_exception();
  throw;
}

void Simulation::Parts::set(const std::string& pointer, const Description& value) {
  start();
  runner.set(pointer, value);
}

void Simulation::Parts::set_engine(const std::string& name, std::shared_ptr<Engine> engine) {
  refuse_failed();
  if (engine) {
    const StateRequest kept = kernel.state().bodies.state, needed = engine->needs();
    for (const auto& [state, what] :
         {std::pair(BodyState::rotation, "rotations"), std::pair(BodyState::displacement, "displacements"),
          std::pair(BodyState::energy, "the energy balance")})
      if (needed.has(state) && !kept.has(state))
        throw Error("the engine \"" + name + "\" needs " + what +
                    ", which this simulation does not keep; request this state when the simulation is opened");
  }
  runner.set_engine(name, std::move(engine));
}

Checkpoint Simulation::Parts::save() {
  start();
  return saved(runner.to_save());
}

void Simulation::Parts::show_instant() try {
  placed([this] { runner.show_instant(); });
} catch (...) {
  if (runner.is_midway()) failure = std::current_exception();
  throw;
}

}  // namespace grit
