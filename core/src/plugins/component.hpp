// A plugin that a description chooses by its name.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "grit/body_kind.hpp"
#include "grit/contact/contact_law.hpp"
#include "grit/engine.hpp"
#include "grit/geometry.hpp"
#include "grit/probe.hpp"
#include "grit/scenario.hpp"
#include "plugins/boundary.hpp"
#include "plugins/registry.hpp"

namespace grit {

/// A choice among the installed plugins of one kind; holds the one that was chosen.
template <class Interface>
class Component : public Choice {
 public:
  explicit Component(const Registry& registry) : registry_(&registry) {}
  std::string what() const override { return kind_name<Interface>(); }
  std::vector<std::string> types() const override { return registry_->names(kind_name<Interface>()); }
  std::string type() const override { return type_; }
  void choose(const std::string& type) override {
    instance_ = registry_->make<Interface>(type);
    type_ = type;
  }
  void declare(Parameters& parameters) override {
    if (instance_)
      at_boundary(registry_->title(kind_name<Interface>(), type_), "declare()",
                  [&] { instance_->declare(parameters); });
  }
  std::unique_ptr<Choice> twin() const override { return std::make_unique<Component>(*registry_); }

  Interface* operator->() const { return instance_.get(); }
  Interface& operator*() const { return *instance_; }
  const std::shared_ptr<Interface>& get() const { return instance_; }

 private:
  const Registry* registry_;
  std::string type_;
  std::shared_ptr<Interface> instance_;
};

}  // namespace grit
