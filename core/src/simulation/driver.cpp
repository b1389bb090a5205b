#include "simulation/driver.hpp"

#include <chrono>

#include "description/placed_error.hpp"
#include "grit/error.hpp"
#include "kernel/stopwatch.hpp"
#include "simulation/first_instant.hpp"
#include "simulation/progress_reporter.hpp"
#include "simulation/stage_runner.hpp"

namespace grit {
namespace {

using Instant = std::chrono::steady_clock::time_point;

// However short the time between checkpoints, they take no more than this fraction of it.
constexpr double most_for_checkpoints = 0.01;

/// Reports progress, and saves checkpoints, while a runner goes on.
class Driver {
 public:
  Driver(const Scene& scene, StageRunner& runner, Kernel& kernel, Recorder& recorder, const RunControl& control)
      : runner_(runner),
        recorder_(recorder),
        control_(control),
        progress_(runner, kernel.world(), scene.stages.size()) {
    progress_.set(control.progress, control.progress_every);
  }

  /// Returns false if it was interrupted.
  bool operator()() {
    saved_ = std::chrono::steady_clock::now();
    progress_.enter_stage();
    while (!runner_.done()) {
      // Asked once a step, so that what is saved is where the run stops.
      const bool stop = control_.interrupted != nullptr && control_.interrupted->load();
      if (stop || checkpoint_is_due()) save();
      const StageRunner::Event event = runner_.next(stop);
      if (event == StageRunner::Event::stopped) return false;
      if (event == StageRunner::Event::stage_ended) progress_.enter_stage();
      else progress_.step();
    }
    return true;
  }

 private:
  // Between two steps, and by the wall clock alone: nothing that is simulated depends on it.
  bool checkpoint_is_due() const {
    if (!(control_.checkpoint_every > 0)) return false;
    const double since = seconds_since(saved_);
    return since >= control_.checkpoint_every && most_for_checkpoints * since >= saving_;
  }

  void save() {
    const Instant began = std::chrono::steady_clock::now();
    recorder_.checkpoint(runner_.save());
    saved_ = std::chrono::steady_clock::now(), saving_ = seconds_since(began);
  }

  StageRunner& runner_;
  Recorder& recorder_;
  const RunControl& control_;
  ProgressReporter progress_;
  Instant saved_;
  double saving_ = 0;  // s, the last checkpoint
};

}  // namespace

RunSummary run(const Scene& scene, LiveScene& live, Kernel& kernel, Recorder& recorder, const RunControl& control) {
  StageRunner runner(scene, live, kernel, recorder);
  try {
    RunSummary summary;
    runner.prepare();
    if (control.resume != nullptr) runner.resume(*control.resume);
    else at_first_instant(scene.document, [&] { runner.start(); });  // before anything is recorded
    try {
      summary.status = Driver(scene, runner, kernel, recorder, control)() ? "done" : "interrupted";
    } catch (const NumericsError& error) {
      summary.status = "failed", summary.message = error.what(), summary.guard = error.guard();
    } catch (const PlacedError& error) {
      summary.status = "failed", summary.message = error.what();
      runner.fill(summary);
      recorder.finish(kernel.world(), summary);
      throw;
    }
    runner.finish(summary);
    return summary;
  } catch (PlacedError& error) {
    error.begun(runner.stages_begun());
    throw;
  }
}

}  // namespace grit
