// A rectangular sheet with straight grooves cut into it.
#pragma once

#include <array>
#include <numbers>
#include <optional>
#include <utility>

#include "grit/toolkit/sheet.hpp"

namespace grit {

/// The face consists of teeth (flank, land, flank) and of floors where grooves are not sharp. Both are convex: a sphere
/// has at most one contact with each, at its closest point. Each is one feature; teeth have even numbers, floors odd
/// ones, ascending along edge a.
class SawTooth : public Geometry {
 public:
  void declare(Parameters& p) override;
  void prepare() override;
  Bounds bounds() const override;
  /// Of the sheet, not of the flanks.
  double area() const override { return sheet_.length_a * sheet_.length_b; }
  /// Of the sheet.
  Vec3 normal() const override { return sheet_.axes.col(2); }
  void find_contacts(const Pose& pose, std::span<const Sphere> spheres,
                     std::vector<SurfaceContact>& contacts) const override;
  bool near(const Pose& pose, const Vec3& centre, double reach) const override;
  std::vector<Vec3> triangles() const override;

 private:
  using Vec2 = Eigen::Vector2d;  // in the section across the grooves: along edge a, and above the sheet

  /// A straight part of the section; `start` is relative to the start of its period.
  struct Face {
    Vec2 start, along, normal;  // along and normal: unit
    double length;
    bool from_valley, to_valley;
  };
  struct Closest;
  struct SphereLanes;
  struct PlacedSheet;
  struct ToothContacts;
  struct Widths {
    double falling, floor, rising, spacing;  // of flanks: projected on the sheet
    double groove() const { return falling + floor + rising; }
  };

  Widths widths() const;
  double period_start(int feature) const { return start_ + feature / 2 * spacing_; }
  int feature_at(double a) const;
  std::span<const Face> faces(int feature) const;
  std::optional<std::pair<double, double>> extent(int feature, const Face& face) const;
  Closest closest(int feature, const Vec2& centre) const;
  Vec3 beyond(const Vec3& local) const;
  void add_contacts(const Sheet::Frame& at, const Sphere& sphere, std::vector<SurfaceContact>& contacts) const;
  void add_contacts(const PlacedSheet& sheet, const SphereLanes& spheres, std::array<ToothContacts, 3>& teeth) const;

  Sheet sheet_;
  double depth_ = 0, inclination_ = std::numbers::pi / 4, floor_ = 0, offset_ = 0;
  std::optional<double> second_inclination_, given_spacing_;
  double spacing_ = 1, start_ = 0, tooth_ = 1;  // length of a period, start of the first, width of its tooth
  double per_spacing_ = 1;
  int first_ = 0, last_ = 0;     // features on the sheet
  std::array<Face, 4> faces_{};  // of a period: rising flank, land, falling flank, floor
};

}  // namespace grit
