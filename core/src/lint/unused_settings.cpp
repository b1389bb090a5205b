#include "lint/unused_settings.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "description/wall_ways.hpp"
#include "lint/all_stages.hpp"
#include "study/parts.hpp"

namespace grit {
namespace {

bool is_changed(const SceneDescription& scene, const std::string& section, const std::string& name) {
  return std::ranges::any_of(scene.stages, [&](const StageDescription& stage) {
    const bool changed = stage.change.contains(section) && stage.change.at(section).contains(name);
    return changed || std::ranges::any_of(stage.ramps, [&](const RampDescription& ramp) {
             return ramp.pointer.starts_with('/' + section + '/' + name + '/');
           });
  });
}

/// Whether no possible contact has shear in any stage, so that the law omits it.
bool is_smooth(const Scene& described) {
  return always_by_law(described, [](const SceneDescription&, const ContactLaw& law) {
    return std::ranges::count(law.loop().inactive, "shear") > 0;
  });
}

/// Whether a contact parameter is 0 for all materials and interfaces throughout.
bool is_zero(const Scene& described, const std::string& key) {
  bool found = false;
  const bool zero = always(described, [&](const SceneDescription& scene) {
    const auto is_zero_of = [&](const Description& values) {
      const auto value = values.find(key);
      if (value == values.end() || value->is_null()) return true;
      found = true;
      return *value == 0.0;
    };
    return std::ranges::all_of(scene.materials, [&](const auto& one) { return is_zero_of(one.second.values); }) &&
           std::ranges::all_of(scene.interfaces, [&](const auto& one) { return is_zero_of(one.values); });
  });
  return zero && found;
}

/// Whether a wall at rest is out of reach of all bodies in the domain. Tests spheres that cover the domain.
bool is_out_of_reach(const SceneDescription& scene, const Kernel& kernel, std::size_t wall, const std::string& name) {
  const DomainDescription& domain = scene.domain;
  const bool deforms =
      domain.deforms() || std::ranges::any_of(scene.stages, [](const auto& stage) {
        return stage.change.contains("domain") || stage.growth ||
               std::ranges::any_of(stage.ramps, [](const auto& ramp) { return ramp.pointer.starts_with("/domain/"); });
      });
  if (!domain.low || !domain.high || deforms || !domain.open_sides.empty() ||
      std::ranges::any_of(scene.bodies, [](const auto& group) { return !group.second.stage.empty(); }))
    return false;
  if (!stands_still(scene.walls.at(name).motion) || is_changed(scene, "walls", name)) return false;
  const auto bodies = kernel.world().positions();
  if (bodies.empty()) return false;
  constexpr int cells = 16;
  const Vec3 low = *domain.low, step = (*domain.high - low) / double{cells};
  // Escaped bodies are found at the next neighbour search, by when they are less than a diameter outside.
  const double largest = std::ranges::max_element(bodies, {}, &Row::w)->w, reach = 0.5 * step.norm() + 3 * largest;
  const Walls& walls = kernel.state().walls;
  for (int x = 0; x < cells; ++x)
    for (int y = 0; y < cells; ++y)
      for (int z = 0; z < cells; ++z)
        if (walls.geometry(wall).near(walls.pose(wall), low + step.cwiseProduct(Vec3(x + 0.5, y + 0.5, z + 0.5)),
                                      reach))
          return false;
  return true;
}

bool of_body(const SceneDescription& scene, const std::string& material) {
  return std::ranges::any_of(scene.bodies, [&](const auto& group) { return group.second.material == material; });
}

/// Now, or by a change in a stage.
bool of_wall(const SceneDescription& scene, const std::string& material) {
  return std::ranges::any_of(scene.walls, [&](const auto& wall) { return wall.second.material == material; }) ||
         std::ranges::any_of(scene.stages, [&](const StageDescription& stage) {
           return stage.change.dump().find('"' + material + '"') != std::string::npos;
         });
}

/// Whether a body of one of two materials may touch a body or a wall of the other.
bool meet(const SceneDescription& scene, const std::string& a, const std::string& b) {
  return (of_body(scene, a) && (of_body(scene, b) || of_wall(scene, b))) || (of_body(scene, b) && of_wall(scene, a));
}

/// Maximum total duration of the stages in which a probe samples [s].
double time_of_stages(const SceneDescription& scene, const std::vector<std::string>& names) {
  double sum = 0;
  for (const StageDescription& stage : scene.stages) {
    if (!names.empty() && std::ranges::find(names, stage.name) == names.end()) continue;
    sum += longest(stage);
  }
  return sum;
}

/// Whether a body that is inserted by a stage may have an initial spin.
bool comes_spinning(const BodiesDescription& group) {
  if (group.stage.empty()) return false;
  if (std::holds_alternative<FileSource>(group.source.value())) return true;  // perhaps: it is not read for this
  const auto* placed = std::get_if<ListSource>(&group.source.value());
  return placed != nullptr &&
         std::ranges::any_of(placed->bodies, [](const ListedBody& one) { return !one.spin.isZero(0.0); });
}

/// Whether only contacts can make a sphere rotate: no engine with moments, no spinning or free wall, no clump.
bool only_contacts_turn(const Scene& described) {
  return always_by_engines(described, [](const SceneDescription& scene, const EngineMap& engines) {
    return !has_forces(engines) && std::ranges::all_of(scene.bodies, [](const auto& one) {
      return one.second.kind.type() == "sphere";
    }) && std::ranges::all_of(scene.walls, [](const auto& one) {
      const MotionDescription& motion = one.second.motion;
      return motion.spin.isZero(0.0) && motion.surface_spin.isZero(0.0) &&
             !(motion.oscillation && !motion.oscillation->angle.isZero(0.0)) && !motion.free && !motion.free_rotation;
    });
  });
}

using Say = std::function<void(const std::string& pointer, const std::string& why)>;

void find_idle_engines(const Scene& described, const Components& components, const Say& say) {
  for (const auto& [engine, instance] : components.engines) {
    const std::string& name = engine;
    const bool is_of_settings = instance->phase() == Phase::settings;
    // Compares scenes with the engine and without it; scenes that lack it are equal.
    const auto idle = [&](auto is) {
      return is_of_settings && always_by_engines(described, [&](const SceneDescription& now, const EngineMap& engines) {
               return !engines.contains(name) || std::ranges::all_of(now.bodies, [&](const auto& group) {
                 return is(settings_of(now, engines, group.first), settings_of(now, engines, group.first, name));
               });
             });
    };
    if (idle([](const MotionSettings& with, const MotionSettings& without) { return with == without; }))
      say("/engines/" + name, "it has no effect with these values");
    else if (idle([](const MotionSettings& with, MotionSettings without) {
               if (with.flat) without.gravity[*with.flat] = with.gravity[*with.flat];
               return with.flat && with == without;
             }))
      say("/engines/" + name, "bodies are held along the axis on which it acts");
  }
}

/// Why no body ever rotates; "" if one may.
std::string why_none_rotates(const Scene& described, const World& world, bool smooth) {
  const bool spun = std::ranges::any_of(world.spins(), [](const Row& w) { return !xyz(w).isZero(0.0); }) ||
                    std::ranges::any_of(described.description->bodies,
                                        [](const auto& group) { return comes_spinning(group.second); });
  if (spun) return "";
  const bool never_turn = always_by_engines(described, [](const SceneDescription& now, const EngineMap& engines) {
    return all_settings(now, engines, [](const MotionSettings& group) { return group.free_rotation().isZero(0.0); });
  });
  if (never_turn) return "rotations are held";
  return smooth && only_contacts_turn(described) ? "without friction spheres do not rotate" : "";
}

void find_rotations_of_none(const SceneDescription& scene, const Components& components, const std::string& why,
                            const Say& say) {
  if (scene.output.picture && scene.output.picture->color == "rotation")
    say("/output/picture/color", why + ", so that all rotations are 0; choose another colour");
  for (const auto& [name, probe] : components.probes)
    if (probe->needs().has(BodyState::rotation))
      say("/probes/" + name, "it samples rotations, but " + why + ", so that they are all 0");
}

/// Reports those of these contact parameters that are written and not 0.
void find_written(const Scene& described, const Description& values, const std::vector<std::string>& keys,
                  const std::string& why, const Say& say) {
  for (const char* section : {"materials", "interfaces"})
    for (const auto& [name, one] : values.at(section).items())
      for (const std::string& key : keys) {
        const std::string pointer = std::string("/") + section + '/' + pointer_token(name) + '/' + key;
        if (described.document.json().contains(Description::json_pointer(pointer)) && one.at(key) != 0.0)
          say(pointer, why);
      }
}

/// `still`: why no body rotates, if none does.
void find_moments_of_nothing(const Scene& described, const Description& values, const std::string& still,
                             const Say& say) {
  const std::vector<std::string> kinds{"rolling", "twisting"};
  if (!still.empty() && only_contacts_turn(described))
    for (const std::string& kind : kinds)
      find_written(described, values, {kind + "_stiffness", kind + "_limit"}, still + ", so that the moment is 0", say);
  for (const std::string& kind : kinds)
    for (const auto& [lacking, given] : {std::pair("_limit", "_stiffness"), std::pair("_stiffness", "_limit")})
      if (is_zero(described, kind + lacking))
        find_written(described, values, {kind + given}, kind + lacking + " is 0, so that the moment is 0", say);
}

void find_scaling_of_none(const SceneDescription& scene, const World& world, const Say& say) {
  const auto radii = world.positions();
  const auto smallest = std::ranges::min_element(radii, {}, &Row::w);
  const bool all_there =
      std::ranges::all_of(scene.bodies, [](const auto& group) { return group.second.stage.empty(); });
  for (const auto& [name, engine] : scene.engines) {
    MotionSettings alone;
    engine.engine.make()->settings(alone);
    if (all_there && alone.scaled_radius > 0 && smallest != radii.end() && alone.scaled_radius <= smallest->w)
      say("/engines/" + name + "/below", "no body is smaller");
  }
}

void find_overlaps_of_present_bodies(const SceneDescription& scene, const Say& say) {
  for (const auto& [name, group] : scene.bodies)
    if (group.stage.empty() && group.overlap != BodiesDescription::usual_overlap)
      say("/bodies/" + name + "/overlap",
          "it applies to bodies inserted by a stage, and these are present from the start");
}

void find_limits_of_a_given_step(const Scene& described, const Say& say) {
  const TimeStepDescription usual, &start = described.description->time_step;
  const bool given = always(described, [](const SceneDescription& now) { return now.time_step.value.has_value(); });
  if (given && start.safety != usual.safety) say("/time_step/safety", "the step is given by /time_step/value");
  if (given && start.steps_per_impact != usual.steps_per_impact)
    say("/time_step/steps_per_impact", "the step is given by /time_step/value");
  if (start.allow_unstable &&
      always(described, [](const SceneDescription& now) { return !now.time_step.value && now.time_step.safety <= 1; }))
    say("/time_step/allow_unstable", "with this safety the step is not above the critical one");
}

void find_materials_of_nothing(const SceneDescription& scene, const Say& say) {
  for (const auto& [name, material] : scene.materials)
    if (!of_body(scene, name) && !of_wall(scene, name)) say("/materials/" + name, "no body and no wall uses it");
  for (const InterfaceDescription& one : scene.interfaces)
    if (!meet(scene, one.a, one.b) && !is_changed(scene, "interfaces", one.name()))
      say("/interfaces/" + pointer_token(one.name()), one.a == one.b
                                                          ? "no two bodies or walls of " + one.a + " come into contact"
                                                          : one.a + " and " + one.b + " never come into contact");
}

void find_frames_of_each_step(const SceneDescription& scene, const World& world, const Say& say) {
  if (const auto& every = scene.output.frames.every_time; every && *every < world.dt())
    say("/output/frames/every_time",
        fmt::format("{:g} s is shorter than the time step, {:g} s at the start: each step writes a frame, {:.3g} per "
                    "simulated second",
                    *every, world.dt(), 1 / world.dt()));
}

void find_walls_out_of_reach(const SceneDescription& scene, const Kernel& kernel, Description values, const Say& say) {
  const auto walls = kernel.world().walls();
  values.erase("walls");
  const std::string elsewhere = values.dump();
  for (std::size_t wall = 0; wall < walls.size(); ++wall)
    // Walls that bound the specimen, or are named by a probe or a condition, have a use wherever they are.
    if (const std::string& name = walls[wall].name;
        elsewhere.find('"' + name + '"') == elsewhere.npos && is_out_of_reach(scene, kernel, wall, name))
      say("/walls/" + name, "it is at rest outside the domain, out of reach of all bodies inside");
}

void find_probes_without_samples(const SceneDescription& scene, const Say& say) {
  for (const auto& [name, probe] : scene.probes)
    if (probe.cadence.never())
      say("/probes/" + name,
          "it never samples: it has none of every_time, every_steps, every_displacement and every_discharged");
    else if (const double most = time_of_stages(scene, probe.stages); probe.cadence.every_time > most)
      say("/probes/" + name + "/every_time",
          fmt::format("{:g} s is longer than its stages, {:g} s at most: it samples only at their start and end",
                      *probe.cadence.every_time, most));
}

}  // namespace

std::vector<UnusedSetting> unused_settings(const Scene& described, const Components& components, const Kernel& kernel) {
  const World& world = kernel.world();
  const SceneDescription& scene = *described.description;
  std::vector<UnusedSetting> unused;
  const Say say = [&](const std::string& pointer, const std::string& why) { unused.push_back({pointer, why}); };
  const Description values = resolved(scene);
  const bool smooth = is_smooth(described);
  const std::string still = why_none_rotates(described, world, smooth);

  find_idle_engines(described, components, say);
  if (!still.empty()) find_rotations_of_none(scene, components, still, say);
  find_moments_of_nothing(described, values, still, say);
  if (smooth && values.at("contacts").value("shear_damping", false))
    say("/contacts/shear_damping", "without friction there is no shear force");
  if (!is_random(values) && scene.seed != 1) say("/seed", "nothing is random: all bodies are given");
  find_scaling_of_none(scene, world, say);
  find_overlaps_of_present_bodies(scene, say);
  find_limits_of_a_given_step(described, say);
  find_materials_of_nothing(scene, say);
  find_frames_of_each_step(scene, world, say);
  find_walls_out_of_reach(scene, kernel, values, say);
  find_probes_without_samples(scene, say);
  return unused;
}

}  // namespace grit
