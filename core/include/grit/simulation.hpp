// grit as a library. A simulation is opened from a description and run by stages or steps; it can be observed, changed,
// saved and resumed.
//
//   grit::Simulation simulation = grit::Simulation::open("box.json");
//   simulation.every_time(1e-3, [](const grit::World& world) { … });
//   simulation.run();
//
// Nothing here prints or exits. Errors are thrown; their types are in grit/error.hpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grit/checkpoint.hpp"
#include "grit/description.hpp"
#include "grit/world.hpp"

namespace grit {

class Engine;

/// What steps the bodies.
enum class DeviceKind {
  none,      ///< this process
  gpu,       ///< a GPU, by CUDA
  emulated,  ///< the kernels of a GPU in loops on the CPU: to test them, not to be fast
};

/// How a simulation is opened.
struct SimulationOptions {
  unsigned threads = 1;           ///< results are identical for any number
  /// Throws DescriptionError for what of the description a device cannot do.
  DeviceKind device = DeviceKind::none;
  std::vector<std::string> sets;  ///< changes of the description, "/pointer=value", in order; file of problems: "sets"
  /// Folders searched for plugins, before those of GRIT_PLUGIN_PATH and those next to the library. FileError is thrown
  /// for one that has none.
  std::vector<std::string> plugin_path;
  /// State of bodies that World then has, also if no component requests it.
  StateRequest state = {};
  /// Resumes from this state of a simulation of the same description, as resume() does. Bodies are not made first: a
  /// sample from which the simulation began, or files of bodies, may have been removed.
  std::optional<Checkpoint> checkpoint = {};
};

/// Progress of the present stage.
struct Progress {
  std::string stage;
  std::size_t stage_number = 0, stages = 0;  ///< from 1
  std::optional<double> fraction;            ///< of the stage, 0 … 1; none if its end cannot be estimated
  std::optional<double> seconds_left;        ///< of computing time until the stage ends [s]
  double time = 0;                           ///< simulated [s]
  double particle_steps_per_second = 0;      ///< recent speed [1/s]
};

/// Size and time step of a run, from its initial state.
struct Forecast {
  std::size_t bodies = 0;         ///< at the start; each sphere of a clump is one
  std::size_t contacts = 0;       ///< between bodies, at the start
  double time_step = 0;           ///< s, at the start
  double critical_time_step = 0;  ///< s, at the start
  std::size_t bytes = 0;          ///< memory of bodies and contacts at the start
};

/// A simulation at one instant. Not thread-safe: all calls must come from one thread.
///
/// An error that ends a step midway, as a guard does, or a stage that does not end, leaves a failed simulation: bodies
/// may have moved while the time has not. world() shows them, and run(), run_stage(), step(), set() and save() throw
/// the same error again. After a time step that is too large nothing has moved: set another one, and go on.
class Simulation {
 public:
  /// Reads a description and those that it extends, and creates its bodies, walls and components. Throws
  /// DescriptionError with all problems, each with file, line and pointer; FileError; PluginError.
  static Simulation open(const std::filesystem::path& file, const SimulationOptions& options = {});
  /// The same for the text of a description. Relative paths in it start in the working directory; messages use `name`
  /// as the file name.
  static Simulation from_text(const std::string& text, const SimulationOptions& options = {},
                              const std::string& name = "description");
  /// The same for a description made by a program.
  explicit Simulation(const Description& description, const SimulationOptions& options = {});
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  /// Computes the forces of the initial state and returns the size and time step of the run. Throws DescriptionError
  /// for problems that only show there: bodies that overlap too much, a time step above the critical one, an unknown
  /// channel of a probe.
  Forecast check();

  /// Runs the present stage to its end, then begins the next one, if any. Returns false if it was interrupted between
  /// two steps, true if the simulation is done. Throws NumericsError if a guard trips or the stage does not end within
  /// its limit.
  bool run_stage();
  /// Runs all remaining stages. Returns false if it was interrupted.
  bool run();
  /// Takes `steps` time steps, through the ends of stages; fewer if the last stage ends. Returns the number taken: 0 if
  /// the simulation is done.
  std::uint64_t step(std::uint64_t steps = 1);
  /// Whether all stages have ended.
  bool done() const;

  /// The state at the present instant; positions and forces are consistent. Its spans are valid until the next step;
  /// keep() makes them last.
  const World& world() const;
  /// Keeps the memory of an array of world(): its span stays valid, with the values of this instant, as long as the
  /// result lives, also beyond the simulation, which continues in a copy.
  std::shared_ptr<const void> keep(WorldArray array);
  /// All values of the description at the start, in SI.
  Description description() const;

  /// Sets a value (SI) of the description from now on, as `change` of a stage does: of a material, interface, wall or
  /// engine, rates or servo of /domain, /time_step or /guards. Setting a number again is cheap enough for every step.
  /// Throws DescriptionError for another pointer, a value out of range, and one without effect from now on; nothing has
  /// changed then. Throws Error if the simulation is done.
  void set(const std::string& pointer, const Description& value);

  /// Adds an engine of the program to those of the description, from now on and on all bodies; replaces one that was
  /// added by this name; null removes it. It is no part of the description: add it again before resume(). An exception
  /// of Engine::forces() ends a step midway. Throws Error for the name of an engine of the description, for an engine
  /// that needs state which is not kept (SimulationOptions::state), and if the simulation is done.
  void set_engine(const std::string& name, std::shared_ptr<Engine> engine);

  using Observer = std::function<void(const World&)>;
  /// Calls an observer at the start of each stage and then at this interval of simulated time [s], or of steps.
  void every_time(double seconds, Observer observer);
  void every_steps(std::uint64_t steps, Observer observer);
  /// Calls an observer at the end of each stage.
  void at_stage_end(Observer observer);
  /// Calls `report` while stages run, at most once per `interval` [s] of wall-clock time.
  void on_progress(std::function<void(const Progress&)> report, double interval = 0.2);
  /// Calls `keep` with a checkpoint while stages run: every `interval` [s] of wall-clock time, less often where saving
  /// would take more than 1 % of the time, and where the simulation is interrupted. 0: only there.
  void on_checkpoint(std::function<void(const Checkpoint&)> keep, double interval);
  /// Evaluates a condition between steps; the run is interrupted when it is true.
  void interrupt_when(std::function<bool()> condition);

  /// The complete state, from which a run continues with identical results; also of a simulation that is done.
  Checkpoint save();
  /// Continues from the saved state of a simulation of the same description, which is not checked. Forces are known
  /// after the next step, or after step(0). Throws Error for a state that does not fit the description, and for a
  /// simulation that has started.
  void resume(const Checkpoint& checkpoint);

  /// For the library itself: how it is put together.
  struct Parts;
  explicit Simulation(std::unique_ptr<Parts> parts);
  Parts& parts() { return *parts_; }

 private:
  std::unique_ptr<Parts> parts_;
};

}  // namespace grit
