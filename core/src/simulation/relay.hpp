// A recorder that hands everything on to another one, if there is one.
#pragma once

#include "run/recorder.hpp"

namespace grit {

class Relay final : public Recorder {
 public:
  void set(Recorder& next) { next_ = &next; }

  void begin(const World& world, std::span<const ProbeGroup> probes) override {
    if (next_ != nullptr) next_->begin(world, probes);
  }
  void sample(std::size_t probe, const World& world, std::span<const std::span<const double>> values) override {
    if (next_ != nullptr) next_->sample(probe, world, values);
  }
  void frame(const World& world, std::span<const FieldGroup> fields) override {
    if (next_ != nullptr) next_->frame(world, fields);
  }
  void stage_ended(const World& world, const std::string& what) override {
    if (next_ != nullptr) next_->stage_ended(world, what);
  }
  void flush() override {
    if (next_ != nullptr) next_->flush();
  }
  void remember(Memory& memory) override {
    if (next_ != nullptr) next_->remember(memory);
  }
  void checkpoint(const Checkpoint& checkpoint) override {
    if (next_ != nullptr) next_->checkpoint(checkpoint);
  }
  void finish(const World& world, const RunSummary& summary) override {
    if (next_ != nullptr) next_->finish(world, summary);
  }

 private:
  Recorder* next_ = nullptr;
};

}  // namespace grit
