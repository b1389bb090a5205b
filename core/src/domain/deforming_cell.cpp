#include "domain/deforming_cell.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>

#include "bodies/kinetic_energy.hpp"
#include "bodies/restored.hpp"
#include "contact/search.hpp"

namespace grit {

DeformingCell::DeformingCell(const Cell& cell)
    : cell_(cell), lengths_before_(cell.high - cell.low), tilt_before_(cell.tilt), images_(all_images) {}

Vec3 DeformingCell::periods() const {
  Vec3 periods = Vec3::Zero();
  for (int k = 0; k < 3; ++k)
    if (cell_.periodic[as_index(k)]) periods[k] = cell_.high[k] - cell_.low[k];
  return periods;
}

Vec3 DeformingCell::mean_flow(const Vec3& place) const {
  if (!deforms()) return Vec3::Zero();
  const Vec3 stretching = cell_.strain_rate.cwiseProduct(place - centre());
  return cell_.shears() ? Vec3(stretching + shear_flow(cell_.shear_rate, place - centre())) : stretching;
}

Vec3 DeformingCell::shear_flow(const Vec3& shear_rate, const Vec3& place) {
  return MeanFlow{.shear_rate = shear_rate}.shear(place);
}

Mat3 DeformingCell::columns(const Vec3& periods, const Vec3& tilt) {
  Mat3 all = periods.asDiagonal();
  all(0, 1) = tilt[0], all(0, 2) = tilt[1], all(1, 2) = tilt[2];
  return all;
}

Vec3 DeformingCell::tilt_rate(const Vec3& lengths, const Vec3& tilt, const Vec3& strain_rate, const Vec3& shear_rate) {
  return {strain_rate.x() * tilt[0] + shear_rate[0] * lengths.y(),
          strain_rate.x() * tilt[1] + shear_rate[0] * tilt[2] + shear_rate[1] * lengths.z(),
          strain_rate.y() * tilt[2] + shear_rate[2] * lengths.z()};
}

Vec3 DeformingCell::tilt_growth(double previous_dt) const {
  if (!cell_.skewed()) return Vec3::Zero();
  return previous_dt == 0 ? tilt_rate(lengths(), cell_.tilt, cell_.strain_rate, cell_.shear_rate)
                          : Vec3((cell_.tilt - tilt_before_) / previous_dt);
}

Vec3 DeformingCell::period_growth(double previous_dt) const {
  Vec3 growth = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    if (!cell_.periodic[as_index(k)]) continue;
    const double period = cell_.high[k] - cell_.low[k];
    growth[k] = previous_dt == 0 ? period * cell_.strain_rate[k] : (period - lengths_before_[k]) / previous_dt;
  }
  return growth;
}

void DeformingCell::set_rates(const Vec3& strain_rate, const Vec3& shear_rate, double previous_dt) {
  const Vec3 change = strain_rate - cell_.strain_rate, lengths = cell_.high - cell_.low;
  const Vec3 change_of_shear = shear_rate - cell_.shear_rate;
  const bool skews = cell_.skewed() || !shear_rate.isZero(0.0);
  cell_.strain_rate = strain_rate, cell_.shear_rate = shear_rate;
  for (int k = 0; k < 3; ++k)
    if (cell_.periodic[as_index(k)]) lengths_before_[k] -= previous_dt * change[k] * lengths[k];
  if (skews) tilt_before_ -= previous_dt * tilt_rate(lengths, cell_.tilt, change, change_of_shear);
}

Eigen::Matrix3i DeformingCell::reduce_tilt() {
  Eigen::Matrix3i moved = Eigen::Matrix3i::Identity();
  if (!cell_.skewed()) return moved;
  Mat3 now = columns(lengths(), cell_.tilt), before = columns(lengths_before_, tilt_before_);
  // The image across y first: that across z moves by its new place.
  const auto move = [&](int across, int along) {
    const double periods = std::nearbyint(now(along, across) / now(along, along));
    if (periods == 0) return;
    now.col(across) -= periods * now.col(along), before.col(across) -= periods * before.col(along);
    // old(across) = new(across) + periods · along, for all that was expressed in it
    moved.row(along) += static_cast<int>(periods) * moved.row(across);
  };
  move(1, 0), move(2, 1), move(2, 0);
  cell_.tilt = {now(0, 1), now(0, 2), now(1, 2)};
  tilt_before_ = {before(0, 1), before(0, 2), before(1, 2)};
  return moved;
}

