// What a run reports while it goes. The run knows this interface; output/ fills it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "grit/checkpoint.hpp"
#include "grit/error.hpp"
#include "grit/memory.hpp"
#include "grit/probe.hpp"
#include "grit/world.hpp"
#include "kernel/model.hpp"

namespace grit {

/// A probe as the results know it: a group of series.
struct ProbeGroup {
  std::string name;  ///< the description's name of the probe
  std::vector<Channel> channels;
};

/// Tables of one probe in one frame.
struct FieldGroup {
  std::string name;
  std::vector<Field> fields;
};

/// What the samples of a probe cost.
struct ProbeTime {
  std::string name;
  std::uint64_t samples = 0;
  double seconds = 0;  ///< of all of them together, without writing them
};

/// How a run ended.
struct RunSummary {
  std::string status;         ///< "done", "interrupted", "failed"
  std::string message;        ///< of the failure
  Guard guard = Guard::none;  ///< that tripped
  std::string stage;          ///< the last one
  double time = 0;            ///< simulated, s
  std::uint64_t steps = 0;
  double time_step = 0, critical_time_step = 0;  ///< s, the last ones
  std::size_t bodies = 0;
  double contacts_per_body = 0;  ///< 2 × touching pairs / bodies, mean over the samples
  double wall_seconds = 0;       ///< of the stepping
  double particle_steps_per_second = 0;
  std::size_t rebuilds = 0;  ///< of the neighbour lists
  unsigned threads = 1;
  std::vector<PhaseTime> phases;
  std::vector<ProbeTime> probes;
  Model model;
};

class Recorder {
 public:
  virtual ~Recorder() = default;
  /// Once, before the first sample; of a run that goes on after remember() has restored how far it was.
  virtual void begin(const World& world, std::span<const ProbeGroup> probes) = 0;
  /// One sample of the probe with this place in begin()'s list.
  virtual void sample(std::size_t probe, const World& world, std::span<const std::span<const double>> values) = 0;
  virtual void frame(const World& world, std::span<const FieldGroup> fields) = 0;
  /// A stage ended; what it reached, e.g. "void ratio 0.598".
  virtual void stage_ended(const World& world, const std::string& what) = 0;
  /// Before a checkpoint is saved: what was recorded so far must outlive the process.
  virtual void flush() {}
  /// Names how much was recorded; a run that goes on continues there.
  virtual void remember(Memory&) {}
  virtual void checkpoint(const Checkpoint&) {}
  virtual void finish(const World& world, const RunSummary& summary) = 0;
};

}  // namespace grit
