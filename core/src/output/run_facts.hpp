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

/// Facts that are known before a run begins.
struct RunFacts {
  Description description;  ///< resolved: with inherited, set and default values
  std::vector<PluginUsed> plugins;
  std::int64_t seed = 0;
  unsigned threads = 1;
  std::map<std::string, ClumpFacts> clumps;  ///< by name of the group
};

/// This grit: version, revision, compiler and so on.
Description grit_facts();
/// Kind, name, version, file and build of a plugin, with a checksum of the file.
Description plugin_facts(const PluginUsed& used);

}  // namespace grit
