// A rectangular sheet in sine waves.
#pragma once

#include "grit/toolkit/sheet.hpp"

namespace grit {

/// In the section across the waves the surface is at −depth sin²(π x / wavelength), x from a crest. Of the half wave of
/// a crest that faces a centre in front at most one place is a local minimum of distance, so that a crest, from trough
/// to trough, is touched once and is one feature. To a sphere that fits into the troughs the whole sheet is one.
class Sinusoidal : public Geometry {
 public:
  void declare(Parameters& p) override;
  void prepare() override;
  Bounds bounds() const override;
  /// Of the sheet, not of the waves.
  double area() const override { return sheet_.length_a * sheet_.length_b; }
  /// Of the sheet.
  Vec3 normal() const override { return sheet_.axes.col(2); }
  void touch(const Pose& pose, std::span<const Sphere> spheres, std::vector<Touch>& touches) const override;
  bool near(const Pose& pose, const Vec3& centre, double reach) const override;
  std::vector<Vec3> triangles() const override;

 private:
  /// The waves at one place along edge a: height over the plane of the crests, slope, and the slope's change.
  struct Wave {
    double height, slope, bend;
  };
  /// What a centre sees of the waves: on the half wave of a crest that faces it there is a local minimum of distance,
  /// no farther from the crest than `last`, if the crest is no farther than `reach`, or is the centre's own.
  struct Sight {
    double last, reach;
  };

  double crest(double number) const { return first_crest_ + number * wavelength_; }
  double number_at(double a) const { return (a - first_crest_) / wavelength_; }
  Wave wave(double from_crest) const;
  Wave wave_at(double a) const { return wave(a - crest(std::round(number_at(a)))); }
  Sight sight(double above) const;
  double closest(double beside, double above, double last) const;
  double past_closest_from_behind(double a, double above) const;
  double rate(double a, const Vec3& place) const;
  template <class Found>
  void each_in_front(const Vec3& place, double half_width, Found found) const;
  Vec3 beyond(const Vec3& place) const;

  Sheet sheet_;
  double depth_ = 0, wavelength_ = 1, offset_ = 0;
  double wave_number_ = 1, steepest_ = 0;    // 2π / wavelength; largest slope
  double trough_radius_ = 1;                 // of curvature
  double first_crest_ = 0, last_crest_ = 0;  // where crest 0 is, the first with a part on the sheet; the last's number
  std::uint32_t start_feature_ = 0, end_feature_ = 0;  // of the ends of the sheet; that of crest n is n + 1
};

}  // namespace grit
