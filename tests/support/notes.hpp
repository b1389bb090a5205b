// Runs of whole descriptions whose results are kept in memory.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "grit/plugin.hpp"
#include "grit/probe.hpp"
#include "support/recorded.hpp"

namespace grit::test {

/// What a run reported.
struct Notes final : Recorder {
  struct Sample {
    std::string probe, stage;
    std::uint64_t step;
    double time;
    std::vector<double> values;  ///< of the first channel
  };
  std::vector<ProbeGroup> groups;
  std::vector<Sample> samples;
  std::vector<std::uint64_t> frames;             ///< steps
  std::vector<std::vector<std::string>> mapped;  ///< whose fields each frame has
  std::vector<std::string> ended;                ///< what stages reached
  std::vector<std::uint64_t> ended_at;           ///< steps
  int begun = 0, finished = 0;
  RunSummary summary;

  void begin(const World&, std::span<const ProbeGroup> probes) override {
    groups.assign(probes.begin(), probes.end());
    ++begun;
  }
  void sample(std::size_t probe, const World& world, std::span<const std::span<const double>> values) override {
    samples.push_back({groups.at(probe).name, world.stage(), world.step(), world.time(),
                       std::vector<double>(values[0].begin(), values[0].end())});
  }
  void frame(const World& world, std::span<const FieldGroup> fields) override {
    frames.push_back(world.step()), mapped.emplace_back();
    for (const FieldGroup& group : fields) mapped.back().push_back(group.name);
  }
  void stage_ended(const World& world, const std::string& what) override {
    ended.push_back(what), ended_at.push_back(world.step());
  }
  void finish(const World&, const RunSummary& how) override { summary = how, ++finished; }

  std::vector<std::uint64_t> steps_of(const std::string& probe) const {
    std::vector<std::uint64_t> steps;
    for (const Sample& s : samples)
      if (s.probe == probe) steps.push_back(s.step);
    return steps;
  }
  std::vector<double> values_of(const std::string& probe) const {
    std::vector<double> values;
    for (const Sample& s : samples)
      if (s.probe == probe) values.push_back(s.values.front());
    return values;
  }
};

/// The probe "watch" reports what this says.
inline std::function<double(const World&)>& watched() {
  static std::function<double(const World&)> function;
  return function;
}

class Watch final : public Probe {
 public:
  void declare(Parameters&) override {}
  std::vector<Channel> channels() const override { return {{"value", "1", "what the test asks for", {}}}; }
  void sample(const World& world, ChannelValues& values) override {
    values["value"] = watched() ? watched()(world) : 0;
  }
};

/// A description that has been run.
struct Done {
  std::unique_ptr<Notes> recorder = std::make_unique<Notes>();
  Notes& notes = *recorder;
  std::unique_ptr<Simulation> simulation;
  const Kernel* kernel = nullptr;
  const RunSummary& summary() const { return notes.summary; }
};

/// `prepare` gets the simulation before it runs.
inline Done run(const Description& plain, const std::function<void(Simulation&)>& prepare = {}) {
  static const PluginInfo watch = [] {
    PluginInfo info;
    info.kind = "probe", info.name = "watch", info.version = "1.0.0", info.doc = "what a test asks for";
    info.make_probe = []() -> Probe* { return new Watch; };
    return info;
  }();
  installed().add(watch);
  Done done;
  done.simulation = std::make_unique<Simulation>(recorded(scene_of(plain), done.notes, 1, StateRequest()));
  done.kernel = &kernel_of(*done.simulation);
  if (prepare) prepare(*done.simulation);
  run_recorded(*done.simulation);
  return done;
}

}  // namespace grit::test