void DeformingCell::set_open_sides(const Cell& box) {
  for (int k = 0; k < 3; ++k)
    if (!cell_.periodic[as_index(k)]) {
      cell_.low[k] = box.low[k], cell_.high[k] = box.high[k];
      lengths_before_[k] = box.high[k] - box.low[k];
    }
}

void DeformingCell::advance(double dt) {
  lengths_before_ = cell_.high - cell_.low, tilt_before_ = cell_.tilt;
  if (!deforms()) return;
  cell_.stage_shear_strain += dt * cell_.shear_rate;
  if (cell_.skewed()) cell_.tilt += dt * tilt_rate(lengths_before_, tilt_before_, cell_.strain_rate, cell_.shear_rate);
  const Vec3 middle = centre();
  for (int k = 0; k < 3; ++k) {
    if (!cell_.periodic[as_index(k)]) continue;
    const double half = 0.5 * lengths_before_[k] * (1 + dt * cell_.strain_rate[k]);
    cell_.low[k] = middle[k] - half, cell_.high[k] = middle[k] + half;
  }
}

void DeformingCell::update_images(double previous_dt) {
  const Vec3 period = cell_.high - cell_.low, growth = period_growth(previous_dt);
  for (std::uint8_t image = 0; image < 27; ++image) {
    const auto shift = image_shift(image);
    double position[3], velocity[3];
    for (int k = 0; k < 3; ++k) {
      position[k] = shift[as_index(k)] != 0 ? shift[as_index(k)] * period[k] : 0;
      velocity[k] = shift[as_index(k)] != 0 ? shift[as_index(k)] * growth[k] : 0;
    }
    images_[image] = {{position[0], position[1], position[2], 0}, {velocity[0], velocity[1], velocity[2], 0}};
  }
  if (!cell_.skewed()) return;
  const Mat3 periods = columns(period, cell_.tilt), velocities = image_velocities(previous_dt);
  for (std::uint8_t image = 0; image < all_images; ++image) {
    const auto shift = image_shift(image);
    const Vec3 numbers(shift[0], shift[1], shift[2]), position = periods * numbers, velocity = velocities * numbers;
    images_[image] = {{position.x(), position.y(), position.z(), 0}, {velocity.x(), velocity.y(), velocity.z(), 0}};
  }
}

void DeformingCell::serialize(Archive& archive) {
  const auto periodic = cell_.periodic;
  archive(cell_, lengths_before_, tilt_before_, images_);
  if (!archive.restoring()) return;
  // By bytes, as an altered one may be neither true nor false.
  expect_restored(std::memcmp(&periodic, &cell_.periodic, sizeof periodic) == 0, "other axes of the cell are periodic");
  expect_restored(images_.size() == all_images, "the images of the cell have another number");
  for (int k = 0; k < 3; ++k)
    expect_restored(!cell_.periodic[as_index(k)] ||
                        (std::isfinite(cell_.low[k]) && std::isfinite(cell_.high[k]) && cell_.low[k] < cell_.high[k]),
                    "a period of the cell is not a length");
  expect_restored(cell_.strain_rate.allFinite() && cell_.shear_rate.allFinite() && cell_.tilt.allFinite() &&
                      tilt_before_.allFinite(),
                  "the deformation of the cell is not a number");
  // Images across y and z are moved back at each neighbour search, before their offset is a period.
  const Vec3 along(lengths()[0], lengths()[0], lengths()[1]);
  for (int k = 0; k < 3; ++k)
    expect_restored(cell_.tilt[k] == 0 || std::abs(cell_.tilt[k]) <= 2 * along[k],
                    "the images of the cell are further away than a search leaves them");
}

}  // namespace grit
