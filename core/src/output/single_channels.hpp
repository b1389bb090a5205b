// Scalar channels, which the picture, the references and the summary of a description may name.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "description/description.hpp"
#include "input/document.hpp"
#include "run/recorder.hpp"

namespace grit {

struct SingleChannel {
  std::string probe_name, name, unit;
  std::size_t probe = 0;
  std::optional<std::size_t> channel;  ///< empty: the time of the samples
  std::string full_name() const { return probe_name + '/' + name; }
  /// `values` of a sample of its probe.
  double of(const World& world, std::span<const std::span<const double>> values) const {
    return channel ? values[*channel].front() : world.time();
  }
};

/// The scalar channels of a run, and the sampling time of each probe, by "probe/channel".
class SingleChannels {
 public:
  explicit SingleChannels(std::span<const ProbeGroup> probes);
  /// `pointer`: location of the name in the description. Throws Error if there is no such channel.
  const SingleChannel& at(const std::string& name, const std::string& pointer) const;
  /// Throws DescriptionError with all names in the section that do not exist, each with its location.
  void check(const Document& document, const OutputDescription& output) const;

 private:
  const SingleChannel* find(const std::string& name) const;
  std::string refusal(const std::string& name) const;

  std::vector<SingleChannel> all_;
};

}  // namespace grit
