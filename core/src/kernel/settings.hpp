// Present settings of the kernel, from the description.
#pragma once

#include <cstdint>
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

struct Settings {
  std::shared_ptr<ContactLaw> law;
  std::vector<StateField> fields;                          ///< fields of the contact history
  std::map<std::string, std::shared_ptr<Engine>> engines;  ///< by name
  std::vector<Engine*> force_engines;                      ///< those of phase `forces`, by name
  MotionSettings motion;
  Vec3 strain_rate = Vec3::Zero();  ///< of the cell [1/s]
  Vec3 shear_rate = Vec3::Zero();   ///< the same, see Cell
  std::optional<CellServoDescription> cell_servo;
  std::vector<std::string> open_sides;  ///< of the domain, as "-x", "+z"
  SpecimenDescription specimen;
  TimeStepDescription time_step;
  GuardsDescription guards;
  Demand of_groups;        ///< of bodies that appear during the run, before their first contacts
  double growth_rate = 0;  ///< of radii in this stage [1/s]
  bool may_clump = false;  ///< whether a group of bodies, present or future, has clumps

  bool holds_bodies() const { return motion.hold_rotation || motion.hold_translation; }
  /// Whether engines change the energy of bodies: by forces, or by holding them.
  bool engines_do_work() const { return !force_engines.empty() || holds_bodies(); }
};

/// The settings of a scene in a stage; mixes the law's materials. `materials` are all names by index.
Settings settings_of(const SceneDescription& scene, const Components& components, const std::string& stage,
                     const std::vector<std::string>& materials);
/// Growth rate of radii in a stage [1/s]; 0 if none is given.
double growth_rate(const SceneDescription& scene, const std::string& stage);

}  // namespace grit
