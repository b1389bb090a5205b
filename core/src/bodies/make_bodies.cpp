#include "bodies/make_bodies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <typeinfo>

#include "bodies/body_memory.hpp"
#include "bodies/cloud.hpp"
#include "bodies/group_builder.hpp"
#include "bodies/lattice.hpp"
#include "bodies/orientation.hpp"
#include "bodies/packing_file.hpp"
#include "bodies/sizes.hpp"
#include "bodies/stream.hpp"
#include "bodies/whole_count.hpp"
#include "description/placed_error.hpp"
#include "format/number.hpp"
#include "format/resources.hpp"
#include "grit/error.hpp"

namespace grit {
namespace {

std::set<std::string> of_bodies(const SceneDescription& scene) {
  std::set<std::string> names;
  for (const auto& [name, group] : scene.bodies) names.insert(group.material);
  return names;
}

std::vector<PackedBody> at_rest(const std::vector<Row>& spheres) {
  std::vector<PackedBody> bodies;
  bodies.reserve(spheres.size());
  for (const Row& one : spheres) bodies.push_back({one});
  return bodies;
}

/// Adds a group. Clouds do not overlap the spheres of `there` and `bodies`.
void add_group(const BodiesDescription& group, const GroupBuilder& builder, const Cell& cell,
               std::span<const Row> there, Random& random, Bodies& bodies) {
  if (std::holds_alternative<StreamSource>(group.source.value())) return;  // its bodies enter later
  if (const auto* placed = std::get_if<ListSource>(&group.source.value())) {
    for (const ListedBody& g : placed->bodies) {
      const double angle = g.orientation.norm();
      const Vec3 axis = angle > 0 ? Vec3(g.orientation / angle) : Vec3::UnitX();
      builder.add(bodies, g.position, g.radius, Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)),
                  group.velocity + g.velocity, g.spin);
    }
    return;
  }
  const auto grains = [&]() -> std::vector<PackedBody> {
    if (const auto* file = std::get_if<FileSource>(&group.source.value())) return read_bodies(*file);
    if (const auto* lattice = std::get_if<LatticeSource>(&group.source.value()))
      return at_rest(make_lattice(*lattice, cell));
    std::vector<Row> others(there.begin(), there.end());
    others.insert(others.end(), bodies.position.begin(), bodies.position.end());
    return at_rest(
        make_cloud(std::get<CloudSource>(group.source.value()), cell, random, others, builder.shape_diameter()));
  }();
  const ClumpShape* const clump = builder.clump();
  const std::size_t more = grains.size() * (clump != nullptr ? clump->spheres.size() : 1);
  if (const std::string fault = memory_fault(static_cast<double>(more), available_memory()); !fault.empty())
    throw Error(fault);  // of a file, of which the number was not known before
  bodies.reserve(more);
  for (const PackedBody& g : grains) {
    const Eigen::Quaterniond turn = clump != nullptr ? any_orientation(random) : Eigen::Quaterniond::Identity();
    builder.add(bodies, xyz(g.sphere), g.sphere.w, turn, group.velocity + g.velocity, g.spin);
  }
}

double smallest_radius(const BodiesDescription& group, std::optional<double> shape_diameter) {
  double smallest = std::numeric_limits<double>::infinity();
  if (const auto* placed = std::get_if<ListSource>(&group.source.value())) {
    for (const ListedBody& one : placed->bodies) smallest = std::min(smallest, one.radius);
  } else if (const auto* cloud = std::get_if<CloudSource>(&group.source.value())) {
    Random random(0);
    for (const double diameter :
         draw_diameters(cloud->sizes, static_cast<std::size_t>(cloud->count), random, shape_diameter))
      smallest = std::min(smallest, 0.5 * diameter);
  } else if (const auto* lattice = std::get_if<LatticeSource>(&group.source.value())) {
    smallest = 0.5 * lattice->diameter;
  } else if (const auto* stream = std::get_if<StreamSource>(&group.source.value())) {
    constexpr std::size_t sample = 1000;
    Random random(0);
    for (const double diameter : draw_diameters(stream->sizes, sample, random, shape_diameter))
      smallest = std::min(smallest, 0.5 * diameter);
  } else {
    for (const PackedBody& one : read_bodies(std::get<FileSource>(group.source.value())))
      smallest = std::min(smallest, one.sphere.w);
  }
  return smallest;
}

/// Throws PlacedError for bodies outside the cell, with a fault for each group.
void check_inside(const Cell& cell, const Bodies& bodies) {
  struct Outside {
    std::size_t count = 0;
    std::uint32_t clump = no_clump;  // the last one
    Row first{};
  };
  std::map<std::string, Outside> groups;
  for (std::size_t i = 0; i < bodies.count(); ++i) {
    const Row& x = bodies.position[i];
    // Only finish() adds entries for spheres after the last clump.
    const std::uint32_t c = i < bodies.clumps.of_body.size() ? bodies.clumps.of_body[i].clump : no_clump;
    const double reach = c == no_clump ? x.w : 2 * bodies.clumps.clump[c].radius;
    for (int k = 0; k < 3; ++k) {
      // Just outside a periodic side, a body is inside at the opposite side.
      const double over = cell.periodic[as_index(k)] ? reach : 0;
      if (xyz(x)[k] >= cell.low[k] - over && xyz(x)[k] <= cell.high[k] + over) continue;
      Outside& group = groups[bodies.group_of(bodies.id[i])];
      if (group.count == 0) group.first = x;
      if (c == no_clump || c != group.clump) ++group.count;
      group.clump = c;
      break;
    }
  }
  std::vector<PlacedError::Fault> faults;
  for (const auto& [name, group] : groups) {
    const std::string at =
        " at (" + number(group.first.x) + ", " + number(group.first.y) + ", " + number(group.first.z) + ") m";
    const bool one = group.count == 1;
    faults.push_back(
        {{"bodies", name},
         (one ? "a body" + at + " is" : std::to_string(group.count) + " bodies, the first" + at + ", are") +
             " outside the domain; enlarge /domain or move the " + (one ? "body" : "bodies")});
  }
  if (!faults.empty()) throw PlacedError(std::move(faults));
}

