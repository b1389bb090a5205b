#include "lint/soft_contacts.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "grit/toolkit/grain_masses.hpp"
#include "lint/all_stages.hpp"

namespace grit {
namespace {

constexpr double soft = 0.1, stiff = 0.01;  // overlap over radius

struct Load {
  double stress = 0;  ///< Pa
  std::string of;
};

/// The present bodies.
struct Sample {
  double mass;  ///< kg
  Vec3 size;    ///< m
};

Sample sample_of(const World& world) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Row& x : world.positions())
    low = low.cwiseMin(xyz(x) - Vec3::Constant(x.w)), high = high.cwiseMax(xyz(x) + Vec3::Constant(x.w));
  return {mass_of(world), high - low};
}

/// On the cross-section perpendicular to the largest component of gravity.
Load weight(const Sample& sample, const SceneDescription& now, const EngineMap& engines) {
  Vec3 gravity = Vec3::Zero();
  for (const auto& [name, group] : now.bodies) {
    const MotionSettings motion = settings_of(now, engines, name);
    const Vec3 of_group = motion.gravity.cwiseProduct(motion.free_translation());
    if (of_group.norm() > gravity.norm()) gravity = of_group;
  }
  int axis = 0;
  const double largest = gravity.cwiseAbs().maxCoeff(&axis);
  return {sample.mass * largest * sample.size[axis] / sample.size.prod(), "the weight of the bodies"};
}

Load largest_load(const Sample& sample, const SceneDescription& now, const EngineMap& engines) {
  Load load = weight(sample, now, engines);
  const auto add = [&](double stress, const std::string& of) {
    if (stress > load.stress) load = {stress, of};
  };
  for (const auto& [name, wall] : now.walls)
    if (wall.motion.servo) add(wall.motion.servo->pressure.value_or(0), "the servo of wall \"" + name + '"');
  if (now.domain.servo)
    for (const auto& target : now.domain.servo->targets()) add(std::abs(target.value_or(0)), "the servo of the cell");
  return load;
}

/// The mean body of a material.
struct MeanBody {
  double radii = 0, count = 0;
  double radius() const { return radii / count; }
};

/// Normal force over radius² of a contact of two equal bodies, at this overlap over their radius.
class Forces {
 public:
  Forces(const ContactLaw& law, std::size_t material, double radius, double density) {
    const double inverse_mass = 1 / (density * 4 / 3 * std::numbers::pi * radius * radius * radius);
    for (std::size_t k = 0; k < steps; ++k) {
      const double overlap = (static_cast<double>(k) + 0.5) * radius / steps;
      const double rise =
          law.stiffness({radius, radius, inverse_mass, inverse_mass, overlap, false}, material, material).normal /
          (radius * steps);
      at_[k + 1] = at_[k] + rise;
    }
  }
  double at(double overlap) const { return at_[static_cast<std::size_t>(std::lround(overlap * steps))]; }
  /// Overlap over radius at a force; infinite if it is more than 1.
  double overlap(double force) const {
    const auto above = std::ranges::lower_bound(at_, force) - at_.begin();
    if (above == 0) return 0;
    const auto k = static_cast<std::size_t>(above);
    if (k > steps) return std::numeric_limits<double>::infinity();
    return (static_cast<double>(k) - (at_[k] - force) / (at_[k] - at_[k - 1])) / steps;
  }

 private:
  static constexpr std::size_t steps = 100;
  std::array<double, steps + 1> at_{};
};

std::string message(double overlap, double factor, const Load& load) {
  const std::string deep =
      overlap <= 1 ? fmt::format("about {:.0f} % of their radius", 100 * overlap) : "more than their radius";
  return fmt::format(
      "too soft: under {}, {:.3g} Pa, bodies would overlap by {}; those of stiff grains do by less than 1 %: raise the "
      "modulus of the material about {:.2g} times",
      load.of, load.stress, deep, factor);
}

}  // namespace

std::vector<UnusedSetting> soft_contacts(const Scene& described, const World& world) {
  if (world.positions().empty()) return {};
  const Sample sample = sample_of(world);
  std::map<std::size_t, MeanBody> bodies;  // by material
  for (std::size_t i = 0; i < world.positions().size(); ++i) {
    MeanBody& mean = bodies[world.materials()[i]];
    mean.radii += world.positions()[i].w, mean.count += 1;
  }
  struct Softest {
    double overlap, factor;
    Load load;
  };
  std::map<std::string, Softest> materials;
  MixedLaw mixed(*described.description);
  LiveEngines engines;
  through_stages(*described.description, described.stages,
                 [&](const SceneDescription& now, std::optional<std::size_t>) {
                   mixed.follow(now), engines.follow(now);
                   const Load load = largest_load(sample, now, engines.all());
                   // A contact carries about the stress times the square of the diameter.
                   const double force = 4 * load.stress;
                   if (!(force > 0)) return true;
                   const std::vector<std::string> names = material_names(now);
                   for (const auto& [material, mean] : bodies) {
                     const std::string& name = names.at(material);
                     const Forces forces(mixed.law(), material, mean.radius(), now.materials.at(name).density);
                     const double overlap = forces.overlap(force);
                     if (overlap > soft && (!materials.contains(name) || overlap > materials.at(name).overlap))
                       materials[name] = {overlap, force / forces.at(stiff), load};
                   }
                   return true;
                 });
  std::vector<UnusedSetting> all;
  for (const auto& [name, softest] : materials)
    all.push_back({"/materials/" + pointer_token(name), message(softest.overlap, softest.factor, softest.load)});
  return all;
}

}  // namespace grit
