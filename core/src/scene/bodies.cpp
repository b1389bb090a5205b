#include "scene/bodies.hpp"

namespace grit {
namespace {

template <class Array>
void permute(Array& values, std::span<const std::uint32_t> order) {
  if (values.empty()) return;
  Array moved(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) moved[i] = values[order[i]];
  for (std::size_t i = order.size(); i < values.size(); ++i) moved[i] = values[i];
  values.swap(moved);
}

}  // namespace

void Bodies::reserve(std::size_t more) {
  const std::size_t all = count() + more + 1;
  position.reserve(all), velocity.reserve(all), spin.reserve(all), material.reserve(all), id.reserve(all);
}

void Bodies::add(const Vec3& centre, double radius, double mass, double inertia, std::uint8_t body_material,
                 const Vec3& v, const Vec3& w) {
  position.push_back({centre.x(), centre.y(), centre.z(), radius});
  velocity.push_back({v.x(), v.y(), v.z(), 1 / mass});
  spin.push_back({w.x(), w.y(), w.z(), 1 / inertia});
  material.push_back(body_material);
  id.push_back(static_cast<std::uint32_t>(id.size()));
}

void Bodies::finish(StateRequest state) {
  constexpr double far_away = 1e150;  // its square is still finite
  position.push_back({far_away, far_away, far_away, 0});
  velocity.push_back({});
  spin.push_back({});
  material.push_back(0);
  energies = state.has(BodyState::energy);
  if (state.has(BodyState::rotation)) rotation.assign(count(), Vec3::Zero());
  if (state.has(BodyState::displacement)) displacement.assign(count(), Vec3::Zero());
}

void Bodies::reorder(std::span<const std::uint32_t> order) {
  permute(position, order), permute(velocity, order), permute(spin, order);
  permute(id, order), permute(material, order);
  permute(rotation, order), permute(displacement, order);
}

}  // namespace grit
