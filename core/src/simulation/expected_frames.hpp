// The number of frames that a description asks for.
#pragma once

#include <optional>
#include <vector>

#include "description/description.hpp"
#include "simulation/expected_stages.hpp"

namespace grit {

/// Bounds of the time step [s].
struct TimeStepBounds {
  double least, most;
};

struct ExpectedFrames {
  /// Number, if no stage lasts longer than its condition requires.
  double least = 0;
  /// The same with the durations that `grit check` shows; nothing if it does not follow from time.
  std::optional<double> shown = 0;
  /// Whether `shown` is an upper bound.
  bool at_most = false;
};
ExpectedFrames expected_frames(const SceneDescription& scene, const std::vector<ExpectedStage>& stages,
                               const TimeStepBounds& dt);

}  // namespace grit
