// What the probes of the description have sampled, in memory.
#pragma once

#include <pybind11/numpy.h>

#include <cstdint>
#include <string>
#include <vector>

#include "run/recorder.hpp"

namespace grit::python {

namespace py = pybind11;

/// Keeps all samples, 8 bytes for each number. They are no part of checkpoints: a simulation that resumes records from
/// there on.
class Samples final : public Recorder {
 public:
  void begin(const World&, std::span<const ProbeGroup> probes) override;
  void sample(std::size_t probe, const World& world, std::span<const std::span<const double>> values) override;
  void frame(const World&, std::span<const FieldGroup>) override {}
  void stage_ended(const World&, const std::string&) override {}
  void finish(const World&, const RunSummary&) override {}

  /// A copy of a column of this probe: "time", "step" or a channel, one row per sample. None before the first sample.
  py::array column(const ProbeGroup& probe, const std::string& name) const;

 private:
  struct Table {
    std::string probe;
    std::vector<double> time;
    std::vector<std::uint64_t> step;
    std::vector<std::vector<double>> channels;  // row by row
  };
  std::vector<Table> tables_;
};

}  // namespace grit::python
