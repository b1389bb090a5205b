// Reports the progress of a stage at intervals.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>

#include "grit/simulation.hpp"
#include "simulation/stage_runner.hpp"
#include "threads/stopwatch.hpp"

namespace grit {

class ProgressReporter {
 public:
  ProgressReporter(const StageRunner& runner, const Kernel& kernel, std::size_t stages)
      : runner_(runner), kernel_(kernel), world_(kernel.world()), stages_(stages) {}
  /// Calls `report`, at most every `interval` [s] of wall-clock time.
  void set(std::function<void(const Progress&)> report, double interval) {
    report_ = std::move(report), interval_ = interval;
  }

  void enter_stage() {
    began_ = last_ = std::chrono::steady_clock::now();
    last_step_ = world_.step();
    done_at_begin_ = report_ && !runner_.done() ? runner_.progress().value_or(0) : 0;
  }
  /// After a step.
  void step() {
    if (!report_ || world_.step() % 8 != 0) return;
    const double since = seconds_since(last_);
    if (since < interval_) return;
    Progress now;
    now.stage = runner_.description().name, now.stage_number = runner_.stage() + 1, now.stages = stages_;
    now.fraction = runner_.progress();
    if (const double done = now.fraction.value_or(0) - done_at_begin_; done > 1e-3)
      now.seconds_left = seconds_since(began_) * (1 - *now.fraction) / done;
    now.time = world_.time();
    now.particle_steps_per_second =
        static_cast<double>(world_.step() - last_step_) * static_cast<double>(kernel_.bodies()) / since;
    last_ = std::chrono::steady_clock::now(), last_step_ = world_.step();
    report_(now);
  }

 private:
  const StageRunner& runner_;
  const Kernel& kernel_;
  const World& world_;
  std::size_t stages_;
  std::function<void(const Progress&)> report_;
  double interval_ = 0;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now(), last_ = began_;
  std::uint64_t last_step_ = 0;
  double done_at_begin_ = 0;  // fraction of the stage
};

}  // namespace grit
