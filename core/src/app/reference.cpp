#include "app/reference.hpp"

#include <algorithm>
#include <functional>

#include "grit/error.hpp"
#include "input/reference.hpp"
#include "plugins/component.hpp"

namespace grit {
namespace {

template <class Interface>
std::string parameters_text(const Registry& registry, const std::string& name) {
  Parameters parameters;
  const auto component = registry.make<Interface>(name);
  component->declare(parameters);
  std::string text = reference_text(parameters);
  if constexpr (std::same_as<Interface, ContactLaw>) {
    Parameters material, pair;
    component->declare_material("a", material);
    component->declare_interface("a", "a", pair);
    text += "\nof each material:\n" + reference_text(material) + "\nof each interface of two materials:\n" +
            reference_text(pair);
  }
  return text;
}

std::string parameters_text(const Registry& registry, const std::string& kind, const std::string& name) {
  if (kind == "body") return parameters_text<BodyKind>(registry, name);
  if (kind == "contact") return parameters_text<ContactLaw>(registry, name);
  if (kind == "engine") return parameters_text<Engine>(registry, name);
  if (kind == "geometry") return parameters_text<Geometry>(registry, name);
  if (kind == "probe") return parameters_text<Probe>(registry, name);
  return parameters_text<Scenario>(registry, name);
}

}  // namespace

std::string component_text(const Registry& registry, const std::string& name) {
  std::string text;
  std::string all;
  for (const Installed& one : registry.installed()) {
    all += (all.empty() ? "" : ", ") + one.name;
    if (one.name != name) continue;
    const PluginInfo& info = registry.info(one.kind, one.name);
    text += (text.empty() ? "" : "\n") + one.kind + " \"" + name + "\" " + info.version + ": " + info.doc + '\n' +
            (one.file.empty() ? "built in" : one.file.string()) + "\nSDK " + std::to_string(info.tag.sdk_version) + ", " +
            info.tag.compiler + ", " + info.tag.library_abi + ", " + info.tag.instruction_set + "\n\n" +
            parameters_text(registry, one.kind, one.name);
  }
  if (text.empty()) throw PluginError("nothing is installed under the name \"" + name + "\"; there is: " + all);
  return text;
}

}  // namespace grit
