#include "simulation/sample_groups.hpp"

#include <cmath>

namespace grit {
namespace {

std::string spheres_in_words(std::size_t count) {
  return count == 1 ? "single spheres" : "clumps of " + std::to_string(count) + " spheres";
}

bool has_shape(const ClumpShape& shape, double radius, std::span<const SampleSphere> spheres) {
  constexpr double rounding = 1e-6;  // over the radius of the clump; sizes of grown bodies add up roundings
  if (shape.spheres.size() != spheres.size()) return false;
  for (std::size_t k = 0; k < spheres.size(); ++k) {
    const Row& wanted = shape.spheres[k];
    if (std::abs(radius * wanted.w - spheres[k].radius) > rounding * radius ||
        std::abs(radius * xyz(wanted).norm() - spheres[k].distance) > rounding * radius)
      return false;
  }
  return true;
}

}  // namespace

const GroupBuilder& SampleGroups::builder_of(const std::string& group) {
  if (const auto known = builders_.find(group); known != builders_.end()) return known->second;
  const SceneDescription& scene = live_.now();
  return builders_.emplace(group, GroupBuilder(scene, scene.bodies.at(group), live_.components().body_kinds.at(group)))
      .first->second;
}

bool SampleGroups::takes_sphere(const std::string& group) {
  return builder_of(group).clump() == nullptr || refuse(group, 1);
}

bool SampleGroups::takes_clump(const std::string& group, double radius, std::span<const SampleSphere> spheres) {
  const ClumpShape* const shape = builder_of(group).clump();
  return (shape != nullptr && has_shape(*shape, radius, spheres)) || refuse(group, spheres.size());
}

bool SampleGroups::refuse(const std::string& group, std::size_t spheres) {
  if (!refused_.insert(group).second) return false;
  const ClumpShape* const shape = builder_of(group).clump();
  const std::size_t wanted = shape == nullptr ? 1 : shape->spheres.size();
  faults_.push_back({{"bodies", group},
                     "this group of " + sample_ + " has " + spheres_in_words(spheres) + ", here it has " +
                         (wanted == spheres ? "others" : spheres_in_words(wanted)) +
                         "; use the type and shape of the sample"});
  return false;
}

}  // namespace grit
