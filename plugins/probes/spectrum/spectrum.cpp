#include "spectrum.hpp"

#include <algorithm>

#include "../wall_names.hpp"
#include "grit/plugin.hpp"

namespace grit {

namespace {

/// Mean over mass of the acceleration of the grains whose centres lie in a box, before damping; 0 without any.
Vec3 mean_acceleration(const World& world, const Region& box) {
  Vec3 force = Vec3::Zero();
  double mass = 0;
  const auto add = [&](const Vec3& centre, const Vec3& on_it, double of_it) {
    if (!((centre.array() >= box.low.array()).all() && (centre.array() < box.high.array()).all())) return;
    force += on_it, mass += of_it;
  };
  const auto clump_of = world.clump_of();
  for (std::size_t i = 0; i < world.positions().size(); ++i)
    if (clump_of.empty() || clump_of[i] == no_clump)
      add(xyz(world.positions()[i]), xyz(world.forces()[i]), 1 / world.velocities()[i].w);
  for (const ClumpView& clump : world.clumps()) add(clump.centre, clump.force, clump.mass);
  return mass > 0 ? Vec3(force / mass) : Vec3::Zero();
}

}  // namespace

void Spectrum::declare(Parameters& parameters) {
  parameters.add("wall", wall).doc("what is listened to: a wall; leave it out for a box");
  parameters.add("low", low).unit("m").doc("lowest corner of a box whose grains are listened to");
  parameters.add("high", high).unit("m").doc("its highest corner");
  parameters.add("interval", interval)
      .unit("s")
      .above(0)
      .doc("between the evenly spaced points to which samples are brought; half its inverse is the highest frequency");
  parameters.add("points", points).at_least(8).at_most(1 << 20).doc("of a window, an even number");
  parameters.add("windows", windows)
      .at_least(1)
      .at_most(10000)
      .doc("over which the density is the mean, the last ones");
  parameters.check(
      [this](const Complain& complain) {
        const bool box = low && high;
        if (low.has_value() != high.has_value())
          complain(low ? "high" : "low", "one corner of a box", "both low and high, or neither");
        else if (wall.empty() != box)
          complain("wall", box ? "a wall and a box" : "neither a wall nor a box", "one of them");
        else if (box && !(low->array() < high->array()).all())
          complain("high", "a corner that is not above low", "more than low along x, y and z");
      },
      {"wall", "low", "high"});
  parameters.check(
      [this](const Complain& complain) {
        if (points % 2 != 0) complain("points", std::to_string(points), "an even number");
      },
      {"points"});
}

void Spectrum::prepare(const World& world) {
  if (!wall.empty()) wall_ = wall_index(world, wall, "probe spectrum, /wall");
  last_.reset();
  begin_again();
}

std::vector<Channel> Spectrum::channels() const {
  const auto bins = static_cast<std::size_t>(points / 2 + 1);
  const std::string unknown = "; NaN before the first window is full";
  return {{"frequency", "Hz", "of each value of the densities", {bins}},
          {"acceleration_density",
           "m2 s-4 Hz-1",
           "one-sided power spectral density of the acceleration along x, y, z" + unknown,
           {bins, 3}},
          {"pressure_density", "Pa2 Hz-1", "the same of the pressure" + unknown, {bins}},
          {"windows", "1", "number of windows that the densities are the mean of", {}}};
}

Spectrum::Signals Spectrum::look(const World& world) const {
  if (wall.empty()) {
    const Region box{*low, *high};
    const Vec3 acceleration = mean_acceleration(world, box);
    return {acceleration.x(), acceleration.y(), acceleration.z(), mean_stress(world, box).trace() / 3};
  }
  const WallView& view = world.walls()[wall_];
  const Vec3 acceleration =
      last_ ? Vec3((view.velocity - last_->velocity) / (world.time() - last_->time)) : Vec3::Zero();
  return {acceleration.x(), acceleration.y(), acceleration.z(), view.pressure};
}

void Spectrum::take(const World& world) {
  const double now = world.time();
  if (last_ && now <= last_->time) return;
  const Instant instant{now, wall.empty() ? Vec3::Zero() : world.walls()[wall_].velocity, look(world)};
  if (!last_ || now - last_->time > 2 * interval) {
    begin_again();
    first_time_ = now, count_ = 0;
    if (!wall.empty()) count_ = 1;  // its acceleration is known from the second sample on
  }
  // Counted, not summed up, so that the points do not drift.
  for (double at; (at = first_time_ + static_cast<double>(count_) * interval) <= now; ++count_) {
    const double part = last_ ? (at - last_->time) / (now - last_->time) : 1;
    for (std::size_t i = 0; i < welch_.size(); ++i) {
      const double value = instant.signals[i], before = last_ ? last_->signals[i] : value;
      welch_[i].add(before + part * (value - before));
    }
  }
  last_ = instant;
}

void Spectrum::sample(const World& world, std::span<const std::span<double>> values) {
  take(world);
  for (std::size_t k = 0; k < values[0].size(); ++k)
    values[0][k] = static_cast<double>(k) / (static_cast<double>(points) * interval);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto density = welch_[i].mean();
    for (std::size_t k = 0; k < density.size(); ++k) values[1][3 * k + i] = density[k];
  }
  const auto density = welch_[3].mean();
  std::copy(density.begin(), density.end(), values[2].begin());
  values[3][0] = static_cast<double>(welch_[3].windows());
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "probe",
                                     .name = "spectrum",
                                     .version = "1.0.0",
                                     .doc = "acceleration and pressure of a wall or a box by frequency",
                                     .make_probe = []() -> grit::Probe* { return new grit::Spectrum; }};
  return &info;
}
