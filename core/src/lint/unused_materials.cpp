#include "lint/unused_materials.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <deque>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "lint/all_stages.hpp"
#include "lint/small_changes.hpp"
#include "plugins/parameter_values.hpp"

namespace grit {
namespace {

/// Materials that may come into contact.
struct MayTouch {
  std::set<std::string> bodies, walls;
  explicit MayTouch(const SceneDescription& now) {
    for (const auto& [name, group] : now.bodies) bodies.insert(group.material);
    for (const auto& [name, wall] : now.walls) walls.insert(wall.material);
  }
  bool operator==(const MayTouch&) const = default;
};

/// Materials during a period of the run in which they do not change.
struct Materials {
  std::map<std::string, MaterialDescription> materials;
  std::vector<InterfaceDescription> interfaces;
  MayTouch may_touch;
  std::size_t stages = 0;  ///< number of stages that have begun
  LiveLaw law;

  Materials(const SceneDescription& now, std::size_t stages_begun)
      : materials(now.materials), interfaces(now.interfaces), may_touch(now), stages(stages_begun), law(now) {}
  bool has(const SceneDescription& now) const {
    return materials == now.materials && interfaces == now.interfaces && may_touch == MayTouch(now);
  }
};

std::deque<Materials> all_materials(const Scene& described) {
  std::deque<Materials> all;
  through_stages(*described.description, described.stages,
                 [&](const SceneDescription& now, std::optional<std::size_t> stage) {
                   if (all.empty() || !all.back().has(now)) all.emplace_back(now, stage ? *stage + 1 : 0);
                   return true;
                 });
  return all;
}

/// Appends the parameters of a contact of two materials.
void add_contact(ContactLaw& law, const std::string& a, const std::string& b, bool wall, std::vector<double>& all) {
  std::vector<std::string> both{a};
  if (b != a) both.push_back(b);
  law.mix(both, wall ? 1 : both.size());
  std::ranges::copy(law.mixed(0, both.size() - 1, wall), std::back_inserter(all));
}

/// Appends the parameters of all possible contacts of a material, or of two materials with each other. Others are not
/// mixed, as they are many.
void add_contacts(const Materials& one, const std::string& a, const std::string& b, std::vector<double>& all) {
  const auto& [bodies, walls] = one.may_touch;
  const auto add = [&](const std::string& body, const std::string& other) {
    if (!bodies.contains(body)) return;
    if (bodies.contains(other)) add_contact(*one.law, body, other, false, all);
    if (walls.contains(other)) add_contact(*one.law, body, other, true, all);
  };
  if (!b.empty()) return add(a, b), add(b, a);
  std::set<std::string> others = bodies;
  others.insert(walls.begin(), walls.end());
  for (const std::string& other : others) add(a, other), add(other, a);
}

/// The number of stages begun before which a value keeps its initial value.
std::size_t stages_with(const Scene& described, const std::string& pointer) {
  const auto& stages = described.description->stages;
  const auto sets = [&](const StageDescription& stage) {
    // By a change of it, by null for a parent, or by a ramp.
    for (std::string at = pointer; !at.empty(); at.erase(at.rfind('/')))
      if (const Description::json_pointer parent(at); stage.change.contains(parent))
        if (at == pointer || stage.change.at(parent).is_null()) return true;
    return std::ranges::any_of(stage.ramps, [&](const RampDescription& ramp) { return ramp.pointer == pointer; });
  };
  return static_cast<std::size_t>(std::ranges::find_if(stages, sets) - stages.begin()) + 1;
}

/// The declaration of a law's parameter; null if there is none of this name.
const Parameter* declared(const Parameters& parameters, const std::string& key) {
  const auto found = std::ranges::find(parameters.entries(), key, &Parameter::name);
  return found == parameters.entries().end() ? nullptr : &*found;
}

}  // namespace

std::vector<UnusedSetting> unused_materials(const Scene& scene,
                                            const std::function<bool(const std::string&)>& is_written) {
  const SceneDescription& start = *scene.description;
  std::deque<Materials> all = all_materials(scene);
  std::vector<UnusedSetting> unused;

  /// A part of the description: a material, or an interface of two.
  struct Part {
    std::string section, name, a, b;
  };
  const auto declare = [](const Part& part, ContactLaw& law, Parameters& parameters) {
    if (part.b.empty()) law.declare_material(part.a, parameters);
    else law.declare_interface(part.a, part.b, parameters);
  };
  const auto values_in = [](const Part& part, Materials& one) -> Description* {
    if (part.b.empty()) {
      const auto found = one.materials.find(part.a);
      return found == one.materials.end() ? nullptr : &found->second.values;
    }
    const auto found = std::ranges::find(one.interfaces, part.name, &InterfaceDescription::name);
    return found == one.interfaces.end() ? nullptr : &found->values;
  };
  const auto law_of_start = start.contacts.make();
  const auto inspect = [&](const Part& part, const Description& values) {
    Parameters parameters;
    declare(part, *law_of_start, parameters);
    const auto numbers = [&] {
      std::vector<double> found;
      for (const Materials& one : all) add_contacts(one, part.a, part.b, found);
      return found;
    };
    std::optional<std::vector<double>> now;
    for (const auto& [key, value] : values.items()) {
      const std::string pointer = fmt::format("/{}/{}/{}", part.section, pointer_token(part.name), pointer_token(key));
      const Parameter* const parameter = declared(parameters, key);
      if (!value.is_number() || parameter == nullptr || !is_written(pointer)) continue;
      if (!now) now = numbers();
      const std::size_t lasts = stages_with(scene, pointer);
      const auto set = [&, &key = key](const Materials& one, const Description& described, const Description& other) {
        Description changed = described;
        changed[key] = other;
        Parameters own;
        declare(part, *one.law, own);
        assign(own, changed);
      };
      const auto same = [&, &key = key](const std::string& other) {
        const Description tried = Description::parse(other);
        if (!parameter->allows(tried.get<double>())) throw Error("out of range");
        const auto set_all = [&](const Description* instead) {
          for (Materials& one : all)
            if (const Description* const described = one.stages < lasts ? values_in(part, one) : nullptr;
                described != nullptr && described->contains(key))
              set(one, *described, instead != nullptr ? *instead : described->at(key));
        };
        set_all(&tried);
        const bool is_same = numbers() == *now;
        set_all(nullptr);
        return is_same;
      };
      if (changes_nothing(value, same))
        unused.push_back(
            {pointer,
             "no contact depends on it: contacts use the value of the other material, of an interface, or none"});
    }
  };
  for (const auto& [name, material] : start.materials) inspect({"materials", name, name, ""}, material.values);
  for (const InterfaceDescription& one : start.interfaces)
    inspect({"interfaces", one.name(), one.a, one.b}, one.values);
  return unused;
}

}  // namespace grit
