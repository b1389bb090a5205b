#include "lint/excess_depth.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "description/wall_ways.hpp"
#include "lint/all_stages.hpp"
#include "lint/installed_studies.hpp"
#include "study/parts.hpp"

namespace grit {
namespace {

constexpr double tolerance = 0.05;  // of a study's metrics
constexpr double far_beyond = 2;    // excess of depth, or of cost, that is reported
// For a dense packing with five contacts per body; means over contacts scatter between samples by about 1/√contacts.
constexpr double contacts_a_body = 2.5, fine_scatter = 0.005;
constexpr double fewest_diameters = 5, fewest_between_panes = 10;

bool is_resolved(const Evidence& level) {
  return std::ranges::any_of(level.findings, [](const Finding& one) { return !(one.error <= 2 * one.standard_error); });
}

/// Sets `tried` if a study knows this depth.
std::optional<UnusedSetting> by_studies(std::vector<EvaluatedStudy> studies, const std::string& scenario,
                                        const std::vector<std::string>& parts,
                                        const std::function<bool(const std::vector<std::string>&)>& same, bool& tried) {
  for (EvaluatedStudy& study : studies) {
    if (!is_of(study, scenario, parts)) continue;
    std::erase_if(study.settings, [](const auto& setting) { return setting.first != "depth"; });
    for (const Advice& advice : advise(study, tolerance, same)) {
      if (advice.now == nullptr) continue;
      tried = true;
      const auto& levels = study.settings.at(advice.setting);
      for (const Evidence* one : advice.cheaper) {
        if (!one->known || one->findings.empty() || advice.now->sets.empty() || is_resolved(*one) ||
            least_sure(levels, *one, tolerance).confidence(tolerance) > Confidence::likely)
          continue;
        const double saved = advice.now->cost / one->cost;
        if (saved < far_beyond) continue;
        const Finding& finding = *one->decisive(tolerance);
        const std::string& set = advice.now->sets.front();
        return UnusedSetting{
            set.substr(0, set.find('=')),
            fmt::format(
                "{} deep; by \"{}\" {} changes {} by {:.1f} ± {:.1f} %, which is within the scatter between samples, "
                "and is {:.1f} times cheaper",
                advice.now->level, study.title, one->level, finding.metric, 100 * finding.error,
                100 * finding.standard_error, saved)};
      }
    }
  }
  return std::nullopt;
}

/// The depth of a scene that does not vary along it.
struct Depth {
  double length = 0;  ///< m
  double fewest = 0;  ///< minimum, in diameters
  std::string pointer, why;
};

/// Whether a wall is at rest and frictionless in all stages.
bool is_still_and_smooth(const Scene& described, const std::string& name) {
  return always_by_law(described, [&](const SceneDescription& scene, const ContactLaw& law) {
    if (!scene.walls.contains(name)) return false;
    const WallDescription& wall = scene.walls.at(name);
    const auto names = material_names(scene);
    const auto number = [&](const std::string& material) {
      return static_cast<std::size_t>(std::ranges::find(names, material) - names.begin());
    };
    const PairSize grain{
        .radius_a = 1e-3, .radius_b = 1e-3, .inverse_mass_a = 1e5, .inverse_mass_b = 0, .overlap = 1e-6, .wall = true};
    return stands_still(wall.motion) && std::ranges::all_of(scene.bodies, [&](const auto& group) {
             return law.stiffness(grain, number(group.second.material), number(wall.material)).shear == 0;
           });
  });
}

bool has_gravity_along(const Scene& described, int axis) {
  return !always_by_engines(described, [&](const SceneDescription& now, const EngineMap& engines) {
    return all_settings(now, engines, [&](const MotionSettings& group) { return group.gravity[axis] == 0; });
  });
}

/// Whether bodies fill the cell along this axis from the start, between planes parallel to it. Scenarios are known to.
bool is_alike_along(const SceneDescription& scene, const World& world, int axis) {
  const auto walls = world.walls();
  const bool planes =
      std::ranges::all_of(scene.walls, [](const auto& wall) { return wall.second.geometry.type() == "plane"; }) &&
      std::ranges::all_of(walls, [&](const WallView& wall) { return std::abs(wall.normal[axis]) < 1e-9; });
  const bool later =
      std::ranges::any_of(scene.bodies, [](const auto& group) { return !group.second.stage.empty(); }) ||
      std::ranges::any_of(scene.stages, [](const auto& stage) { return stage.change.contains("walls"); });
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Row& x : world.positions())
    low = std::min(low, xyz(x)[axis] - x.w), high = std::max(high, xyz(x)[axis] + x.w);
  const double margin = 2 * world.mean_diameter();
  return planes && !later && low < world.cell().low[axis] + margin && high > world.cell().high[axis] - margin;
}

std::optional<Depth> depth_of(const Scene& described, const World& world, bool plain) {
  const SceneDescription& scene = *described.description;
  const auto& periodic = scene.domain.periodic;
  const std::string scenarios = "/scenario/depth";  // a scenario writes domain and walls
  if (std::ranges::count(periodic, true) == 1) {
    const auto axis = static_cast<int>(std::ranges::find(periodic, true) - periodic.begin());
    if (has_gravity_along(described, axis) || (plain && !is_alike_along(scene, world, axis))) return std::nullopt;
    return Depth{world.cell().high[axis] - world.cell().low[axis], fewest_diameters,
                 plain ? fmt::format("/domain/high/{}", axis) : scenarios,
                 fmt::format("the cell is periodic along {}", "xyz"[axis])};
  }
  constexpr int axis = 1;
  const Region specimen = world.specimen();
  const double size = specimen.high[axis] - specimen.low[axis];
  if (plain || std::ranges::count(periodic, true) > 0 || !std::isfinite(size) || world.positions().empty() ||
      has_gravity_along(described, axis))
    return std::nullopt;
  Vec3 inside = xyz(world.positions().front());
  inside[axis] = specimen.low[axis] + 0.5 * size;
  std::string low, high;
  double length = 0;
  const auto walls = world.walls();
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const double along = walls[w].normal[axis];
    std::string& name = along > 0 ? low : high;
    if (std::abs(along) < 1 - 1e-9 || !name.empty() || !is_still_and_smooth(described, walls[w].name)) continue;
    if (const auto clear = world.clearance(w, inside, size)) name = walls[w].name, length += clear->distance;
  }
  if (low.empty() || high.empty()) return std::nullopt;
  return Depth{length, fewest_between_panes, scenarios,
               fmt::format("its walls \"{}\" and \"{}\" along y are at rest and frictionless", low, high)};
}

