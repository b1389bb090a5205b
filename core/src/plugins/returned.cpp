#include "plugins/returned.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>

namespace grit {
namespace {

constexpr double rounding = 1e-6;

std::string allowed(const std::string& found, std::string_view what) {
  return fmt::format("{}; allowed is {}", found, what);
}

bool is_positive(double number) { return std::isfinite(number) && number > 0; }
bool is_not_negative(double number) { return std::isfinite(number) && number >= 0; }

/// Whether a text can be the name of a dataset.
bool is_name(const std::string& text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

/// Of the names of channels, fields and others, given by `what`. `taken`: names that are in use.
template <class Named>
std::string fault_of_names(const std::string& what, std::span<const Named> all, std::set<std::string> taken) {
  for (const Named& one : all) {
    const std::string found = fmt::format("a {} of the name \"{}\"", what, one.name);
    if (!is_name(one.name)) return allowed(found, "a name of letters, digits, _ and -");
    if (!taken.insert(one.name).second) return allowed(found + ", which is taken", "a name that no other has");
  }
  return {};
}

/// The largest number of values that a sample of one channel may have.
constexpr std::size_t most_values = std::size_t{1} << 31;

/// Number of values in a sample; 0 if it has none, or too many.
std::size_t size_of(const std::vector<std::size_t>& shape) {
  std::size_t size = 1;
  for (const std::size_t extent : shape) {
    if (extent == 0 || extent > most_values / size) return 0;
    size *= extent;
  }
  return size;
}

std::string fault_of_sphere(const ClumpShape& shape, std::size_t i) {
  const Row& sphere = shape.spheres[i];
  const std::string which = fmt::format("a clump whose sphere {} has ", i + 1);
  if (!is_positive(sphere.w)) return allowed(which + fmt::format("the radius {}", sphere.w), "a positive number");
  const double reach = (xyz(sphere) - shape.middle).norm() + sphere.w;
  if (!(reach <= 1 + rounding))
    return allowed(which + fmt::format("points {} away from the middle", reach),
                   "at most 1, the radius of the enclosing sphere");
  const double fraction = shape.volume_fractions[i];
  if (!(fraction >= 0 && fraction <= 1 + rounding))
    return allowed(which + fmt::format("the volume fraction {}", fraction), "0 … 1");
  return {};
}

}  // namespace

std::string fault_of_positive(double number) {
  return is_positive(number) ? "" : allowed(fmt::format("{}", number), "a positive number");
}

std::string fault_of_not_negative(double number) {
  return is_not_negative(number) ? "" : allowed(fmt::format("{}", number), "a number of 0 or more");
}

std::string fault_of(const ClumpShape& shape) {
  if (shape.spheres.empty())
    return allowed("a clump without spheres", "one sphere or more, or null for a single sphere");
  if (shape.volume_fractions.size() != shape.spheres.size())
    return allowed(fmt::format("a clump of {} spheres with {} volume fractions", shape.spheres.size(),
                               shape.volume_fractions.size()),
                   "one for each sphere");
  if (!shape.middle.allFinite()) return allowed("a clump whose middle is not finite", "a point");
  for (std::size_t i = 0; i < shape.spheres.size(); ++i)
    if (auto fault = fault_of_sphere(shape, i); !fault.empty()) return fault;
  if (!(shape.axes.transpose() * shape.axes).isIdentity(rounding))
    return allowed("a clump whose axes are not perpendicular unit vectors", "a rotation matrix");
  if (!is_positive(shape.volume))
    return allowed(fmt::format("a clump of the volume {}", shape.volume), "a positive number");
  for (const double moment : shape.inertia)
    if (!is_positive(moment))
      return allowed(fmt::format("a clump with the moment of inertia {}", moment), "a positive number");
  if (!is_not_negative(shape.given_radius))
    return allowed(fmt::format("a clump of the given radius {}", shape.given_radius), "a number of 0 or more");
  return {};
}

std::string fault_of(std::span<const StateField> fields) {
  for (const StateField& field : fields)
    if (std::abs(field.swap) != 1)
      return allowed(fmt::format("a field \"{}\" with the factor {} for an exchange of bodies", field.name, field.swap),
                     "1 or -1");
  return fault_of_names("field", fields, {});
}

std::string fault_of(Phase phase) {
  switch (phase) {
    case Phase::settings:
    case Phase::forces:
    case Phase::removal:
      return {};
  }
  return allowed(fmt::format("the unknown phase {}", static_cast<int>(phase)), "settings, forces or removal");
}

std::string fault_of(const MotionSettings& settings) {
  if (!settings.gravity.allFinite()) return allowed("a gravity that is not finite", "a vector of numbers");
  if (!is_not_negative(settings.scaled_radius))
    return allowed(fmt::format("the scaled radius {}", settings.scaled_radius), "a number of 0 or more");
  if (!(settings.local_damping >= 0 && settings.local_damping < 1))
    return allowed(fmt::format("the local damping {}", settings.local_damping), "0 or more and below 1");
  if (settings.flat && (*settings.flat < 0 || *settings.flat > 2))
    return allowed(fmt::format("planar motion normal to the axis {}", *settings.flat), "0, 1 or 2");
  if (const auto& motion = settings.prescribed;
      motion && !(motion->velocity.allFinite() && motion->spin.allFinite() && motion->about.allFinite()))
    return allowed("a prescribed motion that is not finite", "vectors of numbers");
  return {};
}

std::string fault_of(const EngineRates& rates) {
  for (const double rate : {rates.stiffness, rates.damping})
    if (!(rate >= 0)) return allowed(fmt::format("the rate {}", rate), "0 or more");
  return {};
}

std::string fault_of(const Bounds& bounds) {
  for (int k = 0; k < 3; ++k) {
    const double low = bounds.low[k], high = bounds.high[k];
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (!(low <= high && low < infinity && high > -infinity))
      return allowed(fmt::format("sides at {} and {} along {}", low, high, "xyz"[k]),
                     "a low side below a high one, which are infinite where the shape has no end");
  }
  return {};
}

std::string fault_of(std::span<const Channel> channels) {
  for (const Channel& channel : channels)
    if (size_of(channel.shape) == 0)
      return allowed(fmt::format("a channel \"{}\" of the shape {{{}}}", channel.name, fmt::join(channel.shape, ", ")),
                     fmt::format("at least one value, and at most {}", most_values));
  return fault_of_names("channel", channels, {"time", "step"});
}

std::string fault_of(std::span<const Field> fields) {
  for (const Field& field : fields) {
    const std::string found = fmt::format("a field \"{}\" of width {} with ", field.name, field.width);
    if (field.width == 0 || field.values.size() % field.width != 0)
      return allowed(found + fmt::format("{} values", field.values.size()), "whole rows of one value or more");
    if (!field.components.empty() && field.components.size() != field.width)
      return allowed(found + fmt::format("{} components", field.components.size()), "one for each value of a row");
  }
  return fault_of_names("field", fields, {});
}

std::string fault_of_normal(const Vec3& normal) {
  const double length = normal.norm();
  if (length == 0 || std::abs(length - 1) <= rounding) return {};
  return allowed(fmt::format("a vector of length {}", length), "a unit vector, or zero if it is undefined");
}

std::string fault_of_triangles(std::span<const Vec3> corners) {
  if (corners.size() % 3 != 0) return allowed(fmt::format("{} corners", corners.size()), "three for each triangle");
  if (!std::ranges::all_of(corners, [](const Vec3& corner) { return corner.allFinite(); }))
    return allowed("a corner that is not finite", "a point");
  return {};
}

std::string fault_of_contacts(std::span<const SurfaceContact> contacts, std::span<const Sphere> spheres) {
  auto sphere = spheres.begin();
  for (const SurfaceContact& contact : contacts) {
    while (sphere != spheres.end() && sphere->body != contact.body) ++sphere;
    if (sphere == spheres.end())
      return allowed(fmt::format("a contact of the body {}", contact.body),
                     "bodies of the given spheres, in their order");
  }
  return {};
}

}  // namespace grit
