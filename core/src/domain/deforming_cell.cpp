#include "domain/deforming_cell.hpp"

#include <cstdint>

#include "contact/search.hpp"

namespace grit {

DeformingCell::DeformingCell(const Cell& cell) : cell_(cell), lengths_before_(cell.high - cell.low), images_(27) {}

Vec3 DeformingCell::periods() const {
  Vec3 periods = Vec3::Zero();
  for (int k = 0; k < 3; ++k)
    if (cell_.periodic[k]) periods[k] = cell_.high[k] - cell_.low[k];
  return periods;
}

Vec3 DeformingCell::mean_flow(const Vec3& place) const {
  return deforms() ? Vec3(cell_.strain_rate.cwiseProduct(place - centre())) : Vec3::Zero();
}

Vec3 DeformingCell::period_growth(double previous_dt) const {
  Vec3 growth = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    if (!cell_.periodic[k]) continue;
    const double period = cell_.high[k] - cell_.low[k];
    growth[k] = previous_dt == 0 ? period * cell_.strain_rate[k] : (period - lengths_before_[k]) / previous_dt;
  }
  return growth;
}

void DeformingCell::set_strain_rate(const Vec3& rate, double previous_dt) {
  const Vec3 change = rate - cell_.strain_rate, lengths = cell_.high - cell_.low;
  cell_.strain_rate = rate;
  for (int k = 0; k < 3; ++k)
    if (cell_.periodic[k]) lengths_before_[k] -= previous_dt * change[k] * lengths[k];
}

void DeformingCell::set_open_sides(const Cell& box) {
  for (int k = 0; k < 3; ++k)
    if (!cell_.periodic[k]) {
      cell_.low[k] = box.low[k], cell_.high[k] = box.high[k];
      lengths_before_[k] = box.high[k] - box.low[k];
    }
}

void DeformingCell::advance(double dt) {
  lengths_before_ = cell_.high - cell_.low;
  if (!deforms()) return;
  const Vec3 middle = centre();
  for (int k = 0; k < 3; ++k) {
    if (!cell_.periodic[k]) continue;
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
      position[k] = shift[k] != 0 ? shift[k] * period[k] : 0;
      velocity[k] = shift[k] != 0 ? shift[k] * growth[k] : 0;
    }
    images_[image] = {{position[0], position[1], position[2], 0}, {velocity[0], velocity[1], velocity[2], 0}};
  }
}

void DeformingCell::serialize(Archive& archive) { archive(cell_, lengths_before_, images_); }

}  // namespace grit
