// Bodies that enter during a run.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "bodies/group_builder.hpp"
#include "bodies/stream.hpp"
#include "description/components.hpp"
#include "kernel/state.hpp"

namespace grit {

/// The streams of a description.
class Inflow {
 public:
  /// Throws PlacedError for a region outside the domain, or narrower than the largest body.
  Inflow(const SceneDescription& scene, const Components& components);

  /// Begins the streams of this stage, and at the first stage those without one.
  void begin_stage(const std::string& stage, double time);
  /// Whether bodies enter at this time [s].
  bool due(double time);
  /// Bodies that enter now: at random positions where they overlap nothing. Those without room wait.
  Bodies enter(const State& state, const World& world);
  /// Names of streams whose bodies wait, and their number; empty if there is none.
  std::string waiting() const;
  /// Advice for each stream of which many bodies wait.
  std::vector<std::string> blocked() const;

  void serialize(Archive& archive);

 private:
  struct Entry {
    std::string stage;
    Vec3 velocity;
    GroupBuilder builder;
    Stream stream;
  };
  /// Whether there is room for the next body of a stream, which is then among `entering`.
  static bool enter_one(const std::string& name, Entry& entry, const State& state, const World& world,
                        Bodies& entering);

  std::map<std::string, Entry> entries_;  // by name of the group
};

}  // namespace grit
