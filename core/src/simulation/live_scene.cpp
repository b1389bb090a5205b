#include "simulation/live_scene.hpp"

#include <algorithm>
#include <string_view>
#include <variant>

#include "description/placed_error.hpp"
#include "grit/error.hpp"
#include "simulation/needed_memory.hpp"
#include "simulation/preflight.hpp"

namespace grit {

LiveScene::LiveScene(const Scene& scene)
    : current_(*scene.description, scene.stages), law_(*scene.description), components_{.law = law_.get()} {
  Faults faults(scene.document);
  for (const auto& [name, group] : now().bodies)
    components_.body_kinds[name] = prepared(group.kind, {"bodies", name}, faults.report_of(0));
  Faults memory(scene.document);
  check_memory(now(), components_, memory.report_of(0));
  memory.throw_if_any();  // before it is taken
  geometries_.follow(now(), faults.report_of(0));
  engines_.follow(now());
  for (const auto& [name, probe] : now().probes) components_.probes[name] = probe.probe.make();
  check_stages(scene, components_, geometries_, faults);
  faults.throw_if_any();
  components_.geometries = geometries_.all(), components_.engines = engines_.all();
}

void LiveScene::begin_stage() {
  current_.begin_stage();
  bound_ = nullptr;
  follow();
}

bool LiveScene::advance_ramps(std::size_t increments) {
  const CurrentScene::Step step = current_.advance_ramps(increments);
  if (step.ramp == nullptr) return false;
  if (step.replaced || step.ramp != bound_) {
    follow();
    const auto place = NumberPointer::of(step.ramp->pointer);
    number_ = law_.number(*place);
    if (!number_) number_ = engines_.number(*place);
    bound_ = step.ramp;
  } else if (number_) {
    number_->set(step.value);
  } else if (geometries_.follow(now())) {
    components_.geometries = geometries_.all();
  }
  return true;
}

bool LiveScene::appears_later(const std::string& material) const {
  return std::ranges::any_of(now().bodies, [&](const auto& one) {
    const BodiesDescription& group = one.second;
    const auto stage = std::ranges::find(now().stages, group.stage, &StageDescription::name) - now().stages.begin();
    // A stream keeps the density of the start.
    return group.material == material && !group.stage.empty() &&
           stage >= static_cast<std::ptrdiff_t>(current_.next_stage()) &&
           !std::holds_alternative<StreamSource>(group.source.value());
  });
}

void LiveScene::refuse_idle(const std::string& pointer, const SettingsChange& change) const {
  const auto refuse = [&](const std::string& message) { throw DescriptionError({{"set", 0, pointer, message}}); };
  for (const auto& [name, material] : change.materials) {
    if (!material) continue;
    // Bodies and contacts keep indices of materials.
    const auto known = now().materials.find(name);
    if (known == now().materials.end())
      refuse("found the material \"" + name +
             "\", which is not defined; allowed are materials that are defined when the run begins: add it to "
             "/materials of the description");
    else if (material->density != known->second.density && !appears_later(name))
      refuse("found a new density of the material \"" + name +
             "\", which would have no effect: bodies keep the density that they were made with, and no later stage "
             "makes bodies of this material; allowed are "
             "its values for contacts, or another density in the description");
  }
}

bool LiveScene::set(const std::string& pointer, const Description& value, const std::function<void()>& take) {
  if (value.is_number() && known_.contains(pointer) && set_in_place(pointer, value.get<double>())) {
    take();
    return true;
  }
  const SettingsChange change = change_of(now(), pointer, value);
  refuse_idle(pointer, change);
  const SettingsChange before = change.reverse(now());
  const auto apply = [&](const SettingsChange& one) {
    current_.apply(one);
    bound_ = nullptr;
    follow();
    take();
  };
  try {
    apply(change);
  } catch (const PlacedError& error) {
    apply(before);
    std::vector<Problem> problems;
    for (const PlacedError::Fault& fault : error.faults())
      problems.push_back({"set", 0, pointer_of(fault.keys), fault.message});
    throw DescriptionError(std::move(problems));
  } catch (...) {
    apply(before);
    throw;
  }
  known_.insert(pointer);
  return false;
}

void LiveScene::set_engine(const std::string& name, std::shared_ptr<Engine> engine, const std::function<void()>& take) {
  if (now().engines.contains(name))
    throw Error("found an engine \"" + name + "\" in /engines of the description; choose another name");
  const auto apply = [&](std::shared_ptr<Engine> one) {
    engines_.set_added(name, std::move(one));
    components_.engines = engines_.all();
    take();
  };
  std::shared_ptr<Engine> before = engines_.added(name);
  try {
    apply(std::move(engine));
  } catch (...) {
    apply(std::move(before));
    throw;
  }
}

bool LiveScene::set_in_place(const std::string& pointer, double value) {
  const Number* const number = bind(pointer);
  if (number == nullptr) return false;
  const double before = number->described.get();
  if (!(number->live ? *number->live : number->described).set(value)) return false;
  number->described.restore(value);
  bool fits = true;
  now().check_together([&](std::string_view, std::string_view, std::string_view) { fits = false; });
  if (!fits) restore(pointer, before);
  return fits;
}

void LiveScene::restore(const std::string& pointer, double value) {
  known_.insert(pointer);
  const Number* const number = bind(pointer);
  if (number == nullptr) throw Error("there is no number at " + pointer);
  number->described.restore(value);
  if (number->live) number->live->restore(value);
}

const LiveScene::Number* LiveScene::bind(const std::string& pointer) {
  auto known = numbers_.find(pointer);
  if (known == numbers_.end()) {
    const auto place = NumberPointer::of(pointer);
    known = numbers_.emplace(pointer, place ? found(*place) : std::nullopt).first;
  }
  return known->second ? &*known->second : nullptr;
}

std::optional<LiveScene::Number> LiveScene::found(const NumberPointer& place) {
  Parameters described, live;
  if (!current_.declare(place, nullptr, described)) return std::nullopt;
  const auto number = CheckedNumber::find(described, place.keys);
  if (!number) return std::nullopt;
  if (place.section == "materials" && place.keys == std::vector<std::string>{"density"}) return std::nullopt;
  if (place.section == "materials" || place.section == "interfaces") {
    current_.declare(place, &*law_, live);
    law_.set_from_outside();
  } else if (place.section != "engines") {
    if (!number->is_declared()) return std::nullopt;  // a geometry is constructed again instead
    return Number{*number, std::nullopt};
  } else if (!engines_.declare(place.name, live)) {
    return std::nullopt;
  }
  const auto in_instance = CheckedNumber::find(live, place.keys);
  return in_instance ? std::optional(Number{*number, in_instance}) : std::nullopt;
}

void LiveScene::go_to(std::size_t stage, std::size_t increments) {
  while (current_.next_stage() <= stage) current_.begin_stage();
  current_.advance_ramps(increments);
  follow();
}

void LiveScene::follow() {
  numbers_.clear();
  law_.follow(now());
  engines_.follow(now());
  geometries_.follow(now());
  components_.engines = engines_.all(), components_.geometries = geometries_.all();
}

}  // namespace grit
