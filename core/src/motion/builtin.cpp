#include "motion/builtin.hpp"

#include <array>

#include "grit/engine.hpp"
#include "motion/drag.hpp"

namespace grit {
namespace {

class Gravity final : public Engine {
 public:
  void declare(Parameters& p) override {
    p.add("acceleration", acceleration_).unit("m/s^2").symbol("g").doc("acceleration of every body");
  }
  Phase phase() const override { return Phase::settings; }
  void settings(MotionSettings& settings) const override { settings.gravity += acceleration_; }

 private:
  Vec3 acceleration_{0, 0, -9.81};
};

class LocalDamping final : public Engine {
 public:
  void declare(Parameters& p) override {
    p.add("coefficient", coefficient_)
        .symbol("lambda")
        .at_least(0)
        .below(1)
        .doc(
            "reduces forces that accelerate a body, increases those that decelerate it: F (1 - lambda sgn(F v)), each "
            "component");
  }
  Phase phase() const override { return Phase::settings; }
  void settings(MotionSettings& settings) const override { settings.local_damping = coefficient_; }

 private:
  double coefficient_ = 0.08;
};

class Hold final : public Engine {
 public:
  void declare(Parameters& p) override {
    p.add("rotation", rotation_).doc("keep the spins of bodies constant");
    p.add("translation", translation_).doc("keep the velocities of bodies constant");
  }
  Phase phase() const override { return Phase::settings; }
  void settings(MotionSettings& settings) const override {
    settings.hold_rotation |= rotation_, settings.hold_translation |= translation_;
  }

 private:
  bool rotation_ = true, translation_ = false;
};

class Planar final : public Engine {
 public:
  void declare(Parameters& p) override {
    p.add("normal", normal_)
        .one_of({"x", "y", "z"})
        .doc("axis without translation; bodies rotate about this axis only");
  }
  Phase phase() const override { return Phase::settings; }
  void settings(MotionSettings& settings) const override { settings.flat = normal_[0] - 'x'; }

 private:
  std::string normal_ = "y";
};

template <class T>
PluginInfo engine(const char* name, const char* doc) {
  PluginInfo info;
  info.kind = "engine", info.name = name, info.version = "1.0.0", info.doc = doc;
  info.make_engine = []() -> Engine* { return new T; };
  return info;
}

}  // namespace

std::span<const PluginInfo> builtin_engines() {
  static const std::array<PluginInfo, 5> engines{
      engine<Gravity>("gravity", "the same acceleration for every body"),
      engine<Drag>("drag", "drag of a fluid: Stokes, or Schiller and Naumann"),
      engine<LocalDamping>("local-damping", "Cundall's non-viscous damping of forces and moments"),
      engine<Hold>("hold", "holds spins or velocities of bodies constant"),
      engine<Planar>("planar", "restricts bodies to planar motion: a two-dimensional model")};
  return engines;
}

}  // namespace grit
