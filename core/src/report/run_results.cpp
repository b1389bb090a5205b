#include "report/run_results.hpp"

#include <algorithm>
#include <cmath>

#include "format/symbols.hpp"
#include "grit/error.hpp"
#include "output/read_frames.hpp"

namespace grit {
namespace {

std::vector<ProbeSeries> read_probes(const SeriesFile& series, std::vector<std::string>& problems) {
  std::vector<ProbeSeries> probes;
  for (const std::string& full : series.channels()) {
    const auto slash = full.find('/');
    const std::string probe = full.substr(0, slash), channel = full.substr(slash + 1);
    if (channel == "step") continue;
    if (probes.empty() || probes.back().name != probe) probes.push_back({probe, {}});
    try {
      probes.back().channels.push_back({channel, series.channel(full)});
    } catch (const std::exception& error) {
      problems.emplace_back(error.what());
    }
  }
  for (ProbeSeries& probe : probes)
    std::ranges::stable_partition(probe.channels, [](const auto& channel) { return channel.name == "time"; });
  std::ranges::stable_partition(probes, [](const ProbeSeries& probe) { return probe.name == "test"; });
  return probes;
}

}  // namespace

std::string ProbeSeries::Channel::label() const {
  const std::string along = ", along ", &doc = sampled.doc;
  const std::size_t length = along.size() + 1;
  const bool places = name == "position" && sampled.unit == "m" && doc.size() > length;
  if (places && doc.compare(doc.size() - length, along.size(), along) == 0 && doc.back() >= 'x' && doc.back() <= 'z')
    return {doc.back()};
  return spelled(name);
}

bool ProbeSeries::Channel::zero_throughout() const {
  bool finite = false;
  for (const double value : sampled.values) {
    if (!std::isfinite(value)) continue;
    if (value != 0) return false;
    finite = true;
  }
  return finite;
}

const ProbeSeries::Channel* ProbeSeries::channel(const std::string& wanted) const {
  const auto found = std::ranges::find(channels, wanted, &Channel::name);
  return found == channels.end() ? nullptr : &*found;
}

const Description& RunResults::at(const std::string& pointer) const {
  static const Description nothing;
  const Description::json_pointer place(pointer);
  return json.contains(place) ? json.at(place) : nothing;
}

NamedChannel RunResults::find(const std::string& curve) const {
  const auto slash = curve.find('/');
  if (slash == std::string::npos) return {};
  const auto probe = std::ranges::find(probes, curve.substr(0, slash), &ProbeSeries::name);
  if (probe == probes.end()) return {};
  return {&*probe, probe->channel(curve.substr(slash + 1))};
}

NamedChannel RunResults::abscissa_of(const NamedChannel& curve) const {
  const Description& wanted = at("/description/output/picture/x");
  if (wanted.is_string())
    if (const NamedChannel x = find(wanted.get<std::string>()); x.is_scalar()) return x;
  return {curve.probe, curve.probe->channel("time")};
}

std::string RunResults::title() const {
  const Description& title = at("/description/title");
  return title.is_string() && !title.get_ref<const std::string&>().empty() ? title.get<std::string>() : name;
}

bool RunResults::asks_for(const std::string& curve) const {
  for (const Description& drawn : at("/description/output/picture/y"))
    if (drawn == curve) return true;
  for (const Description& reference : at("/description/output/references"))
    if (reference.is_object() && reference.contains("of") && reference["of"] == curve) return true;
  return false;
}

RunResults read_results(const std::filesystem::path& folder, std::chrono::milliseconds patience) {
  RunResults results;
  results.folder = folder;
  std::error_code none;
  const auto whole = std::filesystem::canonical(folder, none);
  results.name = (none ? folder : whole).filename().string();
  if (!std::filesystem::is_directory(folder, none))
    throw FileError(folder.string() + ": there is no such folder; give one that 'grit run' has written");
  results.frames = frame_files(folder);
  const bool has_json = std::filesystem::exists(folder / "run.json", none);
  if (!has_json && !std::filesystem::exists(folder / "series.h5", none) && results.frames.empty())
    throw FileError(folder.string() +
                    ": holds no run: there is neither run.json nor series.h5 nor a frame; give a folder that 'grit "
                    "run' has written");
  auto json = read_run_json(folder);
  if (!json && !std::filesystem::exists(folder / "series.h5", none) && results.frames.empty())
    throw FileError((folder / "run.json").string() +
                    ": is not the JSON of a run, and there is neither series.h5 nor a frame; give a folder that 'grit "
                    "run' has written");
  if (json) results.json = std::move(*json);
  else
    results.problems.push_back((folder / "run.json").string() +
                               (has_json ? ": is not the JSON of a run" : ": there is no such file"));
  try {
    results.probes = read_probes(SeriesFile(folder, patience), results.problems);
  } catch (const FileError& error) {
    results.problems.emplace_back(error.what());
    results.unsettled = dynamic_cast<const BeingWritten*>(&error) != nullptr;
  }
  return results;
}

void make_names_unique(std::vector<RunResults>& runs) {
  const auto rename_alike = [&](auto name_of) {
    std::vector<std::size_t> alike;
    for (std::size_t i = 0; i < runs.size(); ++i)
      if (std::ranges::count(runs, runs[i].name, &RunResults::name) > 1) alike.push_back(i);
    for (const std::size_t i : alike) runs[i].name = name_of(i);
  };
  rename_alike([&](std::size_t i) { return runs[i].folder.lexically_normal().string(); });
  rename_alike([&](std::size_t i) { return runs[i].name + " (" + std::to_string(i + 1) + ")"; });
}

}  // namespace grit
