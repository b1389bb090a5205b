#include "grit/geometry.hpp"
#include "throwing.hpp"

namespace {

/// The plane z = 0, solid below, drawn as a square of 2 m.
struct Floor final : grit::Geometry {
  void declare(grit::Parameters& p) override { throwing::declare("declare()", p); }
  void prepare() override { throwing::here("prepare()"); }
  grit::Bounds bounds() const override { return throwing::here("bounds()"), grit::Bounds{{-1, -1, 0}, {1, 1, 0}}; }
  bool hollow() const override { return throwing::here("hollow()"), false; }
  double area() const override { return throwing::here("area()"), 4; }
  grit::Vec3 normal() const override { return throwing::here("normal()"), grit::Vec3(0, 0, 1); }
  bool flat() const override { return throwing::here("flat()"), true; }
  void find_contacts(const grit::Pose& pose, std::span<const grit::Sphere> spheres,
                     std::vector<grit::SurfaceContact>& contacts) const override {
    throwing::here("find_contacts()");
    for (const grit::Sphere& sphere : spheres)
      if (const double overlap = sphere.radius - pose.to_local(sphere.centre).z(); overlap > 0)
        contacts.push_back({pose.turn * grit::Vec3(0, 0, -1), overlap, sphere.body, 0});
  }
  bool near(const grit::Pose& pose, const grit::Vec3& centre, double reach) const override {
    throwing::here("near()");
    return pose.to_local(centre).z() < reach;
  }
  std::vector<grit::Vec3> triangles() const override {
    throwing::here("triangles()");
    return {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  }
  std::optional<std::uint32_t> triangle_of(std::uint32_t) const override {
    throwing::here("triangle_of()");
    return {};
  }
};

}  // namespace

const grit::PluginInfo* grit_plugin() {
  return throwing::plugin("geometry", "throwing", [](grit::PluginInfo& info) {
    info.make_geometry = []() -> grit::Geometry* { return throwing::here("make_geometry()"), new Floor; };
  });
}
