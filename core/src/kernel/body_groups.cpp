#include "kernel/body_groups.hpp"

#include <algorithm>

#include "format/narrow.hpp"
#include "grit/error.hpp"

namespace grit {
namespace {

Row row(const Vec3& v, double fourth) { return {v.x(), v.y(), v.z(), fourth}; }

}  // namespace

std::vector<std::string> group_names(const SceneDescription& scene) {
  std::vector<std::string> names;
  for (const auto& [name, group] : scene.bodies) names.push_back(name);
  return names;
}

GroupMask group_mask(const std::vector<std::string>& chosen, const std::vector<std::string>& names) {
  if (chosen.empty()) return {};
  GroupMask mask;
  for (const std::string& name : names) mask.push_back(std::ranges::find(chosen, name) != chosen.end());
  return mask;
}

std::vector<std::uint16_t> groups_of(const Bodies& bodies, const std::vector<std::string>& names) {
  std::vector<std::uint16_t> index;  // by entry of bodies.groups
  for (const BodyGroup& group : bodies.groups)
    index.push_back(narrow_index<std::uint16_t>(
        static_cast<std::size_t>(std::ranges::find(names, group.name) - names.begin()), "groups of bodies"));
  std::vector<std::uint16_t> of(bodies.count());
  for (std::size_t i = 0; i < of.size(); ++i) {
    const auto next = std::ranges::upper_bound(bodies.groups, bodies.id[i], {}, &BodyGroup::first_id);
    if (next != bodies.groups.begin()) of[i] = index[static_cast<std::size_t>(next - bodies.groups.begin()) - 1];
  }
  return of;
}

void find_groups(State& state) {
  state.group.clear();
  if (state.settings.by_group()) state.group = groups_of(state.bodies, state.settings.groups);
}

void constrain(Bodies& bodies, const Settings& settings) {
  if (!settings.any_motion([](const MotionSettings& one) { return one.flat || one.prescribed; })) return;
  const std::vector<std::uint16_t> group = groups_of(bodies, settings.groups);
  for (std::size_t i = 0; i < bodies.count(); ++i) {
    const MotionSettings& motion = settings.motion_of(group[i]);
    Vec3 v = xyz(bodies.velocity[i]), w = xyz(bodies.spin[i]);
    if (motion.flat) {
      if (bodies.clumps.clump_of(i) != no_clump)
        throw Error("clumps rotate about all axes, so planar motion is not possible; remove the engine \"planar\"");
      v[*motion.flat] = 0, w = w.cwiseProduct(Vec3::Unit(*motion.flat));
    }
    if (motion.prescribed) v = motion.prescribed->at(xyz(bodies.position[i])), w = motion.prescribed->spin;
    bodies.velocity[i] = row(v, bodies.velocity[i].w), bodies.spin[i] = row(w, bodies.spin[i].w);
  }
  for (Clump& clump : bodies.clumps.clump)
    if (const auto& motion = settings.motion_of(group[bodies.clumps.spheres[clump.first]]).prescribed) {
      clump.velocity = motion->at(clump.centre), clump.spin = motion->spin;
      clump.momentum = clump.axes * clump.inertia.cwiseProduct(clump.axes.transpose() * motion->spin);
    }
}

}  // namespace grit