std::optional<UnusedSetting> by_contacts(const Scene& described, const Components& components, const World& world,
                                         bool plain) {
  const SceneDescription& scene = *described.description;
  if (scene.domain.deforms()) return std::nullopt;
  const auto depth = depth_of(described, world, plain);
  if (!depth || !std::isfinite(depth->length)) return std::nullopt;
  std::size_t bodies = world.positions().size();
  for (const auto& [name, group] : scene.bodies)
    if (!group.stage.empty()) bodies += body_count(*described.description, name, components.body_kinds.at(name));
  const double contacts = contacts_a_body * static_cast<double>(bodies);
  const double fraction =
      std::max(1 / (fine_scatter * fine_scatter) / contacts, depth->fewest * world.mean_diameter() / depth->length);
  if (fraction * far_beyond > 1) return std::nullopt;
  return UnusedSetting{
      depth->pointer,
      fmt::format("{}; a depth of {:.2g} m has about {:.0f} contacts, so that means scatter between samples by about "
                  "1/√contacts = {:.2g} %; {:.2g} m would give {:.2g} % at {:.2g} of the cost",
                  depth->why, depth->length, contacts, 100 / std::sqrt(contacts), fraction * depth->length,
                  100 / std::sqrt(fraction * contacts), fraction)};
}

}  // namespace

std::optional<UnusedSetting> excess_depth(const Scene& described, const Components& components, const World& world,
                                          const std::string& scenario, const std::vector<EvaluatedStudy>& studies,
                                          const std::function<bool(const std::vector<std::string>&)>& same) {
  const SceneDescription& scene = *described.description;
  bool tried = false;
  auto line = by_studies(studies, scenario, parts_of(resolved(scene)), same, tried);
  if (!line && !tried) line = by_contacts(described, components, world, scenario.empty());
  return line;
}

}  // namespace grit
