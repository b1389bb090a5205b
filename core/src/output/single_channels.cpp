#include "output/single_channels.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <iterator>

#include "grit/error.hpp"
#include "grit/toolkit/did_you_mean.hpp"
#include "storage/hdf5.hpp"

namespace grit {

SingleChannels::SingleChannels(std::span<const ProbeGroup> probes) {
  for (std::size_t p = 0; p < probes.size(); ++p) {
    all_.push_back({probes[p].name, "time", "s", p, std::nullopt});
    for (std::size_t c = 0; c < probes[p].channels.size(); ++c)
      if (const Channel& channel = probes[p].channels[c]; hdf5::product(channel.shape) == 1)
        all_.push_back({probes[p].name, channel.name, channel.unit, p, c});
  }
}

const SingleChannel* SingleChannels::find(const std::string& name) const {
  const auto found = std::ranges::find(all_, name, &SingleChannel::full_name);
  return found == all_.end() ? nullptr : &*found;
}

std::string SingleChannels::refusal(const std::string& name) const {
  std::vector<std::string> known;
  std::ranges::transform(all_, std::back_inserter(known), &SingleChannel::full_name);
  return fault_text(fmt::format("\"{}\", which is not a scalar channel of any probe", name) + did_you_mean(name, known),
                    known.empty() ? "none without probes" : fmt::format("one of {}", fmt::join(known, ", ")));
}

const SingleChannel& SingleChannels::at(const std::string& name, const std::string& pointer) const {
  if (const SingleChannel* found = find(name)) return *found;
  throw Error(pointer + ": " + refusal(name));
}

void SingleChannels::check(const Document& document, const OutputDescription& output) const {
  std::vector<Problem> problems;
  const auto expect = [&](const std::string& name, const std::string& pointer) {
    if (!find(name)) problems.push_back(document.problem("/output/" + pointer, refusal(name)));
  };
  if (output.picture) {
    expect(output.picture->x, "picture/x");
    for (std::size_t i = 0; i < output.picture->y.size(); ++i)
      expect(output.picture->y[i], fmt::format("picture/y/{}", i));
  }
  for (const auto& [name, reference] : output.references) {
    expect(reference.of, "references/" + pointer_token(name) + "/of");
    if (!reference.against.empty()) expect(reference.against, "references/" + pointer_token(name) + "/against");
  }
  for (std::size_t i = 0; i < output.summary.size(); ++i) expect(output.summary[i], fmt::format("summary/{}", i));
  if (!problems.empty()) throw DescriptionError(std::move(problems));
}

}  // namespace grit
