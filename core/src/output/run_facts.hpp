// Facts of a run: its description, the program and the plugins.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "grit/body_kind.hpp"
#include "grit/description.hpp"
#include "grit/plugin.hpp"

namespace grit {

/// A plugin that takes part in a run.
struct PluginUsed {
  std::string kind, name, version;
  std::filesystem::path file;  ///< empty for a built-in component
  BuildTag tag;
};

/// Facts of a group of clumps.
struct ClumpFacts {
  std::size_t spheres = 0;
  ShapeErrors errors;
};

/// Where a description comes from.
struct DescriptionSource {
  std::string path = {};               ///< of its file
  Description written = nullptr;       ///< JSON of that file alone; null if it cannot be read twice, as a pipe
  std::vector<std::string> sets = {};  ///< "/pointer=value", in order
  Description unexpanded = nullptr;    ///< with inherited and set values; null without a scenario
};

/// Facts that are known before a run begins.
struct RunFacts {
  Description description;  ///< resolved: with inherited, set and default values
  std::vector<PluginUsed> plugins;
  std::int64_t seed = 0;
  unsigned threads = 1, ranks = 1;
  std::string engine = "cpu";  ///< what steps the bodies
  std::map<std::string, ClumpFacts> clumps;  ///< by name of the group
  DescriptionSource source = {};
  /// Points of the reference curves, {"x": […], "y": […]} by name: a page needs no file beside the folder of results.
  Description references = Description::object();
  std::vector<std::vector<std::string>> commands = {};  ///< command lines, of the start and of each resumption
};

/// Precedes the command of a resumed run by those in its run.json. With `own_description` the run continues with the
/// description in its results folder: its source stays that in run.json, with the assignments of this command added.
void continue_from(const Description& run_json, bool own_description, RunFacts& facts);

/// This grit: version, revision, compiler and so on.
Description grit_facts();
/// Kind, name, version, file and build of a plugin, with a checksum of the file.
Description plugin_facts(const PluginUsed& used);

}  // namespace grit
