#include "motion/builtin.hpp"

#include <algorithm>
#include <array>
#include <type_traits>
#include <variant>

#include "bodies/regions.hpp"
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

class DensityScaling final : public Engine {
 public:
  void declare(Parameters& p) override {
    p.add("below", below_)
        .unit("m")
        .above(0)
        .required()
        .doc(
            "bodies with a smaller diameter get the mass and the moments of inertia of a body of this diameter; their "
            "weight is unchanged");
  }
  Phase phase() const override { return Phase::settings; }
  void settings(MotionSettings& settings) const override {
    settings.scaled_radius = std::max(settings.scaled_radius, 0.5 * below_);
  }

 private:
  double below_ = 0;
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
    const std::vector<std::string> axes{"none", "x", "y", "z", "xy", "xz", "yz", "xyz"};
    p.add("rotation", rotation_)
        .one_of(axes)
        .doc(
            "axes about which spins stay constant; for clumps, the angular momentum about them, so that their spin "
            "varies as they turn, since their moments of inertia differ");
    p.add("translation", translation_).one_of(axes).doc("axes along which velocities stay constant");
  }
  Phase phase() const override { return Phase::settings; }
  void settings(MotionSettings& settings) const override {
    add(rotation_, settings.held_rotation), add(translation_, settings.held_translation);
  }

 private:
  static void add(const std::string& axes, std::array<bool, 3>& held) {
    for (std::size_t k = 0; k < 3; ++k) held[k] |= axes != "none" && axes.find("xyz"[k]) != std::string::npos;
  }

  std::string rotation_ = "xyz", translation_ = "none";
};

class PrescribedMotion final : public Engine {
 public:
  void declare(Parameters& p) override {
    p.add("velocity", motion_.velocity).unit("m/s").symbol("v").doc("velocity of the bodies; default: fixed");
    p.add("spin", motion_.spin).unit("rad/s").symbol("omega").doc("angular velocity as one rigid body, right-handed");
    p.add("about", motion_.about).unit("m").doc("a point of the axis of rotation, which is fixed in space");
  }
  Phase phase() const override { return Phase::settings; }
  void settings(MotionSettings& settings) const override { settings.prescribed = motion_; }

 private:
  RigidMotion motion_;
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

class Sink final : public Engine {
 public:
  void declare(Parameters& p) override {
    p.add("region", region_)
        .required()
        .doc(
            "where bodies are removed: at the first neighbour search after the centre enters, that is within a "
            "fraction "
            "of a diameter of travel; they count as discharged");
  }
  Phase phase() const override { return Phase::removal; }
  bool removes(const World&, const Vec3& centre) const override {
    const auto has_centre = [&]<class Region>(const Region& region) {
      if constexpr (std::is_same_v<Region, std::monostate>) return false;
      else return contains(region, centre);
    };
    return std::visit(has_centre, region_.value());
  }

 private:
  OneOf<BoxRegion, CylinderRegion, SphereRegion, HalfSpaceRegion> region_{"region"};
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
  static const std::array<PluginInfo, 8> engines{
      engine<Gravity>("gravity", "the same acceleration for every body"),
      engine<Drag>("drag", "drag of a fluid: Stokes, or Schiller and Naumann"),
      engine<DensityScaling>("density-scaling", "more inertia of small bodies, for a longer time step"),
      engine<LocalDamping>("local-damping", "Cundall's non-viscous damping of forces and moments"),
      engine<Hold>("hold", "holds spins or velocities of bodies constant"),
      engine<PrescribedMotion>("prescribed-motion",
                               "bodies move as one rigid body, or are fixed, whatever the forces on them are"),
      engine<Sink>("sink", "removes the bodies that enter a region"),
      engine<Planar>("planar", "restricts bodies to planar motion: a two-dimensional model")};
  return engines;
}

}  // namespace grit
