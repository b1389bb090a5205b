// A probe of the description at work.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <typeinfo>
#include <utility>
#include <vector>

#include "threads/stopwatch.hpp"
#include "description/placed_error.hpp"
#include "grit/toolkit/limited_fields.hpp"
#include "kernel/group_view.hpp"
#include "plugins/component_archive.hpp"
#include "run/recorder.hpp"
#include "run/schedule.hpp"

namespace grit {

/// Samples when its schedule says, once a step at most, and in the stages that it watches.
class Observer {
 public:
  /// Prepares the probe. Throws PlacedError for what it refuses.
  Observer(const std::string& name, const ProbeDescription& description, std::shared_ptr<Probe> probe,
           const World& world)
      : name_(name),
        description_(&description),
        probe_(std::move(probe)),
        groups_(description.groups),
        schedule_(description.cadence),
        group_{name, prepared_channels(world)},
        values_("probe \"" + name_ + "\" of type \"" + description.probe.type() + '"', group_.channels) {}
  /// Throws PlacedError if fields would be left out of a frame now.
  void check_fields(const World& world) try {
    if (const auto* limited = dynamic_cast<const LimitedFields*>(probe_.get())) limited->check_fields(seen(world));
  } catch (const ParameterError& error) {
    throw PlacedError(placed(error, {"probes", name_}));
  } catch (const Error& error) {
    if (typeid(error) != typeid(Error)) throw;
    throw PlacedError({"probes", name_}, error.what());
  }
  const std::string& name() const { return name_; }
  ProbeGroup group() const { return group_; }
  bool watches(const std::string& stage) const {
    return description_->stages.empty() ||
           std::find(description_->stages.begin(), description_->stages.end(), stage) != description_->stages.end();
  }
  Schedule& schedule() { return schedule_; }
  void sample(std::size_t index, const World& world, Recorder& recorder) {
    if (last_step_ == world.step()) return;
    last_step_ = world.step();
    ++samples_;
    {
      const Stopwatch watch(seconds_);
      values_.clear();
      probe_->sample(seen(world), values_);
      values_.check();
    }
    recorder.sample(index, world, values_.all());
  }
  ProbeTime cost() const { return {name_, samples_, seconds_}; }
  bool in_frames() const { return description_->frames; }
  void serialize(Archive& archive) {
    archive(schedule_, last_step_, samples_, seconds_);
    serialize_component("probe \"" + name_ + '"', *probe_, archive);
  }
  FieldGroup fields(const World& world) { return {name_, probe_->fields(seen(world))}; }

 private:
  /// The world as the probe sees it: of all bodies, or of its groups.
  const World& seen(const World& world) {
    if (description_->groups.empty()) return world;
    groups_.update(world);
    return groups_;
  }
  /// The channels of the probe, which is prepared.
  std::vector<Channel> prepared_channels(const World& world) try {
    if (!description_->groups.empty() && probe_->needs().has(BodyState::energy))
      throw PlacedError({"probes", name_, "groups"}, "the energy balance is that of all bodies; remove groups");
    probe_->prepare(seen(world));
    return probe_->channels();
  } catch (const ParameterError& error) {
    throw PlacedError(placed(error, {"probes", name_}));
  } catch (const Error& error) {
    if (typeid(error) != typeid(Error)) throw;  // its class says what it is about
    throw PlacedError({"probes", name_}, error.what());
  }

  std::string name_;
  const ProbeDescription* description_;
  std::shared_ptr<Probe> probe_;
  GroupView groups_;
  Schedule schedule_;
  ProbeGroup group_;  // read once: samples are taken by these channels
  ChannelValues values_;
  std::uint64_t last_step_ = ~0ull, samples_ = 0;
  double seconds_ = 0;
};

}  // namespace grit
