#include "bodies/stream.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <numbers>
#include <utility>
#include <variant>

#include "bodies/restored.hpp"
#include "bodies/sizes.hpp"
#include "bodies/whole_count.hpp"

namespace grit {
namespace {

/// Diameters are drawn in batches, each of which has the grading of the source.
constexpr std::size_t batch = 100;

/// A fraction of a length, so far from both ends that `margin` is free.
double fraction(double length, double margin, Random& random) {
  const double free = std::max(0.0, length - 2 * margin);
  return (0.5 * (length - free) + random.uniform() * free) / length;
}

Vec3 position_in(const RectangleRegion& region, double radius, Random& random) {
  const double a = fraction(region.edge_a.norm(), radius, random), b = fraction(region.edge_b.norm(), radius, random);
  return region.corner + a * region.edge_a + b * region.edge_b;
}

Vec3 position_in(const DiscRegion& region, double radius, Random& random) {
  const Vec3 normal = region.normal.normalized(), across = normal.unitOrthogonal();
  const double distance = std::max(0.0, region.radius - radius) * std::sqrt(random.uniform()),
               angle = 2 * std::numbers::pi * random.uniform();
  return region.centre + distance * (std::cos(angle) * across + std::sin(angle) * normal.cross(across));
}

Vec3 position_in(const BoxRegion& region, double radius, Random& random) {
  Vec3 place;
  for (int k = 0; k < 3; ++k) {
    const double length = region.high[k] - region.low[k];
    place[k] = region.low[k] + length * fraction(length, radius, random);
  }
  return place;
}

Region bounds_of(const RectangleRegion& region) {
  Region box{region.corner, region.corner};
  for (const Vec3& way : {region.edge_a, region.edge_b, Vec3(region.edge_a + region.edge_b)})
    box.low = box.low.cwiseMin(region.corner + way), box.high = box.high.cwiseMax(region.corner + way);
  return box;
}
Region bounds_of(const DiscRegion& region) {
  const Vec3 normal = region.normal.normalized();
  const Vec3 reach = region.radius * (Vec3::Ones() - normal.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
  return {region.centre - reach, region.centre + reach};
}
Region bounds_of(const BoxRegion& region) { return {region.low, region.high}; }

double width_of(const RectangleRegion& region) { return std::max(region.edge_a.norm(), region.edge_b.norm()); }
double width_of(const DiscRegion& region) { return 2 * region.radius; }
double width_of(const BoxRegion& region) { return (region.high - region.low).maxCoeff(); }

/// Mean mass of the bodies of a stream [kg].
double mean_mass(const StreamSource& source, const GroupBuilder& builder) {
  Random random(0);
  double mean = 0;
  for (const double diameter : draw_diameters(source.sizes, batch, random, builder.shape_diameter()))
    mean += builder.mass(0.5 * diameter) / batch;
  return mean;
}

}  // namespace

Stream::Stream(const StreamSource& source, const GroupBuilder& builder, std::uint64_t seed)
    : source_(source), builder_(builder), random_(seed) {}

std::size_t Stream::due(double time, std::size_t most) {
  constexpr double endless = std::numeric_limits<double>::infinity(), rounding = 1 + 1e-12;
  if (!begun_) return 0;
  const double lasted = std::min(time - *begun_, source_.time.value_or(endless));
  double all = source_.count > 0 ? static_cast<double>(source_.count) : endless;
  if (source_.number_rate) all = std::min(all, std::floor(*source_.number_rate * lasted * rounding));
  const double mass =
      std::min(source_.mass_rate ? *source_.mass_rate * lasted : endless, source_.mass.value_or(endless)) * rounding;
  if (mass == endless)
    return static_cast<std::size_t>(std::clamp(all - static_cast<double>(entered_), 0.0, static_cast<double>(most)));
  // By mass: one after the other, each with its own mass.
  std::size_t count = 0;
  double sum = mass_;
  while (count < most && static_cast<double>(entered_ + count) < all) {
    if (diameters_.size() <= count) draw();
    sum += mass_of(diameters_[diameters_.size() - 1 - count]);
    if (sum > mass) break;
    ++count;
  }
  return count;
}

void Stream::let_in(double time, std::size_t waiting, double interval) {
  waiting_ = waiting;
  const double rate = source_.number_rate ? *source_.number_rate : *source_.mass_rate / mass_of(next_diameter());
  next_ = waiting > 0 || rate * interval > 1 ? time + interval : time;
}

double Stream::next_diameter() {
  if (diameters_.empty()) draw();
  return diameters_.back();
}

Vec3 Stream::position(double radius) {
  return std::visit(
      [&]<class R>(const R& region) -> Vec3 {
        if constexpr (std::same_as<R, std::monostate>) return Vec3::Zero();
        else return position_in(region, radius, random_);
      },
      source_.region.value());
}

void Stream::enter() {
  mass_ += mass_of(next_diameter());
  diameters_.pop_back();
  ++entered_;
}

void Stream::draw() {
  const auto* list = std::get_if<ListSizes>(&source_.sizes.value());
  std::vector<double> more = draw_diameters(source_.sizes, list != nullptr ? list->diameters.size() : batch, random_,
                                            builder_.shape_diameter());
  std::ranges::reverse(more);
  diameters_.insert(diameters_.begin(), more.begin(), more.end());
}

void Stream::serialize(Archive& archive) {
  archive(random_, begun_, diameters_, entered_, mass_, waiting_, next_);
  if (!archive.restoring()) return;
  expect_restored(random_.is_valid(), "the state of random numbers is zero");
  expect_restored(waiting_ == 0 || !diameters_.empty(), "bodies of a stream wait that are not there");
  const auto is_size = [](double diameter) { return diameter > 0 && std::isfinite(diameter); };
  expect_restored(std::ranges::all_of(diameters_, is_size), "a body of a stream has no size");
}

double expected_rate(const StreamSource& source, const GroupBuilder& builder) {
  return source.number_rate ? *source.number_rate : *source.mass_rate / mean_mass(source, builder);
}

std::size_t expected_count(const StreamSource& source, const GroupBuilder& builder) {
  double count = std::numeric_limits<double>::infinity();
  if (source.count > 0) count = static_cast<double>(source.count);
  const double mean = mean_mass(source, builder);
  if (source.mass) count = std::min(count, *source.mass / mean);
  if (source.time && source.number_rate) count = std::min(count, *source.number_rate * *source.time);
  if (source.time && source.mass_rate) count = std::min(count, *source.mass_rate * *source.time / mean);
  return std::isfinite(count) ? whole_count(count) : 0;
}

Region bounds_of(const StreamSource& source) {
  return std::visit(
      []<class R>(const R& region) -> Region {
        if constexpr (std::same_as<R, std::monostate>) return {Vec3::Zero(), Vec3::Zero()};
        else return bounds_of(region);
      },
      source.region.value());
}

double width_of(const StreamSource& source) {
  return std::visit(
      []<class R>(const R& region) -> double {
        if constexpr (std::same_as<R, std::monostate>) return 0;
        else return width_of(region);
      },
      source.region.value());
}

}  // namespace grit
