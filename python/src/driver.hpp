// A simulation driven from Python: access by one thread, interrupts, callbacks.
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <thread>

#include "arrays.hpp"
#include "checkpoints.hpp"
#include "grit/engine.hpp"
#include "grit/simulation.hpp"
#include "samples.hpp"

namespace grit::python {

/// How far a call of run() goes: to the end of the run, or the first of these.
struct Goal {
  std::uint64_t steps = std::numeric_limits<std::uint64_t>::max();  ///< to take
  double time = std::numeric_limits<double>::infinity();            ///< simulated [s]
  bool stage = false;                                               ///< to the end of the present stage
};

/// Its members need the GIL, and give it up while the simulation computes. Observers are known by their number and
/// engines by their name: they belong to the owner, the Python object that own() names and that is not kept, so that no
/// cycle of references is hidden from Python's garbage collection.
class Driver {
 public:
  /// `samples` is the recorder of the simulation.
  Driver(Simulation simulation, std::unique_ptr<Samples> samples);
  Driver(const Driver&) = delete;

  void own(const py::object& owner) { owner_ = py::weakref(owner); }
  /// Calls _observed(number) and _progressed(…) of the owner on the way. Exceptions of these, and of signals, end the
  /// run between two steps; it may go on later.
  void run(const Goal& goal, bool shows_progress);
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
  /// Adds or replaces an engine: in each step, _acted(name, bodies) of the owner returns forces and moments, arrays of
  /// three columns, or None. An exception there ends the simulation, as it is midway in a step; for a Ctrl-C it is
  /// called once more, and the run ends after the step. `rates`: see Engine::rates().
  void set_engine(const std::string& name, const EngineRates& rates);
  void remove_engine(const std::string& name);

  /// The present instant; with forces, which are found if they are not known yet.
  const World& world() const;
  const World& world_with_forces();
  Arrays& arrays() { return arrays_; }
  /// The probes of the description, and what they have sampled.
  std::vector<ProbeGroup> probes();
  py::array samples(const std::string& probe, const std::string& channel);
  bool done() const;
  /// Whether an error ended it, so that it cannot go on.
  bool failed();
  /// Throws if the simulation runs in another thread.
  Simulation& simulation();

 private:
  using Clock = std::chrono::steady_clock;
  class Running;
  class PythonEngine;
  void refuse_other_threads() const;
  void refuse_while_running(const char* what) const;
  void refuse_in_engine(const char* what) const;
  void refuse_done(const Goal& goal) const;
  std::shared_ptr<const Description> facts();
  bool stops();
  py::object owner() const;
  void observe(std::size_t number);
  void act(const std::string& engine, std::span<Row> force, std::span<Row> moment);
  /// Throws what a function in Python has raised in a step, if any.
  void throw_raised();
  void report(const Progress& progress);

  std::unique_ptr<Samples> samples_;  // outlives the simulation
  Simulation simulation_;
  Arrays arrays_{simulation_};
  std::shared_ptr<const Description> facts_;  // of its checkpoints, once they are needed
  std::size_t observers_ = 0;
  bool has_begun_ = false, has_forces_ = false;
  py::object owner_;                             // a weak reference
  std::optional<py::error_already_set> raised_;  // by an engine in this step, in which C++ gets an Error of its own
  bool acts_ = false;                            // in a function of an engine

  // While it runs.
  std::thread::id thread_;
  bool runs_ = false, shows_progress_ = false;
  std::uint64_t last_step_ = 0;
  double last_time_ = 0;
  Clock::time_point began_, asked_;  // signals were asked for
};

}  // namespace grit::python
