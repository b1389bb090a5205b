#include "bodies/sphere_body.hpp"

#include <numbers>

namespace grit {

double SphereBody::volume(double radius) const { return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius; }

double SphereBody::inertia(double radius, double mass) const { return 0.4 * mass * radius * radius; }

const PluginInfo& sphere_body() {
  static const PluginInfo info = [] {
    PluginInfo sphere;
    sphere.kind = "body", sphere.name = "sphere", sphere.version = "1.0.0";
    sphere.doc = "solid sphere";
    sphere.make_body = []() -> BodyKind* { return new SphereBody; };
    return sphere;
  }();
  return info;
}

}  // namespace grit
