// All that a folder of results says, as far as it can be read.
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
    /// Numbers a sample; 1 where there is no sample.
    std::size_t width() const { return sampled.samples == 0 ? 1 : sampled.values.size() / sampled.samples; }
    /// At an axis: x, y or z of places that its line says are along that one, else its name as people write it.
    std::string label() const;
    /// Whether there are finite numbers, and all of them are 0.
    bool zero_throughout() const;
  };
  std::string name;
  std::vector<Channel> channels;  ///< "time" first
  const Channel* channel(const std::string& name) const;
};

struct RunResults {
  std::filesystem::path folder;
  std::string name;                           ///< of the folder
  Description json = Description::object();   ///< run.json; empty where it cannot be read
  std::vector<ProbeSeries> probes;            ///< "test" first
  std::vector<std::filesystem::path> frames;  ///< not opened yet
  std::vector<std::string> problems;          ///< what could not be read, and why; one sentence each
  bool unsettled = false;                     ///< series.h5 was being written to whenever it was looked at

  /// What is at a JSON pointer of run.json; null where there is nothing.
  const Description& at(const std::string& pointer) const;
  std::string title() const;  ///< of the description, or the folder's name
  /// Whether the description asks for a curve, "probe/channel": its picture names it, or a reference is beside it.
  bool asks_for(const std::string& curve) const;
};

/// What cannot be read is among the problems. Throws FileError where nothing in the folder is of a run.
RunResults read_results(const std::filesystem::path& folder, std::chrono::milliseconds patience = reader_patience);

/// Folders of one name are called by their ways, and the same folder given twice by its place.
void tell_apart(std::vector<RunResults>& runs);

}  // namespace grit
