// When checkpoints are saved.
#pragma once

#include <chrono>
#include <functional>
#include <utility>

#include "grit/checkpoint.hpp"
#include "threads/stopwatch.hpp"

namespace grit {

/// Uses wall-clock time only: the simulation does not depend on it.
class CheckpointTimer {
 public:
  /// `keep` gets a checkpoint every `interval` [s] of wall-clock time; 0: only when the simulation is interrupted.
  void set(std::function<void(const Checkpoint&)> keep, double interval) {
    keep_ = std::move(keep), interval_ = interval;
    restart();
  }
  bool keeps() const { return keep_ != nullptr; }
  void restart() { saved_ = std::chrono::steady_clock::now(); }
  /// Whether one is due. `interrupted`: the simulation stops here.
  bool is_due(bool interrupted) const {
    if (!keep_) return false;
    if (interrupted) return true;
    if (!(interval_ > 0)) return false;
    const double since = seconds_since(saved_);
    return since >= interval_ && largest_fraction * since >= saving_;
  }
  /// Passes the checkpoint from `save` to `keep`.
  template <class Save>
  void save(Save save) {
    const auto began = std::chrono::steady_clock::now();
    keep_(save());
    restart();
    saving_ = seconds_since(began);
  }

 private:
  // Maximum fraction of the run time for checkpoints, at any interval.
  static constexpr double largest_fraction = 0.01;

  std::function<void(const Checkpoint&)> keep_;
  double interval_ = 0;  // s
  std::chrono::steady_clock::time_point saved_ = std::chrono::steady_clock::now();
  double saving_ = 0;  // s, the last checkpoint
};

}  // namespace grit
