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

constexpr double tolerance = 0.05;  // of a study's figures
constexpr double far_beyond = 2;    // times as deep, or as costly, as would do
// Of a dense packing, with five contacts each; means of them scatter between samples by about 1/√contacts.
constexpr double contacts_a_body = 2.5, fine_scatter = 0.005;
constexpr double fewest_diameters = 5, fewest_between_panes = 10;

bool shows(const Evidence& level) {
  return std::ranges::any_of(level.findings, [](const Finding& one) { return !(one.error <= 2 * one.standard_error); });
}

/// Sets `tried` if a study knows this depth.
std::optional<std::string> by_studies(std::vector<ChartedStudy> studies, const std::string& scenario,
                                      const std::vector<std::string>& parts,
                                      const std::function<bool(const std::vector<std::string>&)>& same, bool& tried) {
  for (ChartedStudy& study : studies) {
    if (!is_of(study, scenario, parts)) continue;
    std::erase_if(study.settings, [](const auto& setting) { return setting.first != "depth"; });
    for (const Advice& advice : advise(study, tolerance, same)) {
      if (advice.now == nullptr) continue;
      tried = true;
      const auto& levels = study.settings.at(advice.setting);
      for (const Evidence* one : advice.cheaper) {
        if (!one->known || one->findings.empty() || advice.now->sets.empty() || shows(*one) ||
            least_sure(levels, *one, tolerance).confidence(tolerance) > Confidence::likely)
          continue;
        const double saved = advice.now->cost / one->cost;
        if (saved < far_beyond) continue;
        const Finding& finding = *one->decisive(tolerance);
        const std::string& set = advice.now->sets.front();
        return fmt::format(
            "{}: {} deep; by \"{}\" {} changes {} by {:.1f} ± {:.1f} %, which is within what samples scatter, and is "
            "{:.1f} times cheaper",
            set.substr(0, set.find('=')), advice.now->level, study.title, one->level, finding.figure,
            100 * finding.error, 100 * finding.standard_error, saved);
      }
    }
  }
  return std::nullopt;
}

/// What a specimen is deep along, as nothing differs along it.
struct Depth {
  double length = 0;  ///< m
  double fewest = 0;  ///< diameters that it needs
  std::string pointer, why;
};

/// Whether a wall neither moves nor drags grains, in any stage.
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

bool weighs_along(const Scene& described, int axis) {
  return !always_by_engines(described, [&](const SceneDescription&, const EngineMap& engines) {
    return settings_of(engines).gravity[axis] == 0;
  });
}

/// Whether grains lie from one end of the cell to the other, between planes that go on along this axis, from the start.
/// Of a scenario it is known.
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
  const double room = 2 * world.mean_diameter();
  return planes && !later && low < world.cell().low[axis] + room && high > world.cell().high[axis] - room;
}

std::optional<Depth> depth_of(const Scene& described, const World& world, bool plain) {
  const SceneDescription& scene = *described.description;
  const auto& periodic = scene.domain.periodic;
  const std::string scenarios = "/scenario/depth";  // a scenario writes domain and walls
  if (std::ranges::count(periodic, true) == 1) {
    const auto axis = static_cast<int>(std::ranges::find(periodic, true) - periodic.begin());
    if (weighs_along(described, axis) || (plain && !is_alike_along(scene, world, axis))) return std::nullopt;
    return Depth{world.cell().high[axis] - world.cell().low[axis], fewest_diameters,
                 plain ? fmt::format("/domain/high/{}", axis) : scenarios,
                 fmt::format("the cell repeats along {}", "xyz"[axis])};
  }
  constexpr int axis = 1;
  const Region specimen = world.specimen();
  const double size = specimen.high[axis] - specimen.low[axis];
  if (plain || std::ranges::count(periodic, true) > 0 || !std::isfinite(size) || world.positions().empty() ||
      weighs_along(described, axis))
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
               fmt::format("walls \"{}\" and \"{}\", which bound it along y, stand still and are smooth", low, high)};
}

std::optional<std::string> by_contacts(const Scene& described, const Components& components, const World& world,
                                       bool plain) {
  const SceneDescription& scene = *described.description;
  if (!scene.domain.strain_rate.isZero(0.0)) return std::nullopt;
  const auto depth = depth_of(described, world, plain);
  if (!depth || !std::isfinite(depth->length)) return std::nullopt;
  std::size_t bodies = world.positions().size();
  for (const auto& [name, group] : scene.bodies)
    if (!group.stage.empty()) bodies += body_count(group, *components.body_kinds.at(name));
  const double contacts = contacts_a_body * static_cast<double>(bodies);
  const double share =
      std::max(1 / (fine_scatter * fine_scatter) / contacts, depth->fewest * world.mean_diameter() / depth->length);
  if (share * far_beyond > 1) return std::nullopt;
  return fmt::format(
      "{}: {}, and with {:.2g} m there are some {:.0f} contacts, whose means scatter between samples by about "
      "1/√contacts, {:.2g} %; {:.2g} m would give {:.2g} % for {:.2g} of the cost",
      depth->pointer, depth->why, depth->length, contacts, 100 / std::sqrt(contacts), share * depth->length,
      100 / std::sqrt(share * contacts), share);
}

}  // namespace

std::optional<std::string> excess_depth(const Scene& described, const Components& components, const World& world,
                                        const std::string& scenario, const std::vector<ChartedStudy>& studies,
                                        const std::function<bool(const std::vector<std::string>&)>& same) {
  const SceneDescription& scene = *described.description;
  bool tried = false;
  auto line = by_studies(studies, scenario, parts_of(resolved(scene)), same, tried);
  if (!line && !tried) line = by_contacts(described, components, world, scenario.empty());
  return line;
}

}  // namespace grit
