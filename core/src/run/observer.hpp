// A probe of the description at work.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <sstream>
#include <string>
#include <typeinfo>
#include <utility>
#include <vector>

#include "description/placed_error.hpp"
#include "kernel/stopwatch.hpp"
#include "plugins/component_memory.hpp"
#include "run/recorder.hpp"
#include "run/schedule.hpp"

namespace grit {

/// Samples when its schedule says, once a step at most, and in the stages that it watches.
class Observer {
 public:
  Observer(const std::string& name, const ProbeDescription& description, std::shared_ptr<Probe> probe,
           const World& world)
      : name_(name), description_(&description), probe_(std::move(probe)), schedule_(description.cadence) {
    prepare(description.probe.type(), world);
    for (const Channel& channel : probe_->channels()) {
      std::size_t size = 1;
      for (const std::size_t n : channel.shape) size *= n;
      values_.emplace_back(size);
    }
  }
  ProbeGroup group() const { return {name_, probe_->channels()}; }
  bool watches(const std::string& stage) const {
    return description_->stages.empty() ||
           std::find(description_->stages.begin(), description_->stages.end(), stage) != description_->stages.end();
  }
  Schedule& schedule() { return schedule_; }
  void sample(std::size_t index, const World& world, Recorder& recorder) {
    if (last_step_ == world.step()) return;
    last_step_ = world.step();
    std::vector<std::span<double>> out(values_.begin(), values_.end());
    ++samples_;
    {
      const Stopwatch watch(seconds_);
      probe_->sample(world, out);
    }
    const std::vector<std::span<const double>> in(values_.begin(), values_.end());
    recorder.sample(index, world, in);
  }
  ProbeTime cost() const { return {name_, samples_, seconds_}; }
  bool in_frames() const { return description_->frames; }
  void remember(Memory& memory) {
    memory(schedule_, last_step_, samples_, seconds_);
    remember_by_itself("probe \"" + name_ + '"', *probe_, memory);
  }
  FieldGroup fields(const World& world) const { return {name_, probe_->fields(world)}; }

 private:
  /// What a probe says against the world begins with "probe TYPE" and, as a rule, the key that it means: ", /KEY".
  void prepare(const std::string& type, const World& world) const try {
    probe_->prepare(world);
  } catch (const Error& error) {
    if (typeid(error) != typeid(Error)) throw;  // says by its kind what it is about
    std::vector<std::string> keys{"probes", name_};
    std::string what = error.what();
    const std::size_t colon = what.find(": ");
    if (const std::string who = "probe " + type; what.starts_with(who) && colon != std::string::npos) {
      std::istringstream pointer(what.substr(who.size(), colon - who.size()));
      std::string key;
      if (std::getline(pointer, key, '/') && key == ", ")
        while (std::getline(pointer, key, '/')) keys.push_back(key);
      what.erase(0, colon + 2);
    }
    throw PlacedError(std::move(keys), what);
  }

  std::string name_;
  const ProbeDescription* description_;
  std::shared_ptr<Probe> probe_;
  Schedule schedule_;
  std::vector<std::vector<double>> values_;
  std::uint64_t last_step_ = ~0ull, samples_ = 0;
  double seconds_ = 0;
};

}  // namespace grit
