// Reports of a run in progress. The run uses this interface; output/ implements it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "grit/archive.hpp"
#include "grit/error.hpp"
#include "grit/probe.hpp"
#include "grit/world.hpp"
#include "kernel/model.hpp"
#include "kernel/sharing.hpp"

namespace grit {

/// Above this void ratio the specimen is nearly empty, as with a heap on a wide floor, and its state is not shown.
inline constexpr double most_void_ratio = 10;

/// A probe in the results: a group of series.
struct ProbeGroup {
  std::string name;  ///< of the probe in the description
  std::vector<Channel> channels;
};

/// Tables of one probe in one frame.
struct FieldGroup {
  std::string name;
  std::vector<Field> fields;
};

/// Run time of the samples of a probe.
struct ProbeTime {
  std::string name;
  std::uint64_t samples = 0;
  double seconds = 0;  ///< total, without writing
};

/// How a run ended.
struct RunSummary {
  std::string status;   ///< "done", "interrupted", "failed"
  std::string message;  ///< of the failure
  std::vector<std::string> warnings;
  Guard guard = Guard::none;  ///< the one that stopped the run
  std::string stage;          ///< the last one
  double time = 0;            ///< simulated, s
  std::uint64_t steps = 0;
  double time_step = 0, critical_time_step = 0;  ///< s, the last ones
  std::size_t bodies = 0;
  double contacts_per_body = 0;  ///< 2 × contacts / bodies, mean over the samples
  double wall_seconds = 0;       ///< of the stepping
  double particle_steps_per_second = 0;
  std::size_t rebuilds = 0;         ///< of the neighbour lists
  unsigned threads = 1, ranks = 1;  ///< threads of each rank
  std::optional<Sharing> sharing;   ///< among ranks
  std::vector<PhaseTime> phases;
  std::vector<ProbeTime> probes;
  Model model;
};

/// What was to be recorded is refused before anything of it was: the simulation can be saved, and go on from there.
class RefusedRecord : public FileError {
 public:
  using FileError::FileError;
};

class Recorder {
 public:
  virtual ~Recorder() = default;
  /// Once, before the first sample; in a resumed run after serialize() has restored the position.
  virtual void begin(const World& world, std::span<const ProbeGroup> probes) = 0;
  /// Before the forces of an instant with a frame, or at which a stage may end: throws RefusedRecord if a file is in
  /// the way of the next frame or of the last results.
  virtual void expect_room() const {}
  /// One sample of the probe with this index in begin()'s list.
  virtual void sample(std::size_t probe, const World& world, std::span<const std::span<const double>> values) = 0;
  virtual void frame(const World& world, std::span<const FieldGroup> fields) = 0;
  /// The end of a stage; `what` is the state reached, e.g. "void ratio 0.598".
  virtual void stage_ended(const World& world, const std::string& what) = 0;
  /// Before a checkpoint is saved: the records so far must survive the process.
  virtual void flush() {}
  /// Saves or restores the amount recorded; a resumed run continues there.
  virtual void serialize(Archive&) {}
  virtual void finish(const World& world, const RunSummary& summary) = 0;
};

}  // namespace grit
