// The periodic cell, its deformation, and the images of bodies across its boundaries.
#pragma once

#include <vector>

#include "grit/archive.hpp"
#include "grit/contact/batch.hpp"
#include "grit/world.hpp"

namespace grit {

template <>
inline constexpr bool plain_numbers<ImageShift> = true;

/// A box that may be periodic along some axes and deform along these, about its centre. In a cell that shears, images
/// across y move along x, and those across z along x and y. Bodies stay in the box.
class DeformingCell {
 public:
  explicit DeformingCell(const Cell& cell);

  const Cell& cell() const { return cell_; }
  /// Whether any axis is periodic.
  bool periodic() const { return cell_.periodic[0] || cell_.periodic[1] || cell_.periodic[2]; }
  bool deforms() const { return !cell_.strain_rate.isZero(0.0) || cell_.shears(); }
  /// Side lengths; infinite along open axes [m].
  Vec3 lengths() const { return cell_.high - cell_.low; }
  /// Side lengths along periodic axes; 0 along the others [m].
  Vec3 periods() const;
  /// Point of zero mean flow [m]; NaN along open axes.
  Vec3 centre() const { return 0.5 * (cell_.low + cell_.high); }
  /// The same while the cell deforms, otherwise the origin [m].
  Vec3 flow_centre() const { return deforms() ? centre() : Vec3::Zero(); }
  /// Upper bound of the rate at which two points separate or approach, over their distance [1/s].
  double largest_rate() const { return cell_.strain_rate.cwiseAbs().maxCoeff() + cell_.shear_rate.norm(); }
  /// Velocity of the mean flow at `place` [m/s]; zero unless the cell deforms.
  Vec3 mean_flow(const Vec3& place) const;

  /// Rate of change of the periods [m/s], half a step ago like the velocities of bodies; 0 along axes that are not
  /// periodic. `previous_dt` is the last step [s], 0 before the first.
  Vec3 period_growth(double previous_dt) const;
  /// The same of the tilt [m/s].
  Vec3 tilt_growth(double previous_dt) const;
  /// Velocities of images relative to the bodies [m/s], by axis in columns, half a step ago.
  Mat3 image_velocities(double previous_dt) const {
    return columns(period_growth(previous_dt), tilt_growth(previous_dt));
  }
  /// Periods in the diagonal, offsets above it.
  static Mat3 columns(const Vec3& periods, const Vec3& tilt);
  /// Rate of change of a tilt by these rates [m/s].
  static Vec3 tilt_rate(const Vec3& lengths, const Vec3& tilt, const Vec3& strain_rate, const Vec3& shear_rate);
  /// Velocity that a velocity gradient adds at `place` from the point of zero flow [m/s].
  static Vec3 shear_flow(const Vec3& shear_rate, const Vec3& place);
  /// Sets the strain rate [1/s]. The velocities of images change with those of bodies.
  void set_strain_rate(const Vec3& rate, double previous_dt) { set_rates(rate, cell_.shear_rate, previous_dt); }
  void set_rates(const Vec3& strain_rate, const Vec3& shear_rate, double previous_dt);
  /// Moves images so that no offset exceeds half a period. Returns the periods of the old images in those of the new,
  /// by axis in columns; the identity if none has moved.
  Eigen::Matrix3i reduce_tilt();
  /// Begins a stage, from whose start strains count.
  void begin_stage() { cell_.stage_lengths = lengths(), cell_.stage_shear_strain.setZero(); }
  /// Takes the sides of `box` along axes that are not periodic.
  void set_open_sides(const Cell& box);
  /// Deforms the cell by one step [s].
  void advance(double dt);

  /// Updates the image shifts; once per step, before contacts.
  void update_images(double previous_dt);
  /// The shifts of position and velocity, by image index.
  const ImageShift* images() const { return images_.data(); }

  void serialize(Archive& archive);

 private:
  Cell cell_;
  Vec3 lengths_before_, tilt_before_;  ///< one step ago [m]
  std::vector<ImageShift> images_;
};

}  // namespace grit
