// Reads back what a run has left in its folder.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "grit/description.hpp"

namespace grit {

/// A channel over all samples of its probe.
struct SampledChannel {
  std::string unit, doc;
  std::string coordinate = {};  ///< the channel of the same probe that says where each number is; may be empty
  std::vector<std::string> components = {};  ///< what each number of a sample is; may be empty
  std::size_t samples = 0;
  std::vector<double> values;  ///< sample after sample; one number each, or as many as the channel's shape has
};

/// `name` is "probe/channel"; "probe/time" is there for each probe. Throws FileError, which lists what there is.
SampledChannel read_channel(const std::filesystem::path& folder, const std::string& name);

/// All of series.h5 as "probe/channel", sorted; of each probe "probe/time" and "probe/step" too. Throws FileError.
std::vector<std::string> channel_names(const std::filesystem::path& folder);

/// run.json; nothing if there is none, or none that can be read.
std::optional<Description> read_run_json(const std::filesystem::path& folder);

}  // namespace grit
