// A recorder that writes nothing.
#pragma once

#include "run/recorder.hpp"

namespace grit {

class NoRecorder final : public Recorder {
 public:
  void begin(const World&, std::span<const ProbeGroup>) override {}
  void sample(std::size_t, const World&, std::span<const std::span<const double>>) override {}
  void frame(const World&, std::span<const FieldGroup>) override {}
  void stage_ended(const World&, const std::string&) override {}
  void finish(const World&, const RunSummary&) override {}
};

}  // namespace grit
