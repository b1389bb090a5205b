#include "simulation/expected_frames.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>

namespace grit {
namespace {

/// Frames of a stage of this duration [s] and number of steps, without that at its end, which is the first of the next.
double frames_of(const Cadence& cadence, double duration, double steps) {
  double frames = 0;
  if (cadence.every_time) frames = std::min(duration / *cadence.every_time, steps);
  if (cadence.every_steps > 0) frames = std::max(frames, steps / static_cast<double>(cadence.every_steps));
  return std::isfinite(frames) ? std::max(1.0, std::ceil(frames - 1e-9)) : 1;
}

}  // namespace

ExpectedFrames expected_frames(const SceneDescription& scene, const std::vector<ExpectedStage>& stages,
                               const TimeStepBounds& dt) {
  if (scene.output.frames.never()) return {};
  const Cadence& cadence = scene.output.frames;
  ExpectedFrames all{1, 1};  // at the end
  if (cadence.never()) return all;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const ExpectedStage& stage = stages[i];
    const auto* counted = std::get_if<StepsCondition>(&scene.stages[i].until.is.value());
    const auto frames = [&](double duration) {
      return frames_of(cadence, duration,
                       counted != nullptr ? static_cast<double>(counted->value) : duration / dt.most);
    };
    all.least += frames(stage.known || !stage.usual ? stage.least : 0);
    *all.shown += frames(stage.shown());
    all.at_most |= !stage.known && !stage.usual;
  }
  if (cadence.every_displacement || cadence.every_discharged) all.shown.reset();
  return all;
}

}  // namespace grit
