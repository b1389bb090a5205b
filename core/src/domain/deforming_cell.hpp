// The periodic cell, its deformation, and the images of bodies across its boundaries.
#pragma once

#include <vector>

#include "grit/archive.hpp"
#include "grit/contact/batch.hpp"
#include "grit/world.hpp"

namespace grit {

template <>
inline constexpr bool plain_numbers<Cell> = true;
template <>
inline constexpr bool plain_numbers<ImageShift> = true;

/// A box that may be periodic along some axes and deform along these at a constant strain rate about its centre.
class DeformingCell {
 public:
  explicit DeformingCell(const Cell& cell);

  const Cell& cell() const { return cell_; }
  /// Whether any axis is periodic.
  bool periodic() const { return cell_.periodic[0] || cell_.periodic[1] || cell_.periodic[2]; }
  bool deforms() const { return !cell_.strain_rate.isZero(0.0); }
  /// Side lengths; infinite along open axes [m].
  Vec3 lengths() const { return cell_.high - cell_.low; }
  /// Side lengths along periodic axes; 0 along the others [m].
  Vec3 periods() const;
  /// Point of zero mean flow [m]; NaN along open axes.
  Vec3 centre() const { return 0.5 * (cell_.low + cell_.high); }
  /// The same while the cell deforms, otherwise the origin [m].
  Vec3 flow_centre() const { return deforms() ? centre() : Vec3::Zero(); }
  /// Velocity of the mean flow at `place` [m/s]; zero unless the cell deforms.
  Vec3 mean_flow(const Vec3& place) const;

  /// Rate of change of the periods [m/s], half a step ago like the velocities of bodies; 0 along axes that are not
  /// periodic. `previous_dt` is the last step [s], 0 before the first.
  Vec3 period_growth(double previous_dt) const;
  /// Sets the strain rate [1/s]. The velocities of images change with those of bodies.
  void set_strain_rate(const Vec3& rate, double previous_dt);
  /// Takes the sides of `box` along axes that are not periodic.
  void set_open_sides(const Cell& box);
  /// Deforms the cell by one step [s].
  void advance(double dt);

  /// Updates the image shifts; once per step, before contacts.
  void update_images(double previous_dt);
  /// The 27 shifts of position and velocity, by image index.
  const ImageShift* images() const { return images_.data(); }

  void serialize(Archive& archive);

 private:
  Cell cell_;
  Vec3 lengths_before_;  ///< one step ago [m]
  std::vector<ImageShift> images_;
};

}  // namespace grit
