// Acceleration and pressure of a wall, or of the grains in a box, by frequency. See README.md.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "grit/probe.hpp"
#include "welch.hpp"

namespace grit {

class Spectrum final : public Probe {
 public:
  std::string wall;
  std::optional<Vec3> region_low, region_high;  ///< m
  double interval = 1e-4;                       ///< s
  std::int64_t points = 256, windows = 8;

  void declare(Parameters& parameters) override;
  /// Throws ParameterError for a wall that does not exist, and for a box that is longer than a period of the domain.
  void prepare(const World& world) override;
  std::vector<Channel> channels() const override;
  void sample(const World& world, ChannelValues& values) override;
  void serialize(Archive& archive) override;

 private:
  using Signals = std::array<double, 4>;  ///< acceleration along x, y, z [m/s²], pressure [Pa]
  struct Instant {
    double time;    ///< s
    Vec3 velocity;  ///< of the wall [m/s]
    Signals signals;
    void serialize(Archive& archive) { archive(time, velocity, signals); }
  };
  Signals look(const World& world) const;
  void take(const World& world);
  void begin_again() {
    first_time_.reset(), count_ = 0;
    welch_.assign(4, Welch(static_cast<std::size_t>(points), interval, static_cast<std::size_t>(windows)));
  }

  std::size_t wall_ = 0;
  std::optional<Instant> last_;
  std::optional<double> first_time_;  ///< of the evenly spaced points [s]; none before all signals are known
  std::uint64_t count_ = 0;           ///< of the points
  std::vector<Welch> welch_;
};

}  // namespace grit
