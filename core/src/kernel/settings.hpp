// Present settings of the kernel, from the description.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contact/demand.hpp"
#include "description/components.hpp"
#include "description/description.hpp"
#include "grit/contact/contact_law.hpp"
#include "grit/engine.hpp"

namespace grit {

/// Groups of bodies, by index; empty: all.
using GroupMask = std::vector<bool>;

/// An engine and the groups on which it acts.
struct ActingEngine {
  const Engine* engine;
  GroupMask groups;
  bool acts_on(std::size_t group) const { return groups.empty() || groups[group]; }
};

struct Settings {
  std::shared_ptr<ContactLaw> law;
  std::vector<StateField> fields;                          ///< fields of the contact history
  std::map<std::string, std::shared_ptr<Engine>> engines;  ///< by name
  std::vector<ActingEngine> force_engines;                 ///< of phase `forces`, by name
  std::vector<ActingEngine> removal_engines;               ///< of phase `removal`, by name
  std::vector<std::string> groups;                         ///< names, ascending
  MotionSettings motion;                                   ///< of all bodies
  std::vector<MotionSettings> motion_of_groups;            ///< instead, by group; empty if all are alike
  std::vector<GroupMask> groups_of_walls;                  ///< on which they act, by wall
  Vec3 strain_rate = Vec3::Zero();                         ///< of the cell [1/s]
  Vec3 shear_rate = Vec3::Zero();                          ///< the same, see Cell
  std::optional<CellServoDescription> cell_servo;
  std::vector<std::string> open_sides;  ///< of the domain, as "-x", "+z"
  SpecimenDescription specimen;
  TimeStepDescription time_step;
  GuardsDescription guards;
  Demand of_groups;        ///< of bodies that appear during the run, before their first contacts
  double growth_rate = 0;  ///< of radii in this stage [1/s]
  bool may_clump = false;  ///< whether a group of bodies, present or future, has clumps

  /// Whether anything depends on the groups of bodies.
  bool by_group() const;
  const MotionSettings& motion_of(std::size_t group) const {
    return motion_of_groups.empty() ? motion : motion_of_groups[group];
  }
  /// Whether `is` holds for the settings of any body.
  template <class Is>
  bool any_motion(Is is) const {
    return motion_of_groups.empty() ? std::invoke(is, motion) : std::ranges::any_of(motion_of_groups, is);
  }
  bool holds_bodies() const { return any_motion(&MotionSettings::holds); }
  /// Whether engines change the energy of bodies: by forces, or by holding them.
  bool engines_do_work() const { return !force_engines.empty() || holds_bodies(); }
};

/// The settings of a scene in a stage; mixes the law's materials. `materials` are all names by index.
Settings settings_of(const SceneDescription& scene, const Components& components, const std::string& stage,
                     const std::vector<std::string>& materials);
/// Growth rate of radii in a stage [1/s]; 0 if none is given.
double growth_rate(const SceneDescription& scene, const std::string& stage);

}  // namespace grit
