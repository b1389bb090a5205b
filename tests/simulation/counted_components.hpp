// Components that count how often they are made and prepared, and an engine with state.
#pragma once

#include <cstdint>

#include "support/scene.hpp"

namespace grit::test {

/// Events of components since the last reset.
struct Counts {
  int engines = 0, geometries = 0, prepared = 0;
};
inline Counts& counts() {
  static Counts all;
  return all;
}

/// Counts its calls, and sums its strength; applies no force.
class Tally final : public Engine {
 public:
  Tally() { ++counts().engines, last() = this; }
  void declare(Parameters& p) override {
    p.add("strength", strength).doc("what is added up");
    p.add("limit", limit).doc("does nothing");
    p.add("shape", shape).doc("does nothing");
  }
  Phase phase() const override { return Phase::forces; }
  void forces(const World&, std::span<Row>, std::span<Row>) const override { ++calls, sum += strength; }
  void serialize(Archive& archive) override { archive(calls, sum); }

  static Tally*& last() {
    static Tally* made = nullptr;
    return made;
  }

  double strength = 1;
  std::optional<double> limit;
  Vec3 shape = Vec3::Zero();
  mutable std::int64_t calls = 0;
  mutable double sum = 0;
};

/// A square that can be prepared once only, and not if `spoilt`.
class Square final : public Geometry {
 public:
  Square() { ++counts().geometries; }
  void declare(Parameters& p) override {
    p.add("height", height).unit("m").doc("of the square");
    p.add("spoilt", spoilt).doc("whether it cannot be prepared");
  }
  void prepare() override {
    ++counts().prepared;
    if (prepared) throw Error("it is prepared already");
    if (spoilt == "key") throw ParameterError({{"spoilt", "a spoilt square", "a whole one"}});
    if (spoilt == "all") throw Error("found nothing to stand on");
    prepared = true;
  }
  Bounds bounds() const override { return {{-1, -1, height}, {1, 1, height}}; }
  double area() const override { return 4; }
  Vec3 normal() const override { return Vec3::UnitZ(); }
  void find_contacts(const Pose&, std::span<const Sphere>, std::vector<SurfaceContact>&) const override {}
  bool near(const Pose&, const Vec3&, double) const override { return false; }
  std::vector<Vec3> triangles() const override { return {}; }

 private:
  double height = 0;
  std::string spoilt;
  bool prepared = false;
};

/// Registered under "tally" and "square".
inline void add_counted() {
  static const PluginInfo tally = [] {
    PluginInfo info;
    info.kind = "engine", info.name = "tally", info.version = "1.0.0", info.doc = "counts its calls";
    info.make_engine = []() -> Engine* { return new Tally; };
    return info;
  }();
  static const PluginInfo square = [] {
    PluginInfo info;
    info.kind = "geometry", info.name = "square", info.version = "1.0.0", info.doc = "a square";
    info.make_geometry = []() -> Geometry* { return new Square; };
    return info;
  }();
  installed().add(tally);
  installed().add(square);
}

/// One grain that flies, a tally, a square, and no stage.
inline Description counted() {
  add_counted();
  Description d = description("linear-rolling", {{"density", 2600}}, {{{0, 0, 1}, 1e-3}});
  d["engines"]["tally"] = {{"type", "tally"}, {"strength", 1}};
  d["walls"]["square"] = {{"type", "square"}, {"material", "grain"}};
  d["time_step"] = {{"value", 1e-6}};
  d["stages"] = Description::array();
  return d;
}

inline Description stage_of(const std::string& name, std::int64_t steps) {
  return {{"name", name}, {"until", {{"type", "steps"}, {"value", steps}}}, {"limit", 1}};
}

inline Description ramp_of(const std::string& pointer, double from, double to, double duration,
                           std::int64_t increments) {
  return {{"pointer", pointer}, {"from", from}, {"to", to}, {"duration", duration}, {"increments", increments}};
}

}  // namespace grit::test
