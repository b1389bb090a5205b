// Reads back what a run has left in its folder.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "grit/description.hpp"
#include "grit/error.hpp"
#include "output/hdf5.hpp"

namespace grit {

/// A channel over all samples of its probe.
struct SampledChannel {
  std::string unit, doc;
  std::string coordinate = {};  ///< the channel of the same probe that says where each number is; may be empty
  std::vector<std::string> components = {};  ///< what each number of a sample is; may be empty
  std::size_t samples = 0;
  std::vector<double> values;  ///< sample after sample; one number each, or as many as the channel's shape has
};

/// A file that a run was writing to whenever it was looked at.
class BeingWritten : public FileError {
 public:
  using FileError::FileError;
};

/// For how long a file is looked at again that is being written to. A run writes for some milliseconds a second; on a
/// machine that has too much to do, or where the run is halted, longer.
constexpr std::chrono::milliseconds reader_patience{5000};

/// series.h5 as it was between two flushes of the run, which may go on meanwhile: channels of a probe have as many
/// samples as each other. All functions throw FileError.
class SeriesFile {
 public:
  /// Throws BeingWritten where the patience is used up.
  explicit SeriesFile(const std::filesystem::path& folder, std::chrono::milliseconds patience = reader_patience);

  /// "probe/channel", sorted; of each probe "probe/time" and "probe/step" too.
  std::vector<std::string> channels() const;
  /// `name` is one of them; of others the error lists what there is.
  SampledChannel channel(const std::string& name) const;

 private:
  hdf5::File file_;
};

/// One channel of SeriesFile.
SampledChannel read_channel(const std::filesystem::path& folder, const std::string& name);

/// run.json; nothing if there is none, or none that can be read.
std::optional<Description> read_run_json(const std::filesystem::path& folder);

}  // namespace grit
