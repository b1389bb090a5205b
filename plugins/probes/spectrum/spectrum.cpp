#include "spectrum.hpp"

#include <algorithm>
#include <cmath>

#include "grit/plugin.hpp"
#include "grit/toolkit/wall_names.hpp"

namespace grit {

namespace {

/// Channels, in the order of signals.
constexpr const char* densities[] = {
    "acceleration_density_x",
    "acceleration_density_y",
    "acceleration_density_z",
    "pressure_density",
};
constexpr double most_kept = 1e8;  // points of all windows: 1.6 GB of densities

/// Whether a box holds a point or one of its periodic images. The box is no longer than a period.
bool holds(const Cell& domain, const Region& box, Vec3 point) {
  if (domain.skewed())
    for (int k = 2; k >= 0; --k)
      point -= std::floor((point[k] - box.low[k]) / (domain.high[k] - domain.low[k])) * domain.period(k);
  for (int k = 0; k < 3; ++k) {
    double above = point[k] - box.low[k];
    if (domain.periodic[static_cast<std::size_t>(k)]) {
      const double period = domain.high[k] - domain.low[k];
      above -= period * std::floor(above / period);
      if (above >= period) above = 0;  // by rounding, of a point just below the box
    }
    if (!(above >= 0 && above < box.high[k] - box.low[k])) return false;
  }
  return true;
}

/// Mean over mass of the acceleration of the grains whose centres lie in a box, before damping; 0 without any.
Vec3 mean_acceleration(const World& world, const Region& box) {
  Vec3 force = Vec3::Zero();
  double mass = 0;
  const auto add = [&](const Vec3& centre, const Vec3& on_it, double of_it) {
    if (!holds(world.cell(), box, centre)) return;
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
  parameters.add("wall", wall).doc("wall to record; omit it for a box");
  parameters.add("region_low", region_low).unit("m").doc("lower corner of the recorded box");
  parameters.add("region_high", region_high)
      .unit("m")
      .doc("upper corner of the box, at most one period from the lower one along periodic axes");
  parameters.add("interval", interval)
      .unit("s")
      .above(0)
      .doc(
          "interval of the evenly spaced points to which samples are interpolated; the highest frequency is half its "
          "inverse");
  parameters.add("points", points).at_least(8).at_most(1 << 20).doc("number of points of a window, even");
  parameters.add("windows", windows)
      .at_least(1)
      .at_most(10000)
      .doc("number of windows, the last ones, over which the density is averaged");
  parameters.check(
      [this](const Complain& complain) {
        const bool box = region_low && region_high;
        if (region_low.has_value() != region_high.has_value())
          complain(region_low ? "region_high" : "region_low", "one corner of a box",
                   "both region_low and region_high, or neither");
        else if (wall.empty() != box)
          complain("wall", box ? "a wall and a box" : "neither a wall nor a box", "one of them");
        else if (box && !(region_low->array() < region_high->array()).all())
          complain("region_high", "a corner not above region_low", "more than region_low along x, y and z");
      },
      {"wall", "region_low", "region_high"});
  parameters.check(
      [this](const Complain& complain) {
        if (points % 2 != 0) complain("points", std::to_string(points), "an even number");
      },
      {"points"});
  parameters.check(
      [this](const Complain& complain) {
        if (const double kept = static_cast<double>(points) * static_cast<double>(windows); kept > most_kept)
          complain("windows", std::to_string(windows) + " of " + std::to_string(points) + " points",
                   "at most 100000000 points in all windows");
      },
      {"points", "windows"});
}

void Spectrum::prepare(const World& world) {
  if (!wall.empty()) wall_ = wall_index(world, wall, "wall");
  const Cell& domain = world.cell();
  for (int k = 0; wall.empty() && k < 3; ++k)
    if (const double period = domain.high[k] - domain.low[k], length = (*region_high)[k] - (*region_low)[k];
        domain.periodic[static_cast<std::size_t>(k)] && length > (1 + 1e-9) * period)
      throw ParameterError({{"region_high", "a box of " + std::to_string(length) + " m along " + "xyz"[k],
                             "at most the period of the domain, " + std::to_string(period) + " m"}});
  last_.reset();
  begin_again();
}

void Spectrum::serialize(Archive& archive) {
  archive.part("spectrum", 1);
  archive(last_, first_time_, count_);
  for (Welch& one : welch_) archive(one);
  const bool goes_on = !first_time_ || (last_ && *first_time_ + static_cast<double>(count_) * interval > last_->time);
  if (archive.restoring() && !goes_on) throw Error("the saved points do not reach the last sample");
}

std::vector<Channel> Spectrum::channels() const {
  const auto bins = static_cast<std::size_t>(points / 2 + 1);
  const std::string unknown = "; NaN before the first window is full";
  std::vector<Channel> channels{{"frequency", "Hz", "frequency of each value of the densities", {bins}}};
  for (std::size_t k = 0; k < 3; ++k)
    channels.push_back({densities[k],
                        "m2 s-4 Hz-1",
                        std::string("one-sided power spectral density of the acceleration along ") + "xyz"[k] + unknown,
                        {bins},
                        "frequency"});
  channels.push_back(
      {densities[3], "Pa2 Hz-1", "one-sided power spectral density of the pressure" + unknown, {bins}, "frequency"});
  channels.push_back({"windows", "1", "number of windows averaged so far", {}});
  return channels;
}

Spectrum::Signals Spectrum::look(const World& world) const {
  if (wall.empty()) {
    const Region box{*region_low, *region_high};
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
  if (last_ && now - last_->time > 2 * interval) last_.reset();
  if (!last_) begin_again();
  const Instant instant{now, wall.empty() ? Vec3::Zero() : world.walls()[wall_].velocity, look(world)};
  // The acceleration of a wall is known from the second sample on.
  if (!first_time_ && (wall.empty() || last_)) first_time_ = now;
  // Counted, not summed up, so that the points do not drift.
  for (double at; first_time_ && (at = *first_time_ + static_cast<double>(count_) * interval) <= now; ++count_) {
    const double part = last_ ? (at - last_->time) / (now - last_->time) : 1;
    for (std::size_t i = 0; i < welch_.size(); ++i)
      welch_[i].add(std::lerp(last_ ? last_->signals[i] : instant.signals[i], instant.signals[i], part));
  }
  last_ = instant;
}

void Spectrum::sample(const World& world, ChannelValues& values) {
  take(world);
  const auto frequency = values.list("frequency");
  for (std::size_t k = 0; k < frequency.size(); ++k)
    frequency[k] = static_cast<double>(k) / (static_cast<double>(points) * interval);
  for (std::size_t i = 0; i < welch_.size(); ++i)
    std::ranges::copy(welch_[i].mean(), values.list(densities[i]).begin());
  values["windows"] = static_cast<double>(welch_.front().windows());
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "probe",
                                     .name = "spectrum",
                                     .version = "1.0.0",
                                     .doc = "power spectra of acceleration and pressure of a wall or a box",
                                     .make_probe = []() -> grit::Probe* { return new grit::Spectrum; }};
  return &info;
}
