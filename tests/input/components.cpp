#include "components.hpp"

#include <numbers>

#include "grit/body_kind.hpp"
#include "grit/contact/contact_law.hpp"
#include "grit/engine.hpp"
#include "grit/error.hpp"
#include "grit/geometry.hpp"
#include "grit/probe.hpp"
#include "grit/scenario.hpp"

namespace grit {
namespace {

struct SpringMaterial {
  double modulus = 300e6, friction_angle = 18 * std::numbers::pi / 180;
  void declare(Parameters& p) {
    p.add("contact_modulus", modulus).unit("Pa").symbol("E_c").above(0).doc("modulus of the spring");
    p.add("friction_angle", friction_angle)
        .unit("rad")
        .symbol("phi")
        .at_least(0)
        .below(std::numbers::pi / 2)
        .doc("angle of friction");
  }
};
struct SpringInterface {
  std::optional<double> friction_angle;
  void declare(Parameters& p) {
    p.add("friction_angle", friction_angle)
        .unit("rad")
        .at_least(0)
        .below(std::numbers::pi / 2)
        .doc("angle of friction");
  }
};
struct GlueMaterial {
  double strength = 0;
  void declare(Parameters& p) {
    p.add("strength", strength).unit("Pa").at_least(0).required().doc("strength of the glue");
  }
};
struct GlueInterface {
  double fraction = 0.5;
  void declare(Parameters& p) { p.add("share", fraction).at_least(0).at_most(1).doc("fraction of the strength"); }
};

template <class Material, class Interface>
class Law final : public ContactLaw {
 public:
  void declare(Parameters& p) override {
    p.add("limit_radius", limit_radius_).one_of({"mean", "smaller"}).doc("radius in the limit");
  }
  void clear_materials() override { materials_.clear(), interfaces_.clear(); }
  void declare_material(const std::string& name, Parameters& p) override { materials_[name].declare(p); }
  void declare_interface(const std::string& a, const std::string& b, Parameters& p) override {
    interfaces_[std::minmax(a, b)].declare(p);
  }
  void mix(std::span<const std::string>, std::size_t) override {}
  std::vector<StateField> state() const override { return {}; }
  LawLoop loop() const override { return {}; }
  void evaluate_pairs(PairBatch&) const noexcept override {}
  void evaluate_walls(WallBatch&) const noexcept override {}
  void evaluate_pairs_reference(PairBatch&) const noexcept override {}
  Stiffness stiffness(const PairSize&, std::size_t, std::size_t) const override { return {}; }
  std::vector<double> mixed(std::size_t, std::size_t, bool) const override { return {}; }
  ElasticEnergy energy(const PairSize&, std::size_t, std::size_t, std::span<const double>) const override { return {}; }

 private:
  std::string limit_radius_ = "mean";
  std::map<std::string, Material> materials_;
  std::map<std::pair<std::string, std::string>, Interface> interfaces_;
};

class SphereKind final : public BodyKind {
 public:
  void declare(Parameters&) override {}
  double volume(double) const override { return 0; }
  double inertia(double, double) const override { return 0; }
};

class Shape : public Geometry {
 public:
  Bounds bounds() const override { return {}; }
  double area() const override { return 0; }
  Vec3 normal() const override { return Vec3::Zero(); }
  void find_contacts(const Pose&, std::span<const Sphere>, std::vector<SurfaceContact>&) const override {}
  bool near(const Pose&, const Vec3&, double) const override { return false; }
  std::vector<Vec3> triangles() const override { return {}; }
};
class PlaneShape final : public Shape {
 public:
  void declare(Parameters& p) override {
    p.add("position", position_).unit("m").required().doc("a point of it");
    p.add("normal", normal_).doc("normal towards the bodies");
  }
  double area() const override { return 1; }
  Vec3 normal() const override { return normal_; }

 private:
  Vec3 position_ = Vec3::Zero(), normal_ = Vec3::UnitZ();
};
class MeshShape final : public Shape {
 public:
  void declare(Parameters& p) override { p.add("path", path_).file().required().doc("STL file"); }

 private:
  std::string path_;
};

class GravityEngine final : public Engine {
 public:
  void declare(Parameters& p) override {
    p.add("acceleration", acceleration_).unit("m/s^2").symbol("g").doc("acceleration of all bodies");
  }
  Phase phase() const override { return Phase::settings; }

 private:
  Vec3 acceleration_{0, 0, -9.81};
};
class DampingEngine final : public Engine {
 public:
  void declare(Parameters& p) override {
    p.add("ratio", ratio_).symbol("lambda").at_least(0).below(1).doc("fraction of the force");
  }
  Phase phase() const override { return Phase::settings; }

