// A simulation as a library: opened from a description, run by stages or steps, observed, changed, saved and resumed.
//
//   grit::Simulation simulation = grit::Simulation::open("box.json");
//   simulation.every_time(1e-3, [](const grit::World& world) { … });
//   simulation.run();
//
// Nothing here prints or exits. What goes wrong is thrown as one of the errors of grit/error.hpp.
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

struct SimulationOptions {
  unsigned threads = 1;           ///< results are the same bits for any number
  std::vector<std::string> sets;  ///< changes of the description, "/pointer=value", applied in order
  /// Folders that are searched for plugins first; then come those of GRIT_PLUGIN_PATH and those beside the library.
  std::vector<std::string> plugin_path;
};

/// How far a stage is.
struct Progress {
  std::string stage;
  std::size_t stage_number = 0, stages = 0;  ///< from 1
  std::optional<double> fraction;            ///< of the stage, 0 … 1, where its end can be foreseen
  std::optional<double> seconds_left;        ///< of the stage, computing time
  double time = 0;                           ///< simulated [s]
  double particle_steps_per_second = 0;      ///< lately
};

/// What a run takes, found without running it.
struct Forecast {
  std::size_t bodies = 0;         ///< at the start; each sphere of a clump is one
  std::size_t contacts = 0;       ///< between bodies, at the start
  double time_step = 0;           ///< s, at the start
  double critical_time_step = 0;  ///< s, at the start
  std::size_t bytes = 0;          ///< held by bodies and contacts at the start
};

class Simulation {
 public:
  /// Reads a description with all that it extends, and makes its bodies, walls and components. Throws DescriptionError
  /// with every problem, each with file, line and pointer; FileError; PluginError.
  static Simulation open(const std::filesystem::path& file, const SimulationOptions& options = {});
  /// The same for the text of a description; relative paths in it start in the working directory. `name` stands for the
  /// file in messages.
  static Simulation from_text(const std::string& text, const SimulationOptions& options = {},
                              const std::string& name = "description");
  /// The same for a description that a program made.
  explicit Simulation(const Description& description, const SimulationOptions& options = {});
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  /// Finds the forces of the first instant, and what the run takes. Throws DescriptionError for what shows only then:
  /// bodies that overlap too much, a time step above the critical one, a channel that no probe has.
  Forecast check();

  /// Runs the present stage to its end, then begins the next one, if any. Returns false if it was interrupted, between
  /// two steps. Throws NumericsError if a guard trips or the stage does not end within its limit.
  bool run_stage();
  /// Runs all stages that are left. Returns false if it was interrupted.
  bool run();
  /// Takes so many steps, through the ends of stages, until the last stage ends. Returns how many were taken.
  std::uint64_t step(std::uint64_t steps = 1);
  /// Whether all stages have ended.
  bool done() const;

  /// The world at the present instant, positions and forces belonging together.
  const World& world() const;
  /// All values of the description at the start, in SI.
  Description description() const;

  /// Sets a value of the description from now on, as a stage's `change` does: of a material, interface, wall, engine,
  /// /domain/strain_rate, /time_step or /guards. Throws DescriptionError.
  void set(const std::string& pointer, const Description& value);

  using Observer = std::function<void(const World&)>;
  /// Calls an observer at the start of each stage and every so many seconds of simulated time, or steps, after it.
  void every_time(double seconds, Observer observer);
  void every_steps(std::uint64_t steps, Observer observer);
  /// Calls an observer at the end of each stage.
  void at_stage_end(Observer observer);
  /// Calls `report` now and then while stages run, at most every `interval` [s] of wall-clock time.
  void on_progress(std::function<void(const Progress&)> report, double interval = 0.2);
  /// Asks between two steps whether to stop.
  void interrupt_when(std::function<bool()> condition);

  /// All that is needed to go on to the same bits.
  Checkpoint save();
  /// Goes on where a simulation of the same description was saved. Throws Error for another description.
  void resume(const Checkpoint& checkpoint);

 private:
  struct Parts;
  explicit Simulation(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace grit
