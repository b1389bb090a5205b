// Tests that every geometry must pass. A plugin's test lists its cases:
//   INSTANTIATE_TEST_SUITE_P(Plane, GeometryContract, testing::Values(…), case_name);
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <ostream>
#include <random>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "grit/error.hpp"
#include "grit/geometry.hpp"

namespace grit {

using Setting = std::variant<double, bool, Vec3, std::string, std::vector<std::string>>;

/// Makes a geometry as from a description: declares, sets, checks and prepares it. Throws grit::Error with the
/// complaints of its checks.
template <class G>
std::shared_ptr<G> made(const std::vector<std::pair<std::string, Setting>>& settings) {
  auto geometry = std::make_shared<G>();
  Parameters parameters;
  geometry->declare(parameters);
  for (const auto& setting : settings) {
    const auto found = std::find_if(parameters.entries().begin(), parameters.entries().end(),
                                    [&](const Parameter& parameter) { return parameter.name() == setting.first; });
    if (found == parameters.entries().end()) throw Error("there is no parameter " + setting.first);
    std::visit(
        [&]<class T>(const T& value) {
          if (const auto plain = std::get_if<T*>(&found->target())) **plain = value;
          if constexpr (std::same_as<T, double>)
            if (const auto maybe = std::get_if<std::optional<double>*>(&found->target())) **maybe = value;
        },
        setting.second);
  }
  std::string complaints;
  for (const auto& check : parameters.checks())
    check.run([&](std::string_view key, std::string_view what, std::string_view allowed) {
      complaints += std::string(key) + ": found " + std::string(what) + ", allowed: " + std::string(allowed) + "; ";
    });
  if (!complaints.empty()) throw Error(complaints);
  geometry->prepare();
  return geometry;
}

/// A straight path of a sphere's centre [m].
struct Path {
  Vec3 from, to;
};

/// A geometry with the properties that the tests need.
struct GeometryCase {
  std::string name;
  std::shared_ptr<const Geometry> geometry;
  Bounds where;                   ///< random centres of spheres lie in this box [m]
  double radius;                  ///< of the largest sphere [m]; the smallest has half of it
  std::vector<Path> flanks = {};  ///< paths with exactly one contact, always of the same feature
  std::vector<Path> across = {};  ///< paths along which forces must be continuous
  double facet_error = 0;         ///< maximum distance of the surface from its triangles [m]
  /// Whether a contact may continue on another feature with nearly the same normal; the kernel then keeps its history.
  bool hands_on = false;
  /// Smallest radius of concave curvature [m].
  double hollow_radius = std::numeric_limits<double>::infinity();
  /// Whether a body may have its centre here; false behind a one-sided face.
  std::function<bool(const Vec3&)> in_front = [](const Vec3&) { return true; };
};

inline void PrintTo(const GeometryCase& one, std::ostream* out) { *out << one.name; }
inline std::string case_name(const testing::TestParamInfo<GeometryCase>& info) { return info.param.name; }

/// The contacts of one sphere.
inline std::vector<SurfaceContact> contacts_of(const Geometry& geometry, const Vec3& centre, double radius,
                                               const Pose& pose = {}) {
  const Sphere sphere{centre, radius, 0};
  std::vector<SurfaceContact> contacts;
  geometry.find_contacts(pose, {&sphere, 1}, contacts);
  return contacts;
}

/// The point of a triangle that is closest to p: Ericson, Real-Time Collision Detection (2005), 5.1.5.
inline Vec3 closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return a;
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b);
  return a + (vb * ab + vc * ac) / (va + vb + vc);
}

/// What every geometry must fulfil.
class GeometryContract : public testing::TestWithParam<GeometryCase> {
 protected:
  const GeometryCase& one() const { return GetParam(); }
  const Geometry& shape() const { return *one().geometry; }
  double size() const { return (one().where.high - one().where.low).norm(); }
  double rounding() const { return 1e-14 * (size() + one().where.low.norm() + one().where.high.norm()); }

  double draw(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Vec3 draw(const Vec3& low, const Vec3& high) {
    return {draw(low.x(), high.x()), draw(low.y(), high.y()), draw(low.z(), high.z())};
  }
  Sphere draw_sphere() {
    return {draw(one().where.low, one().where.high), draw(0.5, 1) * one().radius,
            static_cast<std::uint32_t>(random_())};
  }
  Pose draw_pose() {
    const Vec3 box = Vec3::Constant(size());
    const Vec3 axis = draw(-Vec3::Ones(), Vec3::Ones()).normalized();
    return {draw(one().where.low, one().where.high), draw(-box, box),
            Eigen::AngleAxisd(draw(-3, 3), axis).toRotationMatrix()};
  }
  double distance(const Vec3& point) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 2 < triangles_.size(); i += 3)
      least = std::min(
          least, (closest_on_triangle(point, triangles_[i], triangles_[i + 1], triangles_[i + 2]) - point).norm());
    return least;
  }
  void SetUp() override {
    triangles_ = shape().triangles();
    ASSERT_FALSE(triangles_.empty()) << "give the geometry an extent that contains the box `where`";
  }

  static constexpr int samples = 4000;
  std::mt19937_64 random_{20240607};
  std::vector<Vec3> triangles_;
};

/// Links the tests into a program that includes this file.
int geometry_contract();
inline const int geometry_contract_is_linked = geometry_contract();

}  // namespace grit
