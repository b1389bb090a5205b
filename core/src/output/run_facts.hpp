// What a run is of: its description, and the program and the plugins that run it.
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

/// What bodies of a group are, where they are clumps.
struct ClumpFacts {
  std::size_t spheres = 0;
  ShapeErrors errors;
};

/// What is known before a run begins.
struct RunFacts {
  Description description;  ///< resolved: everything inherited, set, and by default
  std::vector<PluginUsed> plugins;
  std::int64_t seed = 0;
  unsigned threads = 1;
  std::map<std::string, ClumpFacts> clumps;  ///< by the name of their group
};

/// This grit: version, revision, compiler and so on.
Description grit_facts();
/// Of a plugin: kind, name, version, file, and how it was built, with a checksum of the file.
Description plugin_facts(const PluginUsed& used);

}  // namespace grit
