// Tests that every probe must pass. A plugin's test lists its cases:
//   INSTANTIATE_TEST_SUITE_P(Walls, ProbeContract, testing::Values(…), probe_case_name);
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <memory>
#include <ostream>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "grit/error.hpp"
#include "grit/probe.hpp"
#include "grit/testing/lattice_world.hpp"

namespace grit {

/// A probe with its parameters set, not yet prepared, and a world to sample.
struct ProbeCase {
  std::string name;
  std::function<std::shared_ptr<Probe>()> make;
  std::function<FakeWorld()> world = [] { return lattice_world(6, 4, 8); };
};

inline void PrintTo(const ProbeCase& one, std::ostream* out) { *out << one.name; }
inline std::string probe_case_name(const testing::TestParamInfo<ProbeCase>& info) { return info.param.name; }

/// The values of a prepared probe. Throws PluginError as in a run: for an unknown channel, and for a value that was not
/// written.
inline ChannelValues sampled(Probe& probe, const World& world) {
  ChannelValues values("the probe", probe.channels());
  probe.sample(world, values);
  values.check();
  return values;
}

/// Whether all values are identical bit for bit, including NaN.
inline bool same_bits(const ChannelValues& a, const ChannelValues& b) {
  return std::ranges::equal(a.all(), b.all(), [](std::span<const double> one, std::span<const double> other) {
    return one.size() == other.size() && (one.empty() || std::memcmp(one.data(), other.data(), one.size_bytes()) == 0);
  });
}

/// The values of one channel of a prepared probe. Throws PluginError if there is no such channel.
inline std::vector<double> channel_values(Probe& probe, const World& world, const std::string& name) {
  const ChannelValues values = sampled(probe, world);
  const auto list = values.list(name);
  return {list.begin(), list.end()};
}

/// The same for a channel with one number.
inline double channel_value(Probe& probe, const World& world, const std::string& name) {
  return channel_values(probe, world, name).at(0);
}

/// The complaints of the checks of a probe's parameters, one per line.
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

/// What every probe must fulfil.
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

/// Links the tests into a program that includes this file.
int probe_contract();
inline const int probe_contract_is_linked = probe_contract();

}  // namespace grit
