#include "simulation/live_components.hpp"

#include "description/placed_error.hpp"

namespace grit {
namespace {

template <class Interface>
std::shared_ptr<Interface> prepared_instance(const Component<Interface>& described,
                                             const std::vector<std::string>& keys, const ReportFault& report) try {
  auto made = described.make();
  made->prepare();
  return made;
} catch (const PluginError&) {
  throw;
} catch (const ParameterError& error) {
  for (const PlacedError::Fault& fault : placed(error, keys)) report(fault.keys, fault.message);
  return nullptr;
} catch (const Error& error) {
  report(keys, error.what());
  return nullptr;
}

/// Drops entries of `live` that are not in `described`.
template <class Live, class Described>
void drop_others(Live& live, const Described& described) {
  std::erase_if(live, [&](const auto& one) { return !described.contains(one.first); });
}

}  // namespace

void throw_fault(const std::vector<std::string>& keys, const std::string& message) { throw PlacedError(keys, message); }

LiveLaw::LiveLaw(const SceneDescription& described) : law_(described.contacts.make()) { follow(described); }

bool LiveLaw::follow(const SceneDescription& now) {
  if (materials_ == now.materials && interfaces_ == now.interfaces) return false;
  materials_ = now.materials, interfaces_ = now.interfaces;
  law_->clear_materials();
  for (const auto& [name, material] : materials_) {
    Parameters parameters;
    law_->declare_material(name, parameters);
    assign(parameters, material.values);
  }
  for (const InterfaceDescription& one : interfaces_) {
    Parameters parameters;
    law_->declare_interface(one.a, one.b, parameters);
    assign(parameters, one.values);
  }
  return true;
}

std::optional<NumberPlace> LiveLaw::number(const NumberPointer& place) {
  Parameters parameters;
  if (place.section == "materials") {
    law_->declare_material(place.name, parameters);
  } else if (place.section == "interfaces") {
    const InterfaceDescription one(place.name);
    law_->declare_interface(one.a, one.b, parameters);
  } else {
    return std::nullopt;
  }
  set_from_outside();
  return find_number(parameters, place.keys);
}

void LiveEngines::follow(const SceneDescription& now) {
  std::erase_if(engines_,
                [&](const auto& one) { return !now.engines.contains(one.first) && !added_.contains(one.first); });
  drop_others(described_, now.engines);
  for (const auto& [name, engine] : now.engines) {
    if (added_.contains(name))
      throw PlacedError({"engines", name}, "found an engine that the program has added before; choose another name");
    const Component<Engine>& wanted = engine.engine;
    const auto known = described_.find(name);
    const bool is_set = set_from_outside_.erase(name) > 0;
    if (!is_set && known != described_.end() && known->second == wanted) continue;
    if (known != described_.end() && known->second.type() == wanted.type()) wanted.assign_to(*engines_.at(name));
    else engines_[name] = wanted.make();
    described_.insert_or_assign(name, wanted);
  }
}

std::optional<NumberPlace> LiveEngines::number(const NumberPointer& place) {
  Parameters parameters;
  if (place.section != "engines" || !declare(place.name, parameters)) return std::nullopt;
  return find_number(parameters, place.keys);
}

bool LiveEngines::declare(const std::string& name, Parameters& parameters) {
  const auto engine = engines_.find(name);
  if (engine == engines_.end()) return false;
  engine->second->declare(parameters);
  set_from_outside_.insert(name);
  return true;
}

void LiveEngines::set_added(const std::string& name, std::shared_ptr<Engine> engine) {
  if (engine) {
    engines_[name] = std::move(engine);
    added_.insert(name);
  } else if (added_.erase(name) > 0) {
    engines_.erase(name);
  }
}

std::shared_ptr<Engine> LiveEngines::added(const std::string& name) const {
  return added_.contains(name) ? engines_.at(name) : nullptr;
}

bool LiveGeometries::follow(const SceneDescription& now, const ReportFault& report) {
  drop_others(geometries_, now.walls);
  drop_others(described_, now.walls);
  bool changed = false;
  for (const auto& [name, wall] : now.walls) {
    if (const auto known = described_.find(name); known != described_.end() && known->second == wall.geometry) continue;
    changed = true;
    described_.insert_or_assign(name, wall.geometry);
    if (auto made = prepared_instance(wall.geometry, {"walls", name}, report)) geometries_[name] = std::move(made);
    else geometries_.erase(name);
  }
  return changed;
}

std::shared_ptr<BodyKind> prepared(const Component<BodyKind>& described, const std::vector<std::string>& keys,
                                   const ReportFault& report) {
  return prepared_instance(described, keys, report);
}

}  // namespace grit
