// When checkpoints are saved.
#pragma once

#include <chrono>
#include <functional>
#include <utility>

#include "storage/state_file.hpp"
#include "threads/stopwatch.hpp"

namespace grit {

/// Uses wall-clock time only: the simulation does not depend on it.
class CheckpointTimer {
 public:
  using Keep = std::function<void(const StateToSave&)>;

  /// `keep` gets the state every `interval` [s] of wall-clock time; 0: only when the simulation is interrupted.
  void set(Keep keep, double interval) {
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
  void save(const StateToSave& state) {
    const auto began = std::chrono::steady_clock::now();
    keep_(state);
    restart();
    saving_ = seconds_since(began);
  }

 private:
  // Maximum fraction of the run time for checkpoints, at any interval.
  static constexpr double largest_fraction = 0.01;

  Keep keep_;
  double interval_ = 0;  // s
  std::chrono::steady_clock::time_point saved_ = std::chrono::steady_clock::now();
  double saving_ = 0;  // s, the last checkpoint
};

}  // namespace grit
