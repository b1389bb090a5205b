#include "output/read_results.hpp"

#include <spdlog/fmt/fmt.h>

#include <fstream>

#include "grit/error.hpp"
#include "output/hdf5.hpp"

namespace grit {
namespace {

std::string listed(const std::vector<std::string>& names) {
  return names.empty() ? "nothing" : fmt::format("{}", fmt::join(names, ", "));
}

hdf5::File series_of(const std::filesystem::path& folder) {
  const auto path = folder / "series.h5";
  if (!std::filesystem::exists(path)) throw FileError(path.string() + ": there is no such file");
  return {path, hdf5::Mode::read};
}

}  // namespace

SampledChannel read_channel(const std::filesystem::path& folder, const std::string& name) {
  const auto path = folder / "series.h5";
  const hdf5::File file = series_of(folder);
  const auto slash = name.find('/');
  const std::string probe = name.substr(0, slash), channel = slash == std::string::npos ? "" : name.substr(slash + 1);
  if (!file.has(probe))
    throw FileError(path.string() + ": there is no probe \"" + probe + "\" but " + listed(file.names()));
  const auto group = file.group(probe);
  if (channel.empty() || !group.has(channel))
    throw FileError(path.string() + ": probe \"" + probe + "\" has no channel \"" + channel + "\" but " +
                    listed(group.names()));
  const auto dataset = group.dataset(channel);
  const auto text = [&](const char* attribute, const char* otherwise) {
    return dataset.has_attribute(attribute) ? dataset.text(attribute) : otherwise;
  };
  return {text("units", "1"),          text("long_name", ""), text("coordinates", ""),
          dataset.words("components"), dataset.rows(),        dataset.read<double>()};
}

std::vector<std::string> channel_names(const std::filesystem::path& folder) {
  const hdf5::File file = series_of(folder);
  std::vector<std::string> names;
  for (const auto& probe : file.names())
    for (const auto& channel : file.group(probe).names()) names.push_back(probe + '/' + channel);
  return names;
}

std::optional<Description> read_run_json(const std::filesystem::path& folder) {
  std::ifstream file(folder / "run.json");
  if (!file) return std::nullopt;
  Description json = Description::parse(file, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  return json;
}

}  // namespace grit
