// Live components that follow a description: made once, and updated as the description changes.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "description/components.hpp"
#include "description/current_scene.hpp"
#include "description/description.hpp"

namespace grit {

/// Reports a fault of a component: its keys from the root of the description, and the message.
using ReportFault = std::function<void(const std::vector<std::string>& keys, const std::string& message)>;
/// Throws the fault as a PlacedError.
void throw_fault(const std::vector<std::string>& keys, const std::string& message);

/// The contact law, with the materials and interfaces of a description.
class LiveLaw {
 public:
  explicit LiveLaw(const SceneDescription& described);
  /// Updates materials and interfaces that differ. Returns whether any did.
  bool follow(const SceneDescription& now);
  ContactLaw& operator*() const { return *law_; }
  ContactLaw* operator->() const { return law_.get(); }
  const std::shared_ptr<ContactLaw>& get() const { return law_; }
  /// Binds a number of a material or an interface; empty if the law has no such parameter.
  std::optional<NumberPlace> number(const NumberPointer& place);
  /// Says that a material or an interface is set from outside, so that it is not what was described.
  void set_from_outside() { materials_.clear(); }

 private:
  std::shared_ptr<ContactLaw> law_;
  std::map<std::string, MaterialDescription> materials_;
  std::vector<InterfaceDescription> interfaces_;
};

/// The engines of a description, and those that a program adds. An engine of the description keeps its instance and
/// state as long as its type does not change.
class LiveEngines {
 public:
  void follow(const SceneDescription& now);
  const std::map<std::string, std::shared_ptr<Engine>>& all() const { return engines_; }
  /// Binds a number of an engine.
  std::optional<NumberPlace> number(const NumberPointer& place);
  /// Declares an engine, which is set from outside from now on. False if there is none of this name.
  bool declare(const std::string& name, Parameters& parameters);
  /// Adds, replaces or removes (null) an engine that is in no description.
  void set_added(const std::string& name, std::shared_ptr<Engine> engine);
  /// Null if there is none of this name.
  std::shared_ptr<Engine> added(const std::string& name) const;

 private:
  std::map<std::string, std::shared_ptr<Engine>> engines_;  // all of them
  std::set<std::string> added_;
  std::map<std::string, Component<Engine>> described_;
  std::set<std::string> set_from_outside_;  // by a bound number, so that they differ from the description
};

/// The geometries of walls, each prepared once and replaced when its values change.
class LiveGeometries {
 public:
  /// Returns whether there was a change. A geometry that cannot be made or prepared is reported and omitted.
  bool follow(const SceneDescription& now, const ReportFault& report = throw_fault);
  const std::map<std::string, std::shared_ptr<const Geometry>>& all() const { return geometries_; }

 private:
  std::map<std::string, std::shared_ptr<const Geometry>> geometries_;
  std::map<std::string, Component<Geometry>> described_;
};

/// A prepared instance; null if it cannot be made or prepared, which is reported at `keys`.
std::shared_ptr<BodyKind> prepared(const Component<BodyKind>& described, const std::vector<std::string>& keys,
                                   const ReportFault& report);

}  // namespace grit
