#include "simulation/needed_memory.hpp"

#include <map>
#include <optional>
#include <string>

#include "bodies/body_memory.hpp"
#include "bodies/make_bodies.hpp"
#include "format/resources.hpp"

namespace grit {
namespace {

/// Bodies that exist at the same time, and the group that has most of them.
struct Together {
  double bodies = 0, of_largest = 0;
  std::string largest;
};

}  // namespace

void check_memory(const SceneDescription& scene, const Components& components, const ReportFault& report) {
  std::map<std::string, Together> by_stage;
  for (const auto& [name, group] : scene.bodies) {
    const auto kind = components.body_kinds.find(name);
    if (kind == components.body_kinds.end() || kind->second == nullptr) continue;
    const std::optional<std::size_t> count = described_count(scene, name, *kind->second);
    if (!count) continue;
    Together& together = by_stage[group.stage];
    const auto bodies = static_cast<double>(*count);
    together.bodies += bodies;
    if (bodies > together.of_largest) together.of_largest = bodies, together.largest = name;
  }
  const double available = available_memory();
  for (const auto& [stage, together] : by_stage)
    if (const std::string fault = memory_fault(together.bodies, available); !fault.empty())
      report({"bodies", together.largest, "source"}, fault);
}

}  // namespace grit
