// The parts of a Simulation, for the rest of the library.
#pragma once

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
  /// null: nothing is recorded. Throws DescriptionError for faults found when the kernel and probes are made.
  Parts(std::shared_ptr<OpenedScene> scene, Prepared prepared, unsigned threads, Recorder* record = nullptr);

  /// Begins the first stage, if it has not begun.
  void start();
  void resume(const Checkpoint& checkpoint);
  /// One step, or the end of a stage, as in StageRunner::next(); with progress and checkpoints.
  StageRunner::Event next(bool stop);
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

}  // namespace grit
