#include "output/frame_space.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <limits>
#include <system_error>

#include "contact/critical_step.hpp"
#include "description/placed_error.hpp"
#include "format/resources.hpp"
#include "grit/error.hpp"
#include "output/frame_size.hpp"
#include "simulation/mixed_law.hpp"

namespace grit {
namespace {

/// Of the frames of earlier results [bytes].
double taken_by(const std::filesystem::path& results) {
  double sum = 0;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(results / "frames", error))
    if (const auto size = entry.is_regular_file(error) ? entry.file_size(error) : 0; !error)
      sum += static_cast<double>(size);
  return sum;
}

}  // namespace

void check_disk(const ExpectedFrames& frames, double bytes, const std::filesystem::path& results) {
  double free = available_disk(results);
  const double needed = frames.least * bytes;
  if (!(needed > free)) return;
  free += taken_by(results);  // earlier results, which are replaced
  if (!(needed > free)) return;
  throw PlacedError(
      {"output", "frames"},
      fault_text(fmt::format("at least {:.3g} frames of {} each, {} in all", frames.least, bytes_text(bytes),
                             bytes_text(needed)),
                 fmt::format("as many as fit on the disk of the results, which has {} free: use a longer interval",
                             bytes_text(free))));
}

void check_disk(const Scene& scene, const LiveScene& live, const Bodies& bodies, const std::filesystem::path& results) {
  const SceneDescription& description = *scene.description;
  if (description.output.frames.never()) return;
  const TimeStepDescription& wish = description.time_step;
  double most = wish.value.value_or(0);
  if (!wish.value) {
    MixedLaw law(description);
    law.follow(description);
    most = wish.safety * demand_without_contacts(bodies, law.law()).critical_time_step();
  }
  if (!std::isfinite(most) || !(most > 0)) most = std::numeric_limits<double>::infinity();
  // Contacts, impacts and speeds may shorten it.
  constexpr double shortest = 0.05;
  const TimeStepBounds dt{wish.value ? most : std::isfinite(most) ? shortest * most : 0, most};
  const auto count = static_cast<double>(bodies.count());
  const auto stages = expected_stages(scene, live.components(), bodies.count(), dt.least);
  check_disk(expected_frames(description, stages, dt), least_frame_bytes(count, bodies.state), results);
}

}  // namespace grit
