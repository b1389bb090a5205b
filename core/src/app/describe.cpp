#include <iostream>

#include "app/options.hpp"
#include "app/reference.hpp"
#include "input/reference.hpp"
#include "scene/description.hpp"

namespace grit {
namespace {

/// A section of a description, by its key; empty if there is none of this name.
std::string section_text(const Registry& registry, const std::string& name) {
  SceneDescription scene(registry);
  Parameters all;
  scene.declare(all);
  for (const Parameter& section : all.entries()) {
    if (section.name() != name) continue;
    Parameters one;
    one.add_target(section.name(), section.target()).doc(section.doc());
    return reference_text(one);
  }
  return "";
}

}  // namespace

ExitStatus describe_command(const std::vector<std::string>& words) {
  Options options(command("describe"));
  if (!options.read(words)) return ExitStatus::done;
  const auto registry = options.registry();
  const std::string name = options.only_word("name");
  const std::string section = section_text(*registry, name);
  std::cout << (section.empty() ? component_text(*registry, name) : section);
  return ExitStatus::done;
}

}  // namespace grit
