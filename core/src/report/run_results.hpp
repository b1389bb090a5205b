// The results in a folder, as far as they are readable.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "grit/description.hpp"
#include "output/read_results.hpp"

namespace grit {

/// A probe's group of series.h5.
struct ProbeSeries {
  struct Channel {
    std::string name;
    SampledChannel sampled;
    /// Numbers per sample; 1 without samples.
    std::size_t width() const { return sampled.samples == 0 ? 1 : sampled.values.size() / sampled.samples; }
    /// Title of an axis: x, y or z for positions whose doc names that axis, otherwise the readable name.
    std::string label() const;
    /// Whether there are finite numbers, and all of them are 0.
    bool zero_throughout() const;
  };
  std::string name;
  std::vector<Channel> channels;  ///< "time" first
  const Channel* channel(const std::string& name) const;
};

/// A channel with its probe; null if there is none.
struct NamedChannel {
  const ProbeSeries* probe = nullptr;
  const ProbeSeries::Channel* channel = nullptr;
  bool is_scalar() const { return channel && channel->width() == 1; }
  bool is(const std::string& full) const { return probe->name + '/' + channel->name == full; }
};

struct RunResults {
  std::filesystem::path folder;
  std::string name;                           ///< of the folder
  Description json = Description::object();   ///< run.json; empty if unreadable
  std::vector<ProbeSeries> probes;            ///< "test" first
  std::vector<std::filesystem::path> frames;  ///< not opened yet
  std::vector<std::string> problems;          ///< unreadable files, and why; one sentence each
  bool unsettled = false;                     ///< series.h5 was being written at each attempt to read

  /// The value at a JSON pointer of run.json; null if there is none.
  const Description& at(const std::string& pointer) const;
  /// The channel of a curve, "probe/channel".
  NamedChannel find(const std::string& curve) const;
  /// The abscissa of a curve: that of the description's picture, or time.
  NamedChannel abscissa_of(const NamedChannel& curve) const;
  std::string title() const;  ///< of the description, or the folder's name
  /// Whether the description names a curve, "probe/channel", in its picture or in a reference.
  bool asks_for(const std::string& curve) const;
};

/// Unreadable files are added to the problems. Throws FileError if the folder holds no run.
RunResults read_results(const std::filesystem::path& folder, std::chrono::milliseconds patience = reader_patience);

/// Makes names unique: by paths for folders of the same name, by numbers for a folder given twice.
void make_names_unique(std::vector<RunResults>& runs);

}  // namespace grit
