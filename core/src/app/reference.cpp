#include "app/reference.hpp"

#include <algorithm>
#include <functional>

#include "grit/error.hpp"
#include "grit/toolkit/did_you_mean.hpp"
#include "input/reference.hpp"
#include "plugins/component.hpp"

namespace grit {
namespace {

std::string table(Parameters& parameters) {
  return parameters.entries().empty() && !parameters.choice() ? "no parameters\n" : reference_text(parameters);
}

template <class Interface>
std::string parameters_text(const Registry& registry, const std::string& name) {
  Parameters parameters;
  const auto component = registry.make<Interface>(name);
  component->declare(parameters);
  std::string text = table(parameters);
  if constexpr (std::same_as<Interface, ContactLaw>) {
    Parameters material, pair;
    component->declare_material("a", material);
    component->declare_interface("a", "a", pair);
    text += "\nper material:\n" + table(material) + "\nper interface of two materials:\n" + table(pair);
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

std::string component_text(const Registry& registry, const std::string& name, bool in_full) {
  std::string text;
  std::vector<std::string> names;
  for (const Installed& one : registry.installed()) {
    names.push_back(one.name);
    if (one.name != name) continue;
    const PluginInfo& info = registry.info(one.kind, one.name);
    text += (text.empty() ? "" : "\n") + one.kind + " \"" + name + "\" " + info.version + ": " + info.doc + '\n';
    if (in_full)
      text += (one.file.empty() ? "built in" : one.file.lexically_normal().string()) + "\nSDK " +
              std::to_string(info.tag.sdk_version) + ", " + info.tag.compiler + ", " + info.tag.library_abi + ", " +
              info.tag.instruction_set + '\n';
    text += '\n' + parameters_text(registry, one.kind, one.name);
  }
  if (text.empty())
    throw PluginError("unknown component \"" + name + '"' + did_you_mean(name, names, "'grit plugins' lists all") +
                      "\n  " + registry.search_text());
  return text;
}

}  // namespace grit
