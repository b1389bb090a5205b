// The parts of a Simulation, for the rest of the library.
#pragma once

#include <exception>
#include <functional>
#include <memory>

#include "description/placed_error.hpp"
#include "grit/simulation.hpp"
#include "input/places.hpp"
#include "kernel/kernel.hpp"
#include "run/recorder.hpp"
#include "simulation/checkpoint_timer.hpp"
#include "simulation/opened_scene.hpp"
#include "simulation/progress_reporter.hpp"
#include "simulation/stage_runner.hpp"

namespace grit {

/// Members are made in this order; later ones refer to earlier ones.
struct Simulation::Parts {
  /// `prepared`: from which the simulation starts. `record` gets all reports of the simulation and must outlive it;
  /// null: nothing is recorded. `ranks`: processes that share the simulation, all of which make these parts and call
  /// the same functions; null: one. `device`: that steps the bodies. Throws DescriptionError for faults found when the
  /// kernel and probes are made.
  Parts(std::shared_ptr<OpenedScene> scene, Prepared prepared, unsigned threads, Recorder* record = nullptr,
        Communicator* ranks = nullptr, DeviceKind device = DeviceKind::none);

  /// Throws `failure` again, if there is one. start(), next(), set() and save() do so first.
  void refuse_failed() const {
    if (failure) std::rethrow_exception(failure);
  }
  /// Begins the first stage, if it has not begun.
  void start();
  void resume(const Checkpoint& checkpoint);
  /// One step, or the end of a stage, as in StageRunner::next(); with progress and checkpoints.
  StageRunner::Event next(bool stop);
  void set(const std::string& pointer, const Description& value);
  void set_engine(const std::string& name, std::shared_ptr<Engine> engine);
  Checkpoint save();
  void show_instant();
  bool wants_to_stop() const { return interrupted && interrupted(); }

  std::shared_ptr<OpenedScene> opened;
  Recorder& recorder;
  Kernel kernel;
  StageRunner runner;
  ProgressReporter progress;
  CheckpointTimer checkpoints;
  std::function<bool()> interrupted;
  bool started = false;
  /// Why the simulation cannot go on: what ended a step midway, or a stage that cannot end. Its bodies may have moved
  /// while others have not.
  std::exception_ptr failure;

 private:
  /// Runs `work`. Faults get their position in the description after the stages that have begun.
  template <class Work>
  auto placed(Work work) {
    return at_its_place(opened->scene.document, [&] {
      try {
        return work();
      } catch (PlacedError& error) {
        error.begun(runner.stages_begun());
        throw;
      }
    });
  }
};

/// The parts of a simulation of a file, or of a description made by a program. `resumes`: without bodies, so that
/// resume() has to follow. `record`: as for Parts.
std::unique_ptr<Simulation::Parts> open_parts(const std::filesystem::path& file, const SimulationOptions& options,
                                              bool resumes, Recorder* record = nullptr);
std::unique_ptr<Simulation::Parts> open_parts(const Description& description, const SimulationOptions& options,
                                              bool resumes, Recorder* record = nullptr);

}  // namespace grit
