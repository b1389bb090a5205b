#include "description/motion_checks.hpp"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace grit {
namespace {

/// An engine of phase `settings`.
struct Setter {
  std::string name;
  const EngineDescription* described;
  std::shared_ptr<Engine> engine;
  MotionSettings alone;  ///< of this engine alone
};

std::vector<Setter> setters_of(const SceneDescription& scene) {
  std::vector<Setter> setters;
  for (const auto& [name, described] : scene.engines) {
    Setter one{name, &described, described.engine.make(), {}};
    if (one.engine->phase() != Phase::settings) continue;
    one.engine->settings(one.alone);
    setters.push_back(std::move(one));
  }
  return setters;
}

/// The first group on which both act; empty if there is none.
std::string shared_group(const SceneDescription& scene, const Setter& one, const Setter& other) {
  for (const auto& [group, _] : scene.bodies)
    if (one.described->acts_on(group) && other.described->acts_on(group)) return group;
  return "";
}

/// What the two set in an order that matters: the last one would win. Empty if nothing.
std::string set_differently(const Setter& one, const Setter& other) {
  MotionSettings forwards = one.alone, backwards = other.alone;
  other.engine->settings(forwards), one.engine->settings(backwards);
  if (forwards.prescribed != backwards.prescribed) return "a prescribed motion";
  if (forwards.flat != backwards.flat) return "a plane of motion";
  if (forwards.local_damping != backwards.local_damping) return "a local damping";
  return forwards == backwards ? "" : "a setting of the motion";
}

/// Whether a rigid motion translates some point along an axis.
bool translates(const RigidMotion& motion, int axis) {
  Vec3 across = motion.spin;
  across[axis] = 0;
  return motion.velocity[axis] != 0 || !across.isZero(0.0);
}

/// Reports a prescribed motion along or about an axis that `other` holds, or out of its plane.
void check_prescribed(const Setter& prescribing, const Setter& other, const std::string& group,
                      const Complain& complain) {
  const RigidMotion& motion = *prescribing.alone.prescribed;
  const auto refuse = [&](const std::string& way, const std::string& of, const std::string& allowed) {
    complain("engines/" + prescribing.name,
             "a prescribed motion of the group \"" + group + "\" " + way + " the engine \"" + other.name + "\"" + of,
             allowed);
  };
  for (int k = 0; k < 3; ++k) {
    const std::string axis(1, "xyz"[k]);
    const auto at = static_cast<std::size_t>(k);
    const bool along = other.alone.held_translation[at] && translates(motion, k),
               about = other.alone.held_rotation[at] && motion.spin[k] != 0;
    if (along || about)
      return refuse((along ? "along " : "about ") + axis + ", which", " holds",
                    "another axis, or an engine \"" + other.name + "\" for other groups");
  }
  if (!other.alone.flat) return;
  const int normal = *other.alone.flat;
  if (translates(motion, normal))
    refuse("out of the plane of", "",
           std::string("a velocity across ") + "xyz"[normal] + " and a spin about it, or other groups");
}

}  // namespace

void check_motions(const SceneDescription& scene, const Complain& complain) {
  if (scene.engines.size() < 2) return;
  const std::vector<Setter> setters = setters_of(scene);
  for (std::size_t i = 0; i < setters.size(); ++i)
    for (std::size_t j = i + 1; j < setters.size(); ++j) {
      const Setter &one = setters[i], &other = setters[j];
      const std::string group = shared_group(scene, one, other);
      if (group.empty()) continue;
      if (const std::string what = set_differently(one, other); !what.empty())
        complain("engines/" + other.name,
                 what + " of the group \"" + group + "\", which the engine \"" + one.name + "\" sets differently",
                 "one of them for each group; limit them to different groups, or remove one");
      if (one.alone.prescribed) check_prescribed(one, other, group, complain);
      if (other.alone.prescribed) check_prescribed(other, one, group, complain);
    }
}

}  // namespace grit
