// Forwards everything to the results, reports how each stage ended, and keeps the curves of /output/summary.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "input/scene.hpp"
#include "output/single_channels.hpp"
#include "run/recorder.hpp"

namespace grit {

class CurveSummary final : public Recorder {
 public:
  /// `say` gets one line per stage that ends.
  CurveSummary(Recorder& next, const Scene& scene, std::function<void(const std::string&)> say);

  /// Throws DescriptionError if the output names channels or fields that no probe has.
  void begin(const World& world, std::span<const ProbeGroup> probes) override;
  void expect_room() const override { next_.expect_room(); }
  void sample(std::size_t probe, const World& world, std::span<const std::span<const double>> values) override;
  void frame(const World& world, std::span<const FieldGroup> fields) override { next_.frame(world, fields); }
  void stage_ended(const World& world, const std::string& what) override;
  void flush() override { next_.flush(); }
  void serialize(Archive& archive) override;
  void finish(const World& world, const RunSummary& summary) override { next_.finish(world, summary); }

  /// One line per channel: value of largest magnitude and last value, with units.
  std::string text() const;

 private:
  struct Curve {
    SingleChannel channel;
    double largest = 0, last = 0;
    bool any = false;
  };
  Recorder& next_;
  const Scene& scene_;
  std::function<void(const std::string&)> say_;
  std::vector<Curve> curves_;
};

}  // namespace grit
