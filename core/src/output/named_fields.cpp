#include "output/named_fields.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "grit/error.hpp"
#include "grit/toolkit/did_you_mean.hpp"
#include "output/body_values.hpp"
#include "output/shown_fields.hpp"
#include "run/observer.hpp"

namespace grit {
namespace {

/// Names of the fields of probes: of bodies, and on maps, with those of their components.
struct FieldNames {
  std::vector<std::string> of_bodies, on_maps;

  void add(const FieldGroup& table) {
    for (const BodyValues& values : values_of_bodies(table, {})) of_bodies.push_back(values.name);
    const auto rows = [&](const std::string& name) {
      const auto found = std::ranges::find(table.fields, name, &Field::name);
      return found == table.fields.end() || found->width != 3 ? std::string::npos : found->values.size() / 3;
    };
    const std::size_t cells = rows("centre");
    if (cells == std::string::npos || rows("size") != cells) return;
    for (const Field& field : table.fields) {
      if (field.name == "centre" || field.name == "size" || is_bookkeeping(field) ||
          field.values.size() != cells * field.width)
        continue;
      const std::string name = table.name + '/' + field.name;
      on_maps.push_back(name);
      for (const std::string& component : components_of(field)) on_maps.push_back(name + '/' + component);
    }
  }
};

class ProbeFields {
 public:
  ProbeFields(const SceneDescription& scene, const World& world) : scene_(scene), world_(world) {}

  /// The probe that the name begins with; null if there is none.
  const ProbeDescription* probe_of(const std::string& name) const {
    const auto found = scene_.probes.find(name.substr(0, name.find('/')));
    return found == scene_.probes.end() ? nullptr : &found->second;
  }
  /// The fields of that probe.
  FieldNames beside(const std::string& name) const {
    FieldNames names;
    if (const ProbeDescription* probe = probe_of(name)) add(name.substr(0, name.find('/')), *probe, names);
    return names;
  }
  FieldNames all() const {
    FieldNames names;
    for (const auto& [name, probe] : scene_.probes) add(name, probe, names);
    return names;
  }

 private:
  void add(const std::string& name, const ProbeDescription& probe, FieldNames& names) const {
    names.add(Observer(name, probe, probe.probe.make(), world_).fields(world_));
  }

  const SceneDescription& scene_;
  const World& world_;
};

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

std::string refusal(const std::string& name, const std::string& what, const std::vector<std::string>& known) {
  return fault_text(
      '"' + name + "\", which is " + what + did_you_mean(name, known),
      known.empty() ? "none without probes that have such fields" : fmt::format("one of {}", fmt::join(known, ", ")));
}

/// Why the field, which its probe has, is missing at the end; empty if it is there.
std::string absence(const SceneDescription& scene, const std::string& name, const ProbeDescription& probe) {
  const std::string section = "/probes/" + name.substr(0, name.find('/'));
  if (scene.output.frames.never())
    return fault_text('"' + name + "\" without frames, from which it is taken",
                      "a field if /output/frames has an interval, e.g. every_time");
  if (!probe.frames)
    return fault_text('"' + name + "\" of a probe that is not in frames",
                      "a field of a probe in frames: set " + section + "/frames to true");
  if (!probe.stages.empty() && !scene.stages.empty() && !has(probe.stages, scene.stages.back().name))
    return fault_text(
        '"' + name + "\" of a probe that does not sample in the last stage, after which the picture is drawn",
        "a field of a probe that does: add \"" + scene.stages.back().name + "\" to " + section + "/stages");
  return {};
}

}  // namespace

void check_fields(const Document& document, const SceneDescription& scene, const World& world) {
  const ProbeFields names(scene, world);
  std::vector<Problem> problems;
  if (const auto& picture = scene.output.picture; picture && names_a_field(picture->color)) {
    const std::string& color = picture->color;
    const std::string message = has(names.beside(color).of_bodies, color)
                                    ? absence(scene, color, *names.probe_of(color))
                                    : refusal(color, "not a field of bodies of any probe", names.all().of_bodies);
    if (!message.empty()) problems.push_back(document.problem("/output/picture/color", message));
  }
  for (std::size_t i = 0; i < scene.output.color_scales.size(); ++i) {
    const std::string& of = scene.output.color_scales[i].of;
    if (!names_a_field(of)) continue;
    const FieldNames beside = names.beside(of);
    if (has(beside.of_bodies, of) || has(beside.on_maps, of)) continue;
    FieldNames all = names.all();
    for (std::string& name : all.of_bodies)
      if (!has(all.on_maps, name)) all.on_maps.push_back(std::move(name));
    problems.push_back(document.problem(fmt::format("/output/color_scales/{}/of", i),
                                        refusal(of, "not a field of any probe on maps or bodies", all.on_maps)));
  }
  if (!problems.empty()) throw DescriptionError(std::move(problems));
}

}  // namespace grit
