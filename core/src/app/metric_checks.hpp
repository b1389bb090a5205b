// Whether a scene has what the metrics of its runs need.
#pragma once

#include <map>
#include <string>

#include "input/document.hpp"
#include "plugins/registry.hpp"
#include "simulation/live_scene.hpp"
#include "study/description.hpp"

namespace grit {

/// Metrics, and where they are written.
struct MetricsToCheck {
  const std::map<std::string, MetricDescription>* metrics;
  const Document* written;
  std::string section;  ///< pointer of the object of metrics
};

/// Checks reference files of the metrics before any run. Throws DescriptionError.
void check_curves(const MetricsToCheck& of);

/// Checks probes of the metrics. Throws DescriptionError.
void check_probes(const MetricsToCheck& of, const SceneDescription& scene);

/// Checks channels, and values in their units, which probes know only once they are bound to a world. Returns the unit
/// of each as PROBE/CHANNEL; none if the scene fails at once, which other values may not. Throws DescriptionError.
std::map<std::string, std::string> check_channels(const MetricsToCheck& of, const LiveScene& live,
                                                  const Registry& registry);

}  // namespace grit
