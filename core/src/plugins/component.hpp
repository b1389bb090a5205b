// A plugin that a description selects by name.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "grit/body_kind.hpp"
#include "grit/contact/contact_law.hpp"
#include "grit/description.hpp"
#include "grit/engine.hpp"
#include "grit/geometry.hpp"
#include "grit/probe.hpp"
#include "grit/scenario.hpp"
#include "plugins/parameter_values.hpp"
#include "plugins/registry.hpp"

namespace grit {

/// A choice of an installed plugin of one kind: its name and the values of all its parameters. An instance exists only
/// while they are read.
template <class Interface>
class Component : public Choice {
 public:
  explicit Component(const Registry& registry) : registry_(&registry) {}
  std::string what() const override { return kind_name<Interface>(); }
  std::vector<std::string> types() const override { return registry_->names(kind_name<Interface>()); }
  std::string type_doc(const std::string& type) const override {
    return registry_->info(kind_name<Interface>(), type).doc;
  }
  std::string how_to_add() const override { return registry_->search_text(kind_name<Interface>()); }
  std::string type() const override { return type_; }
  void choose(const std::string& type) override {
    prototype_ = registry_->make<Interface>(type);
    type_ = type, values_ = Description::object();
  }
  void declare(Parameters& parameters) override {
    if (!prototype_) return parameters.add_values(values_);
    prototype_->declare(parameters);
    parameters.when_read([this] {
      Parameters own;
      prototype_->declare(own);
      values_ = write(own);
      prototype_.reset();
    });
  }
  std::unique_ptr<Choice> twin() const override { return std::make_unique<Component>(*registry_); }

  /// Values of all parameters, in SI.
  const Description& values() const { return values_; }
  bool operator==(const Component& other) const { return type_ == other.type_ && values_ == other.values_; }

  /// A new instance with these values, not yet prepared. One must have been chosen. Throws PluginError.
  std::shared_ptr<Interface> make() const {
    auto made = registry_->make<Interface>(type_);
    if (!prototype_) assign_to(*made);
    return made;
  }
  /// Sets the parameters of an instance of this type to these values.
  void assign_to(Interface& instance) const {
    Parameters own;
    instance.declare(own);
    assign(own, values_);
  }

 private:
  const Registry* registry_;
  std::string type_;
  Description values_ = Description::object();
  std::shared_ptr<Interface> prototype_;  // only while it is read
};

}  // namespace grit
