// The built-in body kind "sphere".
#pragma once

#include "grit/body_kind.hpp"
#include "grit/plugin.hpp"

namespace grit {

/// A solid sphere: volume 4/3 π r³, inertia 2/5 m r².
class SphereBody : public BodyKind {
 public:
  void declare(Parameters&) override {}
  double volume(double radius) const override;
  double inertia(double radius, double mass) const override;
};

/// For Registry::add().
const PluginInfo& sphere_body();

}  // namespace grit
