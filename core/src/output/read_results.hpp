// Reads the results of a run.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "grit/description.hpp"
#include "grit/error.hpp"
#include "storage/hdf5.hpp"

namespace grit {

/// All samples of a channel.
struct SampledChannel {
  std::string unit, doc;
  std::string coordinate = {};  ///< channel of the same probe with the coordinates of the values; may be empty
  std::vector<std::string> components = {};  ///< names of the values of a sample; may be empty
  std::size_t samples = 0;
  std::vector<double> values;  ///< sample by sample; one value each, or as many as the channel's shape has
};

/// A file that a run was writing at every attempt to read it.
class BeingWritten : public FileError {
 public:
  using FileError::FileError;
};

/// For how long reading a file that is being written is retried. A run writes for some milliseconds per second, but
/// longer on an overloaded machine or if it is suspended.
constexpr std::chrono::milliseconds reader_patience{5000};

/// A consistent copy of series.h5, taken between two flushes of a run that may continue: all channels of a probe have
/// the same number of samples. All functions throw FileError.
class SeriesFile {
 public:
  /// Throws BeingWritten after `patience`.
  explicit SeriesFile(const std::filesystem::path& folder, std::chrono::milliseconds patience = reader_patience);

  /// "probe/channel", sorted, including "probe/time" and "probe/step".
  std::vector<std::string> channels() const;
  /// Reads one of channels(). For another name the error lists the available ones.
  SampledChannel channel(const std::string& name) const;

 private:
  hdf5::File file_;
};

/// One channel of SeriesFile.
SampledChannel read_channel(const std::filesystem::path& folder, const std::string& name);

/// run.json; nothing if it is missing or unreadable.
std::optional<Description> read_run_json(const std::filesystem::path& folder);

}  // namespace grit
