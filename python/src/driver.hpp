// A simulation driven from Python: access by one thread, interrupts, callbacks.
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "arrays.hpp"
#include "checkpoints.hpp"
#include "grit/simulation.hpp"

namespace grit::python {

/// How far a call of run() goes: to the end of the run, or the first of these.
struct Goal {
  std::uint64_t steps = std::numeric_limits<std::uint64_t>::max();  ///< to take
  double time = std::numeric_limits<double>::infinity();            ///< simulated [s]
  bool stage = false;                                               ///< to the end of the present stage
};

/// Its members need the GIL, and give it up while the simulation computes. Observers are known by their number: they
/// belong to the owner, the Python object that each call of run() passes, so that no cycle of references is hidden from
/// Python's garbage collection.
class Driver {
 public:
  explicit Driver(Simulation simulation);
  Driver(const Driver&) = delete;

  /// Calls owner._observed(number) and owner._progressed(…) on the way. Exceptions of these, and of signals, end the
  /// run between two steps; it may go on later.
  void run(const py::object& owner, const Goal& goal, bool shows_progress);
  Forecast check();
  /// `value`: JSON.
  void set(const std::string& pointer, const std::string& value);
  SavedState save();
  /// Throws, as check_facts() does, for a state of another simulation, and Error for one that has begun.
  void resume(const SavedState& saved);

  /// Numbers count from 0, over all three.
  std::size_t every_time(double seconds);
  std::size_t every_steps(std::uint64_t steps);
  std::size_t at_stage_end();

  /// The present instant; with forces, which are found if they are not known yet.
  const World& world() const;
  const World& world_with_forces();
  Arrays& arrays() { return arrays_; }
  bool done() const;
  /// Whether an error ended it, so that it cannot go on.
  bool failed();
  /// Throws if the simulation runs in another thread.
  Simulation& simulation();

 private:
  using Clock = std::chrono::steady_clock;
  class Running;
  void refuse_other_threads() const;
  void refuse_while_running(const char* what) const;
  void refuse_done(const Goal& goal) const;
  std::shared_ptr<const Description> facts();
  bool stops();
  void observe(std::size_t number);
  void report(const Progress& progress);

  Simulation simulation_;
  Arrays arrays_{simulation_};
  std::shared_ptr<const Description> facts_;  // of its checkpoints, once they are needed
  std::size_t observers_ = 0;
  bool has_begun_ = false, has_forces_ = false;

  // While it runs.
  std::thread::id thread_;
  bool runs_ = false, shows_progress_ = false;
  py::handle owner_;
  std::uint64_t last_step_ = 0;
  double last_time_ = 0;
  Clock::time_point began_, asked_;  // signals were asked for
};

}  // namespace grit::python