/// Reads the file of a group before the run. If it cannot be read, that is a fault of the description; later it is one
/// of the disk.
template <class Read>
auto read_at_start(const std::string& name, const BodiesDescription& group, const Read& read) {
  try {
    return read();
  } catch (const FileError& error) {
    const auto* file = std::get_if<FileSource>(&group.source.value());
    if (file == nullptr) throw;
    throw PlacedError({"bodies", name, "source", "path"}, missing_file_text(error, file->path));
  }
}

/// Runs `work` for a group. Errors get the name of the group, except errors in files, which have a line.
template <class Work>
void for_group(const std::string& name, const Work& work) {
  try {
    work();
  } catch (const ParameterError& error) {
    throw PlacedError(placed(error, {"bodies", name, "source"}));
  } catch (const Error& error) {
    if (typeid(error) != typeid(Error)) throw;
    throw PlacedError({"bodies", name}, error.what());
  }
}

/// The periodic axes of the domain that a lattice spans.
std::array<bool, 3> spanned_axes(const LatticeSource& lattice, const DomainDescription& domain) {
  std::array<bool, 3> spanned{};
  if (!domain.low || !domain.high) return spanned;
  for (int k = 0; k < 3; ++k)
    spanned[static_cast<std::size_t>(k)] = domain.periodic[static_cast<std::size_t>(k)] &&
                                           lattice.low[k] == (*domain.low)[k] && lattice.high[k] == (*domain.high)[k];
  return spanned;
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
  std::vector<std::string> names = scene.names_of_materials();
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
    const auto& kind = components.body_kinds.at(name);
    if (group.is_from_sample()) continue;
    if (group.stage.empty()) {
      bodies.groups.push_back({name, bodies.ids_given});
      read_at_start(name, group, [&] {
        for_group(name, [&] { add_group(group, GroupBuilder(scene, group, kind), cell, {}, random, bodies); });
      });
    } else {
      // Errors in files are reported now, not at the start of their stage.
      body_count(scene, name, kind);
      if (const auto* cloud = std::get_if<CloudSource>(&group.source.value()))
        for_group(name, [&] { check_region(*cloud); });
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
      add_group(group, GroupBuilder(scene, group, components.body_kinds.at(name)), cell, there, random,
                newcomers.bodies);
    });
    check_inside(cell, newcomers.bodies);
  }
  newcomers.bodies.finish(state);
  return newcomers;
}

Bodies smallest_bodies(const SceneDescription& scene, const Components& components,
                       const std::vector<std::string>& groups) {
  Bodies bodies;
  for (const std::string& name : groups) {
    const BodiesDescription& group = scene.bodies.at(name);
    const GroupBuilder builder(scene, group, components.body_kinds.at(name));
    const double radius = read_at_start(name, group, [&] { return smallest_radius(group, builder.shape_diameter()); });
    if (!std::isfinite(radius)) continue;
    for_group(name, [&] {
      builder.add(bodies, Vec3::Zero(), radius, Eigen::Quaterniond::Identity(), Vec3::Zero(), Vec3::Zero());
    });
  }
  bodies.finish({});
  return bodies;
}

std::optional<std::size_t> described_count(const SceneDescription& scene, const std::string& name,
                                           const BodyKind& kind) {
  const auto& source = scene.bodies.at(name).source.value();
  const auto spheres = kind.clump() != nullptr ? kind.clump()->spheres.size() : 1;
  if (const auto* placed = std::get_if<ListSource>(&source)) return spheres * placed->bodies.size();
  if (const auto* cloud = std::get_if<CloudSource>(&source)) return spheres * static_cast<std::size_t>(cloud->count);
  if (const auto* lattice = std::get_if<LatticeSource>(&source))
    return whole_count(static_cast<double>(spheres) * count_of_lattice(*lattice, spanned_axes(*lattice, scene.domain)));
  return std::nullopt;
}

std::size_t body_count(const SceneDescription& scene, const std::string& name,
                       const std::shared_ptr<const BodyKind>& kind) {
  const BodiesDescription& group = scene.bodies.at(name);
  if (group.is_from_sample()) return 0;
  if (const auto count = described_count(scene, name, *kind)) return *count;
  const auto spheres = kind->clump() != nullptr ? kind->clump()->spheres.size() : 1;
  if (const auto* stream = std::get_if<StreamSource>(&group.source.value()))
    return spheres * expected_count(*stream, GroupBuilder(scene, group, kind));
  const auto count = [&] { return read_bodies(std::get<FileSource>(group.source.value())).size(); };
  return spheres * read_at_start(name, group, count);
}

}  // namespace grit
