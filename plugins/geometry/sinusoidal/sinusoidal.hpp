// A rectangular sheet with a sinusoidal surface.
#pragma once

#include "grit/toolkit/sheet.hpp"

namespace grit {

/// In the section the surface is at −depth sin²(π x / wavelength), x from a crest. The half wave of a crest that faces
/// a centre in front has at most one local minimum of distance. A crest, from trough to trough, therefore has at most
/// one contact and is one feature. For a sphere that fits into the troughs the whole sheet is one feature.
class Sinusoidal : public Geometry {
 public:
  void declare(Parameters& p) override;
  void prepare() override;
  Bounds bounds() const override;
  /// Of the sheet, not of the waves.
  double area() const override { return sheet_.length_a * sheet_.length_b; }
  /// Of the sheet.
  Vec3 normal() const override { return sheet_.axes.col(2); }
  void find_contacts(const Pose& pose, std::span<const Sphere> spheres,
                     std::vector<SurfaceContact>& contacts) const override;
  bool near(const Pose& pose, const Vec3& centre, double reach) const override;
  std::vector<Vec3> triangles() const override;

 private:
  /// The surface at one point along edge a: height over the plane of the crests, first and second derivative.
  struct Wave {
    double height, slope, bend;
  };
  /// Where distance to a centre may have a local minimum: on the facing half wave of crests within `reach`, and of the
  /// nearest crest, up to `last` from the crest.
  struct MinimumRange {
    double last, reach;
  };

  double crest(double number) const { return first_crest_ + number * wavelength_; }
  double number_at(double a) const { return (a - first_crest_) / wavelength_; }
  Wave wave(double from_crest) const;
  Wave wave_at(double a) const { return wave(a - crest(std::round(number_at(a)))); }
  MinimumRange minimum_range(double above) const;
  double closest(double beside, double above, double last) const;
  double past_closest_from_behind(double a, double above) const;
  double rate(double a, const Vec3& local) const;
  template <class Found>
  void each_in_front(const Vec3& local, double half_width, Found found) const;
  Vec3 beyond(const Vec3& local) const;

  Sheet sheet_;
  double depth_ = 0, wavelength_ = 1, offset_ = 0;
  double wave_number_ = 1, steepest_ = 0;    // 2π / wavelength; largest slope
  double trough_radius_ = 1;                 // of curvature
  double first_crest_ = 0, last_crest_ = 0;  // position of crest 0, the first on the sheet; number of the last
  std::uint32_t start_feature_ = 0, end_feature_ = 0;  // of the sheet's ends; crest n has n + 1
};

}  // namespace grit
