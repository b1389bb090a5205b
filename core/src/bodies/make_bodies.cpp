#include "bodies/make_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <typeinfo>

#include "bodies/cloud.hpp"
#include "bodies/packing_file.hpp"
#include "description/placed_error.hpp"
#include "grit/error.hpp"

namespace grit {
namespace {

/// Random orientation, uniformly distributed (K. Shoemake, Graphics Gems III (1992) 124,
/// doi:10.1016/B978-0-08-050755-2.50036-1).
Eigen::Quaterniond any_orientation(Random& random) {
  const double u = random.uniform(), a = 2 * std::numbers::pi * random.uniform(),
               b = 2 * std::numbers::pi * random.uniform();
  const double p = std::sqrt(1 - u), q = std::sqrt(u);
  return {p * std::sin(a), p * std::cos(a), q * std::sin(b), q * std::cos(b)};
}

std::set<std::string> of_bodies(const SceneDescription& scene) {
  std::set<std::string> names;
  for (const auto& [name, group] : scene.bodies) names.insert(group.material);
  return names;
}

/// Adds a group. Clouds do not overlap the spheres of `there` and `bodies`.
void add_group(const SceneDescription& scene, const BodiesDescription& group, const BodyKind& kind, const Cell& cell,
               std::span<const Row> there, Random& random, Bodies& bodies) {
  const auto names = material_names(scene);
  const auto material =
      static_cast<std::uint8_t>(std::find(names.begin(), names.end(), group.material) - names.begin());
  const double density = scene.materials.at(group.material).density;
  const ClumpShape* const clump = kind.clump();
  const auto add = [&](const Vec3& centre, double radius, const Eigen::Quaterniond& turn, const Vec3& velocity,
                       const Vec3& spin) {
    const double inert = std::max(radius, 0.5 * group.scaled_below());
    const double mass = density * kind.volume(inert);
    if (clump == nullptr) {
      bodies.add(centre, radius, mass, kind.inertia(inert, mass), material, velocity, spin);
      return;
    }
    const Eigen::Quaterniond orientation = turn * Eigen::Quaterniond(clump->axes);
    const Vec3 middle = orientation * (radius * clump->middle);
    bodies.add_clump(*clump, centre - middle, radius, mass, mass * inert * inert * clump->inertia, orientation,
                     material, velocity, spin);
  };
  if (const auto* placed = std::get_if<ListSource>(&group.source.value())) {
    for (const ListedBody& g : placed->bodies) {
      const double angle = g.orientation.norm();
      const Vec3 axis = angle > 0 ? Vec3(g.orientation / angle) : Vec3::UnitX();
      add(g.position, g.radius, Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)), group.velocity + g.velocity,
          g.spin);
    }
    return;
  }
  const auto* cloud = std::get_if<CloudSource>(&group.source.value());
  const auto* file = std::get_if<FileSource>(&group.source.value());
  std::vector<Row> others(there.begin(), there.end());
  others.insert(others.end(), bodies.position.begin(), bodies.position.end());
  const auto grains = cloud != nullptr ? make_cloud(*cloud, cell, random, others) : read_packing(file->path);
  bodies.reserve(grains.size() * (clump != nullptr ? clump->spheres.size() : 1));
  for (const Row& g : grains) {
    const Eigen::Quaterniond turn = clump != nullptr ? any_orientation(random) : Eigen::Quaterniond::Identity();
    add(xyz(g), g.w, turn, group.velocity, Vec3::Zero());
  }
}

/// Throws PlacedError for a body outside the cell.
void check_inside(const Cell& cell, const Bodies& bodies) {
  for (std::size_t i = 0; i < bodies.count(); ++i) {
    const Row& x = bodies.position[i];
    // Only finish() adds entries for spheres after the last clump.
    const std::uint32_t c = i < bodies.clumps.of_body.size() ? bodies.clumps.of_body[i].clump : no_clump;
    const double reach = c == no_clump ? x.w : 2 * bodies.clumps.clump[c].radius;
    for (int k = 0; k < 3; ++k) {
      const double over =
          cell.periodic[k] ? reach : 0;  // just outside a periodic side, a body is inside at the opposite side
      if (xyz(x)[k] >= cell.low[k] - over && xyz(x)[k] <= cell.high[k] + over) continue;
      throw PlacedError({"bodies", bodies.group_of(bodies.id[i])},
                        "a body at (" + std::to_string(x.x) + ", " + std::to_string(x.y) + ", " + std::to_string(x.z) +
                            ") m is outside the domain; enlarge /domain or move the body");
    }
  }
}

