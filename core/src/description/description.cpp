#include "description/description.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "description/motion_checks.hpp"
#include "description/name_checks.hpp"
#include "description/section_checks.hpp"

namespace grit {
namespace {

template <class T>
std::vector<std::string> keys(const std::map<std::string, T>& map) {
  std::vector<std::string> names;
  for (const auto& entry : map) names.push_back(entry.first);
  return names;
}

}  // namespace

SceneDescription::SceneDescription(const Registry& registry) : contacts(registry), registry_(&registry) {}

const std::vector<std::string>& SceneDescription::changeable() {
  static const std::vector<std::string> sections{"materials", "interfaces", "walls", "engines",
                                                 "domain",    "time_step",  "guards"};
  return sections;
}

std::shared_ptr<ContactLaw> SceneDescription::law_to_read() const {
  return contacts.type().empty() ? nullptr : contacts.make();
}

void SceneDescription::declare_section(const std::string& section, Parameters& p) {
  if (section == "materials") {
    MapTarget target;
    // One law for all materials, made when the first is read.
    const auto law = std::make_shared<std::shared_ptr<ContactLaw>>();
    target.names = [this] { return keys(materials); };
    target.clear = [this, law] { materials.clear(), *law = nullptr; };
    target.declare = [this](const std::string& name, Parameters& inner) {
      materials.at(name).declare(name, nullptr, inner);
    };
    target.insert = [this, law](const std::string& name, Parameters& inner) {
      if (!*law) *law = law_to_read();
      (materials[name] = {}).declare(name, law->get(), inner);
    };
    p.add_target("materials", std::move(target))
        .required()
        .entries(1)
        .doc("materials by name: density and the parameters of the contact law");
  }
  if (section == "interfaces") {
    MapTarget target;
    const auto law = std::make_shared<std::shared_ptr<ContactLaw>>();
    target.names = [this] { return units_of("interfaces"); };
    target.clear = [this, law] { interfaces.clear(), *law = nullptr; };
    target.declare = [this](const std::string& name, Parameters& inner) {
      find_interface(name)->declare(nullptr, inner);
    };
    target.insert = [this, law](const std::string& name, Parameters& inner) {
      if (!*law) *law = law_to_read();
      interfaces.emplace_back(name).declare(law->get(), inner);
    };
    p.add_target("interfaces", std::move(target)).doc("parameters of contacts between two materials, by \"one+other\"");
  }
  if (section == "domain") p.add("domain", domain).doc("bounds of the simulated region");
  if (section == "walls")
    p.add("walls", walls, [this](const std::string&) { return WallDescription(*registry_); }).doc("walls by name");
  if (section == "engines")
    p.add("engines", engines, [this](const std::string&) {
       return EngineDescription(*registry_);
     }).doc("actions on the bodies other than contacts, by name");
  if (section == "time_step") p.add("time_step", time_step).doc("time step");
  if (section == "guards") p.add("guards", guards).doc("limits at which a run stops");
}

bool SceneDescription::has_names(const std::string& section) {
  return section == "materials" || section == "interfaces" || section == "walls" || section == "engines";
}

bool SceneDescription::declare_unit(const std::string& section, const std::string& name, ContactLaw* law,
                                    Parameters& p) {
  if (section == "materials") return materials[name].declare(name, law, p), true;
  if (section == "interfaces") {
    InterfaceDescription* const known = find_interface(name);
    return (known != nullptr ? *known : interfaces.emplace_back(name)).declare(law, p), true;
  }
  if (section == "walls") return walls.try_emplace(name, *registry_).first->second.declare(p), true;
  if (section == "engines") return engines.try_emplace(name, *registry_).first->second.declare(p), true;
  if (section == "domain") return domain.declare(p), true;
  if (section == "time_step") return time_step.declare(p), true;
  if (section == "guards") return guards.declare(p), true;
  return false;
}

std::vector<std::string> SceneDescription::units_of(const std::string& section) const {
  if (section == "materials") return keys(materials);
  if (section == "walls") return keys(walls);
  if (section == "engines") return keys(engines);
  if (section != "interfaces") return {""};
  std::vector<std::string> names;
  for (const InterfaceDescription& one : interfaces) names.push_back(one.name());
  return names;
}

bool SceneDescription::has_unit(const std::string& section, const std::string& name) const {
  const auto names = units_of(section);
  return std::ranges::find(names, name) != names.end();
}

std::vector<std::string> SceneDescription::names_of_materials() const {
  std::set<std::string> all;
  for (const auto& [name, _] : materials) all.insert(name);
  for (const StageDescription& stage : stages)
    if (const auto added = stage.change.find("materials"); added != stage.change.end() && added->is_object())
      for (const auto& [name, _] : added->items()) all.insert(name);
  return {all.begin(), all.end()};
}

InterfaceDescription* SceneDescription::find_interface(const std::string& name) {
  const auto found =
      std::ranges::find_if(interfaces, [&](const InterfaceDescription& one) { return one.is_named(name); });
  return found == interfaces.end() ? nullptr : &*found;
}

void SceneDescription::check_together(const Complain& complain) const {
  check_number_of_materials(*this, complain);
  check_interfaces(*this, complain);
  check_materials_of_bodies(*this, complain);
  check_motions(*this, complain);
  check_growth(*this, complain);
  check_materials_of_walls(*this, complain);
  check_names_of_groups(*this, complain);
  check_followers(*this, complain);
  check_shear(*this, complain);
}

void SceneDescription::declare(Parameters& p) {
  p.add("title", title).doc("title of the run, one line");
  p.add("seed", seed).at_least(0).doc("seed of the random numbers");
  p.add("contacts", contacts).required().doc("contact law");
  declare_section("materials", p);
  declare_section("interfaces", p);
  declare_section("domain", p);
  p.add("bodies", bodies, [this](const std::string&) { return BodiesDescription(*registry_); })
      .required()
      .entries(1)
      .doc("groups of bodies by name");
  p.add("begin", begin).doc("prepared sample from which the run begins; default: none");
  declare_section("walls", p);
  declare_section("engines", p);
  p.add("specimen", specimen).doc("region over which averages are taken");
  declare_section("time_step", p);
  declare_section("guards", p);
  p.add("stages", stages).required().entries(1).doc("stages of the run, in order");
  p.add("probes", probes, [this](const std::string&) {
     return ProbeDescription(*registry_);
   }).doc("measurements, by name");
  p.add("output", output).doc("frames, checkpoints, picture, references, summary");
  p.resolved_before({"scenario", "extends"});
  // Bodies are placed beside those of a sample when the first stage begins.
  p.when_read([this] {
    if (!begin || stages.empty()) return;
    for (auto& [name, group] : bodies)
      if (!group.is_from_sample() && group.stage.empty()) group.stage = stages.front().name;
  });

  p.check_names([this](const Complain& complain) { check_number_of_materials(*this, complain); });
  p.check_names([this](const Complain& complain) { check_number_of_groups(*this, complain); });
  p.check_names([this](const Complain& complain) { check_interfaces(*this, complain); });
  p.check_names([this](const Complain& complain) { check_materials_of_bodies(*this, complain); });
  p.check([this](const Complain& complain) { check_motions(*this, complain); }, {"bodies", "engines"});
  p.check([this](const Complain& complain) { check_growth(*this, complain); }, {"engines", "stages"});
  p.check_names([this](const Complain& complain) { check_materials_of_walls(*this, complain); });
  p.check_names([this](const Complain& complain) { check_names_of_groups(*this, complain); });
  p.check([this](const Complain& complain) { check_sample(*this, complain); }, {"bodies", "begin"});
  p.check_names([this](const Complain& complain) { check_followers(*this, complain); });
  p.check([this](const Complain& complain) { check_shear(*this, complain); }, {"domain", "walls", "bodies"});
  p.check_names([this](const Complain& complain) { check_specimen(*this, complain); });
  p.check_names([this](const Complain& complain) { check_awaited_walls(*this, complain); });
  p.check_names([this](const Complain& complain) { check_unique_stages(*this, complain); });
  p.check_names([this](const Complain& complain) { check_named_stages(*this, complain); });
}

}  // namespace grit
