// The curves of a description of sims/ that is run to its end.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <span>
#include <string>
#include <vector>

#include "input/scene.hpp"
#include "support/recorded.hpp"

namespace grit::test {

/// Every channel that is one number, as "probe/channel"; of probe "test" by the channel alone.
struct Curves : Recorder {
  std::map<std::string, std::vector<double>> channel;
  RunSummary summary;

  void begin(const World&, std::span<const ProbeGroup> probes) override {
    for (const ProbeGroup& probe : probes) {
      names_.emplace_back();
      for (const Channel& c : probe.channels)
        names_.back().push_back(probe.name == "test" ? c.name : probe.name + "/" + c.name);
    }
  }
  void sample(std::size_t probe, const World&, std::span<const std::span<const double>> values) override {
    for (std::size_t i = 0; i < values.size(); ++i)
      if (values[i].size() == 1) channel[names_[probe][i]].push_back(values[i][0]);
  }
  void frame(const World&, std::span<const FieldGroup>) override {}
  void stage_ended(const World&, const std::string&) override {}
  void finish(const World&, const RunSummary& how) override { summary = how; }

  /// Mean over a share of the samples.
  double mean(const std::string& name, double from, double to) const {
    const auto& values = channel.at(name);
    const auto at = [&](double share) { return static_cast<std::size_t>(share * static_cast<double>(values.size())); };
    double sum = 0;
    for (std::size_t i = at(from); i < at(to); ++i) sum += values[i];
    return sum / static_cast<double>(at(to) - at(from));
  }

 private:
  std::vector<std::vector<std::string>> names_;
};

/// Time steps as long as in docs/evidence/silos.md, for quasi-static tests in which impacts are of no account, and no
/// energy balance: half of the time.
inline std::vector<std::string> with_long_steps(std::vector<std::string> sets) {
  sets.insert(sets.end(), {"/time_step/safety=0.95", "/time_step/steps_per_impact=4", "/probes/energy=null"});
  return sets;
}

/// Runs a description of the repository with `sets` ("/pointer=value") to its end on two threads.
inline void run_to_the_end(const std::string& file, const std::vector<std::string>& sets, Curves& curves) {
  Simulation simulation = recorded(load_scene(std::string(GRIT_SOURCE_DIR) + "/" + file, sets, installed()), curves, 2);
  run_recorded(simulation);
  EXPECT_EQ(curves.summary.status, "done") << curves.summary.message;
}

}  // namespace grit::test