 private:
  double ratio_ = 0.1;
};

class CurveProbe final : public Probe {
 public:
  void declare(Parameters& p) override { p.add("wall", wall_).required().doc("name of the wall"); }
  std::vector<Channel> channels() const override { return {}; }
  void sample(const World&, ChannelValues&) override {}

 private:
  std::string wall_;
};

Description pile(std::int64_t grains, double height) {
  return {{"title", "a pile"},
          {"contacts", {{"type", "spring"}}},
          {"materials", {{"sand", {{"density", 2650}}}}},
          {"bodies",
           {{"grains",
             {{"type", "sphere"},
              {"material", "sand"},
              {"source",
               {{"type", "cloud"},
                {"low", {0, 0, 0}},
                {"high", {height, height, height}},
                {"count", grains},
                {"sizes", {{"type", "uniform"}}}}}}}}},
          {"walls", {{"floor", {{"type", "plane"}, {"position", {0, 0, 0}}, {"material", "sand"}}}}},
          {"stages",
           Description::array({{{"name", "settle"}, {"until", {{"type", "time"}, {"value", 0.5}}}, {"limit", 1}}})}};
}

class PileScenario final : public Scenario {
 public:
  void declare(Parameters& p) override {
    p.add("grains", grains_).at_least(1).doc("number of grains");
    p.add("height", height_).unit("m").above(0).doc("height of the cloud");
    p.add("outline", outline_).file().doc("text file that is not read");
  }
  Description expand() const override {
    std::vector<ParameterError::Fault> faults;
    if (height_ > 100) faults.push_back({"height", std::to_string(height_) + " m", "at most 100 m"});
    if (grains_ > 1000) faults.push_back({"grains", std::to_string(grains_), "at most 1000"});
    if (!faults.empty()) throw ParameterError(faults);
    if (static_cast<double>(grains_) * height_ > 1e4) throw Error("the pile does not fit; allowed are fewer grains");
    return pile(grains_, height_);
  }

 private:
  std::int64_t grains_ = 10;
  double height_ = 0.1;
  std::string outline_;
};
class CarelessScenario final : public Scenario {
 public:
  void declare(Parameters&) override {}
  Description expand() const override {
    Description plain = pile(10, 0.1);
    plain["walls"]["floor"]["colour"] = "red";
    return plain;
  }
};

PluginInfo named(const char* kind, const char* name) {
  PluginInfo info;
  info.kind = kind, info.name = name, info.version = "1.0.0";
  return info;
}
template <class Made>
PluginInfo with(PluginInfo info, Made* (*PluginInfo::*maker)(), Made* (*make)()) {
  info.*maker = make;
  return info;
}

}  // namespace

void add_components(Registry& registry) {
  using Spring = Law<SpringMaterial, SpringInterface>;
  using Glue = Law<GlueMaterial, GlueInterface>;
  static const std::vector<PluginInfo> all{
      with<ContactLaw>(named("contact", "spring"), &PluginInfo::make_contact,
                       []() -> ContactLaw* { return new Spring; }),
      with<ContactLaw>(named("contact", "glue"), &PluginInfo::make_contact, []() -> ContactLaw* { return new Glue; }),
      with<BodyKind>(named("body", "sphere"), &PluginInfo::make_body, []() -> BodyKind* { return new SphereKind; }),
      with<Geometry>(named("geometry", "plane"), &PluginInfo::make_geometry,
                     []() -> Geometry* { return new PlaneShape; }),
      with<Geometry>(named("geometry", "mesh"), &PluginInfo::make_geometry,
                     []() -> Geometry* { return new MeshShape; }),
      with<Engine>(named("engine", "gravity"), &PluginInfo::make_engine, []() -> Engine* { return new GravityEngine; }),
      with<Engine>(named("engine", "damping"), &PluginInfo::make_engine, []() -> Engine* { return new DampingEngine; }),
      with<Probe>(named("probe", "curve"), &PluginInfo::make_probe, []() -> Probe* { return new CurveProbe; }),
      with<Scenario>(named("scenario", "pile"), &PluginInfo::make_scenario,
                     []() -> Scenario* { return new PileScenario; }),
      with<Scenario>(named("scenario", "careless"), &PluginInfo::make_scenario,
                     []() -> Scenario* { return new CarelessScenario; })};
  for (const auto& info : all) registry.add(info);
}

}  // namespace grit
