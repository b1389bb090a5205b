// The plain description as typed values, without live components. Each parameter is declared once, in the file of its
// section: reading, checks, schema and reference pages are derived from these declarations.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "description/begin.hpp"
#include "description/bodies.hpp"
#include "description/domain.hpp"
#include "description/engines.hpp"
#include "description/materials.hpp"
#include "description/output.hpp"
#include "description/probes.hpp"
#include "description/stages.hpp"
#include "description/time_step.hpp"
#include "description/walls.hpp"
#include "grit/parameters.hpp"
#include "plugins/component.hpp"

namespace grit {

/// A complete scene. Reading checks that every name in it (of a wall, a material, a stage) exists.
struct SceneDescription {
  explicit SceneDescription(const Registry& registry);

  std::string title;
  std::int64_t seed = 1;
  Component<ContactLaw> contacts;
  std::map<std::string, MaterialDescription> materials;
  std::vector<InterfaceDescription> interfaces;  ///< in written order
  DomainDescription domain;
  std::optional<BeginDescription> begin;
  std::map<std::string, BodiesDescription> bodies;
  std::map<std::string, WallDescription> walls;
  std::map<std::string, EngineDescription> engines;
  SpecimenDescription specimen;
  TimeStepDescription time_step;
  GuardsDescription guards;
  std::deque<StageDescription> stages;
  std::map<std::string, ProbeDescription> probes;
  OutputDescription output;

  void declare(Parameters& p);

  /// The sections that a stage may change or ramp; in the domain only the strain rate.
  static const std::vector<std::string>& changeable();
  /// Declares one of these sections.
  void declare_section(const std::string& section, Parameters& p);
  /// Declares one entry of a section with named entries, or a section without them; `law` reads the parameters of
  /// materials. An entry that does not exist is added. False if there is no such section.
  bool declare_unit(const std::string& section, const std::string& name, ContactLaw* law, Parameters& p);
  /// Whether this entry or section exists.
  bool has_unit(const std::string& section, const std::string& name) const;
  /// The names of a section's entries; one empty name for a section without named entries.
  std::vector<std::string> units_of(const std::string& section) const;
  /// Whether a changeable section has entries by name.
  static bool has_names(const std::string& section);
  /// Reports inconsistencies between sections that a stage may change.
  void check_together(const Complain& complain) const;
  /// Names of all materials, also of those that stages add; ascending.
  std::vector<std::string> names_of_materials() const;
  /// The interface of this name; null if there is none.
  InterfaceDescription* find_interface(const std::string& name);

  const Registry& registry() const { return *registry_; }

 private:
  std::shared_ptr<ContactLaw> law_to_read() const;

  const Registry* registry_;
};

}  // namespace grit
