// What a description announces of its stages: how long they last and how many bodies there are, for estimates.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "input/scene.hpp"
#include "simulation/live_components.hpp"

namespace grit {

/// The shortest and the longest possible duration [s].
struct Durations {
  double least = 0, most = std::numeric_limits<double>::infinity();
};
/// When a condition is met at the earliest and at the latest, in time steps of `dt` [s].
Durations duration_until(const Condition& condition, const SceneDescription& scene, double dt);

/// Throws NumericsError if time never reaches `end` [s], the end of the stage with this name and index, in steps of
/// `dt` [s], since double precision cannot add them.
void check_end(const std::string& stage, std::size_t index, double end, double dt);
/// The same for all stages at their earliest ends, in time steps of `dt` [s] where none is prescribed.
void check_ends(const Scene& scene, double dt);

struct ExpectedStage {
  /// Bodies that appear at its start, apart from those of streams.
  std::size_t arriving = 0;
  /// Time step: the prescribed one of the stage, or the one expected [s].
  double dt = 0;
  /// Whether the duration follows from the description.
  bool known = false;
  /// Otherwise, whether the description gives its typical duration.
  bool usual = false;
  /// Simulated duration [s]. `least`: the known or typical one; otherwise as long as the condition cannot be met.
  double least = 0, most = 0;
  /// The known or typical duration, or the longest [s].
  double shown() const { return known || usual ? least : most; }
  /// The same in time steps.
  double shown_steps() const { return shown() / dt; }
  /// Integral of the number of bodies over the duration [s]. Bodies that leave are not subtracted.
  double least_body_time = 0, most_body_time = 0;
  /// Number of bodies at its end, after shown().
  double bodies = 0;
};

/// A stream of a description; each sphere of a clump is one body.
struct ExpectedStream {
  std::string name;   ///< of the group
  std::string stage;  ///< in which it begins
  double rate = 0;    ///< 1/s; of a rate by mass, with the mean mass of its bodies
  double limit = 0;   ///< number of bodies; infinite if nothing limits it
  /// Number of bodies after `time` [s].
  double entered(double time) const;
  /// Its integral from `begin` to `end` [s].
  double body_time(double begin, double end) const;
};

/// In the order of the names of their groups. Those without a stage begin with the first one.
std::vector<ExpectedStream> expected_streams(const SceneDescription& scene, const Components& components);

/// All stages of a run that begins with `bodies` bodies, apart from those of its streams, in time steps of `dt` [s]
/// where none is prescribed.
std::vector<ExpectedStage> expected_stages(const Scene& scene, const Components& components, std::size_t bodies,
                                           double dt);

}  // namespace grit
