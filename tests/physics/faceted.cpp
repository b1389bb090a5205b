// Surfaces of plane faces have the same contacts as equal meshes.
#include <gmock/gmock.h>

#include <random>

#include "support/scene.hpp"
#include "support/stl_file.hpp"

namespace grit::test::faceted_tests {
namespace {

struct Faceted {
  std::string name;
  Description wall, as_mesh;
  Vec3 low, high;  ///< region of centres in front of the surface
  double radius;
  std::function<bool(const Vec3&)> in_front = [](const Vec3&) { return true; };
};

std::shared_ptr<const Geometry> geometry(Description wall) {
  Description d = description("linear-frictional", {{"friction_angle", 0.3}}, {{Vec3::Zero(), 1e-3}});
  wall["material"] = "grain";
  d["walls"]["wall"] = std::move(wall);
  const Scene scene = scene_of(d);
  return LiveScene(scene).components().geometries.at("wall");
}

std::vector<SurfaceContact> by_overlap(const Geometry& geometry, const Sphere& sphere) {
  std::vector<SurfaceContact> contacts;
  geometry.find_contacts({}, {&sphere, 1}, contacts);
  std::ranges::sort(contacts, {}, [](const SurfaceContact& t) { return std::tuple(t.overlap, t.normal.x()); });
  return contacts;
}

void expect_like_its_mesh(const Faceted& one) {
  SCOPED_TRACE(one.name);
  const auto shape = geometry(one.wall);
  std::vector<Vec3> corners = shape->triangles();
  if (one.as_mesh.contains("inside"))
    for (std::size_t i = 0; i < corners.size(); i += 3) std::swap(corners[i + 1], corners[i + 2]);
  const StlFile file(stl_text(corners));
  Description wall = one.as_mesh;
  wall["type"] = "mesh", wall["path"] = file.path(), wall["scale"] = 1.0, wall["merge_distance"] = 1e-12;
  const auto mesh = geometry(wall);

  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> draw(0, 1);
  int touching = 0, several = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 share(draw(random), draw(random), draw(random));
    const Sphere sphere{one.low + share.cwiseProduct(one.high - one.low), one.radius, 0};
    if (!one.in_front(sphere.centre)) continue;
    const auto expected = by_overlap(*shape, sphere), found = by_overlap(*mesh, sphere);
    ASSERT_EQ(found.size(), expected.size()) << sphere.centre.transpose();
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_NEAR(found[k].overlap, expected[k].overlap, 1e-13 * one.radius);
      EXPECT_LE((found[k].normal - expected[k].normal).norm(), 1e-11) << sphere.centre.transpose();
    }
    touching += !found.empty(), several += found.size() > 1;
  }
  EXPECT_GT(touching, 1000);
  EXPECT_GT(several, one.wall.value("inside", true) && one.wall["type"] != "rectangle" ? 100 : -1);
}

const Vec3 low(0, 0, 0), high(1, 2, 3);
const Description sheet{{"corner", {0, 0, 0}}, {"edge_a", {2, 0, 0}}, {"edge_b", {0, 1, 0}}};

Description with(const Description& base, const Description& more) {
  Description both = base;
  both.update(more);
  return both;
}

TEST(Faceted, ABoxIsTouchedLikeItsMesh) {
  const Description box{{"type", "box"}, {"low", vector(low)}, {"high", vector(high)}};
  const auto within = [](const Vec3& c) { return (c.array() > low.array()).all() && (c.array() < high.array()).all(); };
  const Vec3 margin = Vec3::Constant(0.4);
  expect_like_its_mesh({"container", box, {{"inside", true}}, low, high, 0.4});
  expect_like_its_mesh(
      {"cup", with(box, {{"open", {"z_high"}}}), {{"inside", true}, {"open", true}}, low, high + Vec3(0, 0, 0.3), 0.4});
  expect_like_its_mesh({"block", with(box, {{"inside", false}}), Description::object(), low - margin, high + margin,
                        0.4, [&](const Vec3& c) { return !within(c); }});
  const auto shallow = [](const Vec3& c) { return std::min(c.minCoeff(), (high - c).minCoeff()) < 0.4; };
  expect_like_its_mesh({"behind", with(box, {{"inside", false}}), Description::object(), low, high, 0.4, shallow});
}

TEST(Faceted, ARectangleIsTouchedLikeItsMesh) {
  const Description wall = with(sheet, {{"type", "rectangle"}});
  const Vec3 from(-0.3, -0.3, -0.3), to(2.3, 1.3, 0.3);
  expect_like_its_mesh({"two-sided", wall, {{"open", true}, {"two_sided", true}}, from, to, 0.25});
  expect_like_its_mesh({"one-sided", with(wall, {{"two_sided", false}}), {{"open", true}}, from, to, 0.25});
}

TEST(Faceted, ASawToothIsTouchedLikeItsMesh) {
  // Above the sheet: past its ends, centres are behind the faces of the mesh.
  const auto grooves = [](const std::string& name, double radius, double down, const Description& more,
                          const Description& crease = Description::object()) {
    const auto surface = geometry(with(with(sheet, {{"type", "saw-tooth"}}), more))->triangles();
    const auto in_front = [surface](const Vec3& c) {
      for (std::size_t i = 0; i < surface.size(); i += 3) {
        const Vec3 &p = surface[i], normal = (surface[i + 1] - p).cross(surface[i + 2] - p);
        const auto [from, to] = std::minmax({p.x(), surface[i + 1].x(), surface[i + 2].x()});
        if (c.x() >= from && c.x() <= to && normal.dot(c - p) < 0) return false;
      }
      return true;
    };
    expect_like_its_mesh({name, with(with(sheet, {{"type", "saw-tooth"}}), more), with({{"open", true}}, crease),
                          Vec3(0.01, 0, -down), Vec3(1.99, 1, 1.1 * radius), radius, in_front});
  };
  grooves("grain like groove", 0.1, 0.1, {{"depth", 0.1}});
  grooves("grain below groove", 0.04, 0.2, {{"depth", 0.2}, {"floor", 0.15}, {"spacing", 0.6}});
  grooves("grain above groove", 0.25, 0.01, {{"depth", 0.01}});
  grooves("ratchet", 0.1, 0.06,
          {{"depth", 0.06}, {"inclination", "30 deg"}, {"second_inclination", "70 deg"}, {"floor", 0.05}});
  grooves("shallow", 0.1, 0.02, {{"depth", 0.02}, {"inclination", "5 deg"}}, {{"feature_angle", 0.0}});
}

}  // namespace
}  // namespace grit::test::faceted_tests
