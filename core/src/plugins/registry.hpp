// What is there to choose from: built-in components and plugins on the search path, loaded when asked for.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "plugins/kind.hpp"

namespace grit {

/// One entry of `grit plugins`.
struct Installed {
  std::string kind, name;
  std::filesystem::path file;  ///< empty for a built-in component
};

/// Not copied: components hold a pointer to it. Safe to use from one thread. What it made stays valid without it.
class Registry {
 public:
  /// Directories are searched in this order; each holds one folder a kind with <name>.so in it.
  explicit Registry(std::vector<std::filesystem::path> directories);
  Registry(const Registry&) = delete;
  Registry& operator=(const Registry&) = delete;

  /// Adds a component that needs no file. Its name wins over files. `info` must outlive the registry.
  void add(const PluginInfo& info);

  /// Everything that may be chosen, by kind and name; files are listed, not opened.
  std::vector<Installed> installed() const;
  /// The names of one kind, sorted; files are listed, not opened. Throws PluginError for a kind that is none.
  std::vector<std::string> names(const std::string& kind) const;
  /// Loads, if need be, and checks the plugin. Throws PluginError: unknown (with the nearest name and the directories
  /// searched), not loadable, built differently (every mismatch), wrong kind or name, no maker.
  const PluginInfo& info(const std::string& kind, const std::string& name) const;
  /// The file it comes from, which is not opened; empty for a built-in component. Throws PluginError if unknown.
  std::filesystem::path file(const std::string& kind, const std::string& name) const;
  /// Makes one. Throws PluginError as info() does, and for a maker that threw or made nothing.
  template <class Interface>
  std::shared_ptr<Interface> make(const std::string& name) const;
  /// The plugin as messages name it, e.g. `contact plugin "linear-rolling" (/usr/lib/grit/contacts/linear-rolling.so)`.
  std::string title(const std::string& kind, const std::string& name) const;

 private:
  using Key = std::pair<std::string, std::string>;  // kind and name

  std::vector<std::filesystem::path> directories_;
  std::map<Key, const PluginInfo*> builtin_;
  mutable std::map<Key, const PluginInfo*> loaded_;
};

/// The directories of --plugin-path (in order), GRIT_PLUGIN_PATH (colon-separated), then `beside`. Before each of the
/// user's comes its folder named after this build's `arch`, if there is one: a folder of plugins can serve several.
std::vector<std::filesystem::path> plugin_directories(const std::vector<std::string>& option,
                                                      const std::filesystem::path& beside);

}  // namespace grit
