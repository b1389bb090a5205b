#include "lint/odd_densities.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace grit {
namespace {

constexpr double lightest = 50, heaviest = 25'000;  // kg/m³: cork has 200, osmium 22 600
constexpr double grams = 1000;                      // kg/m³ in 1 g/cm³

}  // namespace

std::vector<UnusedSetting> odd_densities(const SceneDescription& scene) {
  std::vector<UnusedSetting> all;
  for (const auto& [name, material] : scene.materials) {
    const double density = material.density;
    const auto is_of = [&, &name = name](const auto& group) { return group.second.material == name; };
    if ((density >= lightest && density <= heaviest) || std::ranges::none_of(scene.bodies, is_of)) continue;
    const bool in_grams = grams * density >= lightest && grams * density <= heaviest;
    all.push_back(
        {"/materials/" + name + "/density",
         fmt::format("{:g} kg/m^3 is far from any solid; {} A density that is scaled on purpose may stay", density,
                     in_grams ? fmt::format("did you mean {:g} g/cm^3?", density) : "is the unit right?")});
  }
  return all;
}

}  // namespace grit