/// Runs `work` for a group. Errors get the name of the group, except errors in files, which have a line.
template <class Work>
void for_group(const std::string& name, const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    if (typeid(error) != typeid(Error)) throw;
    throw PlacedError({"bodies", name}, error.what());
  }
}

/// A separate random stream for each stage, so that the bodies of a stage do not depend on other stages.
Random random_of(const SceneDescription& scene, const std::string& stage) {
  Random seeds(static_cast<std::uint64_t>(scene.seed));
  for (const StageDescription& one : scene.stages) {
    const std::uint64_t seed = seeds.bits();
    if (one.name == stage) return Random(seed);
  }
  return seeds;
}

}  // namespace

StateRequest requested_state(const Components& components, StateRequest also) {
  for (const auto& [name, probe] : components.probes) also = also | probe->needs();
  for (const auto& [name, engine] : components.engines) also = also | engine->needs();
  return also;
}

std::vector<std::string> material_names(const SceneDescription& scene) {
  std::vector<std::string> names;
  for (const auto& [name, material] : scene.materials) names.push_back(name);
  std::stable_partition(names.begin(), names.end(),
                        [of_bodies = of_bodies(scene)](const std::string& name) { return of_bodies.contains(name); });
  return names;
}

std::size_t materials_of_bodies(const SceneDescription& scene) { return of_bodies(scene).size(); }

std::vector<std::string> materials_in_use(const SceneDescription& scene, std::vector<std::string> names) {
  std::set<std::string> used = of_bodies(scene);
  for (const auto& [name, wall] : scene.walls) used.insert(wall.material);
  if (used.empty()) return names;
  for (std::string& name : names)
    if (!used.contains(name)) name = *used.begin();
  return names;
}

Bodies make_bodies(const SceneDescription& scene, const Components& components, StateRequest state) {
  const Vec3 open = Vec3::Constant(std::numeric_limits<double>::infinity());
  const Cell cell{scene.domain.low.value_or(-open), scene.domain.high.value_or(open), scene.domain.periodic};
  Random random(static_cast<std::uint64_t>(scene.seed));
  Bodies bodies;
  for (const auto& [name, group] : scene.bodies) {
    const BodyKind& kind = *components.body_kinds.at(name);
    if (group.stage.empty()) {
      bodies.groups.push_back({name, bodies.ids_given});
      for_group(name, [&] { add_group(scene, group, kind, cell, {}, random, bodies); });
    } else {
      body_count(group, kind);  // reports errors in files now, not at the start of their stage
    }
  }
  check_inside(cell, bodies);
  bodies.finish(state);
  return bodies;
}

Newcomers make_newcomers(const SceneDescription& scene, const Components& components, const std::string& stage,
                         const Cell& cell, std::span<const Row> there, StateRequest state) {
  Newcomers newcomers;
  Random random = random_of(scene, stage);
  for (const auto& [name, group] : scene.bodies) {
    if (group.stage.empty() || group.stage != stage) continue;
    newcomers.groups.push_back({name, newcomers.bodies.ids_given, group.overlap});
    newcomers.bodies.groups.push_back({name, newcomers.bodies.ids_given});
    for_group(name, [&, &group = group] {
      add_group(scene, group, *components.body_kinds.at(name), cell, there, random, newcomers.bodies);
    });
    check_inside(cell, newcomers.bodies);
  }
  newcomers.bodies.finish(state);
  return newcomers;
}

std::size_t body_count(const BodiesDescription& group, const BodyKind& kind) {
  const auto spheres = kind.clump() != nullptr ? kind.clump()->spheres.size() : 1;
  if (const auto* placed = std::get_if<ListSource>(&group.source.value())) return spheres * placed->bodies.size();
  if (const auto* cloud = std::get_if<CloudSource>(&group.source.value()))
    return spheres * static_cast<std::size_t>(cloud->count);
  return spheres * read_packing(std::get<FileSource>(group.source.value()).path).size();
}

}  // namespace grit
