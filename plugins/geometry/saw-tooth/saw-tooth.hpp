// A rectangular sheet with straight grooves cut into it.
#pragma once

#include <array>
#include <numbers>
#include <optional>
#include <utility>

#include "grit/toolkit/sheet.hpp"

namespace grit {

/// The face is made of teeth, each of two flanks and the land between them, and of the floors of grooves where those
/// are not sharp. A tooth and a floor are convex: each is touched where it is closest, once a sphere, and is one
/// feature. Teeth have even numbers, floors odd ones, rising along edge a.
class SawTooth : public Geometry {
 public:
  void declare(Parameters& p) override;
  void prepare() override;
  Bounds bounds() const override;
  /// Of the sheet, not of the flanks.
  double area() const override { return sheet_.length_a * sheet_.length_b; }
  /// Of the sheet.
  Vec3 normal() const override { return sheet_.axes.col(2); }
  void touch(const Pose& pose, std::span<const Sphere> spheres, std::vector<Touch>& touches) const override;
  bool near(const Pose& pose, const Vec3& centre, double reach) const override;
  std::vector<Vec3> triangles() const override;

 private:
  using Vec2 = Eigen::Vector2d;  // in the section across the grooves: along edge a, and above the sheet

  /// A straight part of the section; `start` is told from where its period starts.
  struct Face {
    Vec2 start, along, normal;  // the latter two unit
    double length;
    bool from_valley, to_valley;
  };
  struct Closest;
  struct Several;
  struct Standing;
  struct Touched;
  struct Widths {
    double falling, floor, rising, spacing;  // the flanks' are those of their projections on the sheet
    double groove() const { return falling + floor + rising; }
  };

  Widths widths() const;
  double period_start(int feature) const { return start_ + feature / 2 * spacing_; }
  int feature_at(double a) const;
  std::span<const Face> faces(int feature) const;
  std::optional<std::pair<double, double>> extent(int feature, const Face& face) const;
  Closest closest(int feature, const Vec2& centre) const;
  Vec3 beyond(const Vec3& place) const;
  void touch(const Sheet::Frame& at, const Sphere& sphere, std::vector<Touch>& touches) const;
  void touch(const Standing& sheet, const Several& spheres, std::array<Touched, 3>& teeth) const;

  Sheet sheet_;
  double depth_ = 0, inclination_ = std::numbers::pi / 4, floor_ = 0, offset_ = 0;
  std::optional<double> second_inclination_, given_spacing_;
  double spacing_ = 1, start_ = 0, tooth_ = 1;  // of a period: length, start of the first, width of its tooth
  double per_spacing_ = 1;
  int first_ = 0, last_ = 0;     // features on the sheet
  std::array<Face, 4> faces_{};  // of a period: rising flank, land, falling flank, floor
};

}  // namespace grit
