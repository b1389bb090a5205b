// A run: stage after stage, with probes, frames and progress.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "grit/simulation.hpp"
#include "input/scene.hpp"
#include "kernel/kernel.hpp"
#include "run/recorder.hpp"
#include "simulation/live_scene.hpp"

namespace grit {

struct RunControl {
  const std::atomic<bool>* interrupted = nullptr;  ///< looked at every step
  std::function<void(const Progress&)> progress;   ///< called while the run goes on
  double progress_every = 0.2;                     ///< s, no oftener
  double checkpoint_every = 0;                     ///< s of wall clock; 0: only when interrupted
  const Checkpoint* resume = nullptr;              ///< of a run of the same scene, from where to go on
};

/// Runs all stages; `live` is the scene at its beginning, and the kernel was made of it. Returns what came of it:
/// status "done", "interrupted" or "failed" (a guard, a stage that did not end, an expectation that was not met; the
/// message says which); in all three cases everything was recorded, the last instant included. Other errors are thrown.
/// A run that is interrupted has saved a checkpoint; one that goes on from it gives the same bits as one that was never
/// stopped, apart from what was recorded after the checkpoint.
RunSummary run(const Scene& scene, LiveScene& live, Kernel& kernel, Recorder& recorder, const RunControl& control);

}  // namespace grit
