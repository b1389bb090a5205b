// Computing time of the phases of a run.
#pragma once

#include <chrono>
#include <utility>

namespace grit {

inline double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Adds its lifetime [s] to a phase.
class Stopwatch {
 public:
  explicit Stopwatch(double& seconds) : seconds_(seconds) {}
  ~Stopwatch() { seconds_ += seconds_since(start_); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Divides time into laps of several phases; may be inactive.
class Laps {
 public:
  explicit Laps(bool on) : on_(on) {
    if (on_) last_ = std::chrono::steady_clock::now();
  }
  /// Adds the time since the last lap to a phase.
  void operator()(double& seconds) {
    if (!on_) return;
    const auto now = std::chrono::steady_clock::now();
    seconds += std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  bool on_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace grit
