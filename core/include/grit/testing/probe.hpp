// What every probe must do. A plugin's test names its cases:
//   INSTANTIATE_TEST_SUITE_P(Walls, ProbeContract, testing::Values(…), probe_case_name);
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "grit/error.hpp"
#include "grit/probe.hpp"
#include "grit/testing/lattice_world.hpp"

namespace grit {

/// A probe with its parameters set, not yet prepared, and a world to look at.
struct ProbeCase {
  std::string name;
  std::function<std::shared_ptr<Probe>()> make;
  std::function<FakeWorld()> world = [] { return lattice_world(6, 4, 8); };
};

inline void PrintTo(const ProbeCase& one, std::ostream* out) { *out << one.name; }
inline std::string probe_case_name(const testing::TestParamInfo<ProbeCase>& info) { return info.param.name; }

/// Room for one sample, filled with a NaN that no computation yields; a mark behind each channel shows writing past its
/// end.
class SampleRoom {
 public:
  explicit SampleRoom(const std::vector<Channel>& channels) {
    for (const auto& channel : channels) {
      std::size_t size = 1;
      for (const auto extent : channel.shape) size *= extent;
      rooms_.emplace_back(size + 1, unwritten());
    }
    for (auto& room : rooms_) spans_.emplace_back(room.data(), room.size() - 1);
  }
  std::span<const std::span<double>> spans() const { return spans_; }
  const std::vector<std::vector<double>>& rooms() const { return rooms_; }
  std::span<const double> operator[](std::size_t channel) const { return spans_[channel]; }

  static double unwritten() { return std::nan("0x5ca1e"); }
  static bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }
  friend bool operator==(const SampleRoom& a, const SampleRoom& b) {
    if (a.rooms_.size() != b.rooms_.size()) return false;
    for (std::size_t i = 0; i < a.rooms_.size(); ++i)
      if (a.rooms_[i].size() != b.rooms_[i].size() ||
          std::memcmp(a.rooms_[i].data(), b.rooms_[i].data(), a.rooms_[i].size() * sizeof(double)) != 0)
        return false;
    return true;
  }

 private:
  std::vector<std::vector<double>> rooms_;
  std::vector<std::span<double>> spans_;
};

/// Samples a prepared probe.
inline SampleRoom sampled(Probe& probe, const World& world) {
  SampleRoom room(probe.channels());
  probe.sample(world, room.spans());
  return room;
}

/// The values of one channel of a prepared probe. Throws Error if there is no such channel.
inline std::vector<double> channel_values(Probe& probe, const World& world, const std::string& name) {
  const auto channels = probe.channels();
  const auto room = sampled(probe, world);
  for (std::size_t i = 0; i < channels.size(); ++i)
    if (channels[i].name == name) return {room[i].begin(), room[i].end()};
  throw Error("there is no channel " + name);
}

/// The same of a channel that is one number.
inline double channel_value(Probe& probe, const World& world, const std::string& name) {
  return channel_values(probe, world, name).at(0);
}

/// What the checks of a probe's parameters complain about, one to a line.
inline std::string complaints(Probe& probe) {
  Parameters parameters;
  probe.declare(parameters);
  std::string all;
  for (const auto& check : parameters.checks())
    check.run([&](std::string_view key, std::string_view found, std::string_view allowed) {
      all += std::string(key) + ": found " + std::string(found) + ", allowed: " + std::string(allowed) + "\n";
    });
  return all;
}

class ProbeContract : public testing::TestWithParam<ProbeCase> {
 protected:
  void SetUp() override {
    world_ = GetParam().world();
    probe_ = GetParam().make();
    probe_->prepare(world_);
  }

  FakeWorld world_;
  std::shared_ptr<Probe> probe_;
};

/// Links the tests with a program that includes this file.
int probe_contract();
inline const int probe_contract_is_linked = probe_contract();

}  // namespace grit
