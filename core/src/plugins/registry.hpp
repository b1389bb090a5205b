// What is there to choose from: built-in components and plugins on the search path, loaded when asked for.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "grit/plugin.hpp"

namespace grit {

template <class Interface>
constexpr const char* kind_name();
template <>
constexpr const char* kind_name<BodyKind>() { return "body"; }
template <>
constexpr const char* kind_name<ContactLaw>() { return "contact"; }
template <>
constexpr const char* kind_name<Engine>() { return "engine"; }
template <>
constexpr const char* kind_name<Geometry>() { return "geometry"; }
template <>
constexpr const char* kind_name<Probe>() { return "probe"; }
template <>
constexpr const char* kind_name<Scenario>() { return "scenario"; }

/// All kinds, and the folder of each below a plugin directory.
struct Kind {
  const char* name;
  const char* folder;
};
inline constexpr Kind kinds[] = {{"body", "bodies"},     {"contact", "contacts"}, {"engine", "engines"},
                                 {"geometry", "geometry"}, {"probe", "probes"},   {"scenario", "scenarios"}};

/// One entry of `grit plugins`.
struct Installed {
  std::string kind, name;
  std::filesystem::path file;  ///< empty for a built-in component
};

/// Not copied: components hold a pointer to it. Safe to use from one thread.
class Registry {
 public:
  /// Directories are searched in this order; each holds one folder a kind with <name>.so in it.
  explicit Registry(std::vector<std::filesystem::path> directories);
  Registry(const Registry&) = delete;
  Registry& operator=(const Registry&) = delete;

  /// Adds a component that needs no file. Its name wins over files.
  void add(const PluginInfo& info);

  /// Everything that may be chosen, by kind and name; files are listed, not opened.
  std::vector<Installed> installed() const;
  /// The names of one kind, sorted.
  std::vector<std::string> names(const std::string& kind) const;
  /// Loads, if need be, and checks the plugin. Throws PluginError: unknown (with the nearest name and the directories
  /// searched), not loadable, built differently (every mismatch), wrong kind or name, no maker, or a maker that threw.
  const PluginInfo& info(const std::string& kind, const std::string& name) const;
  /// The file it came from; empty for a built-in component.
  std::filesystem::path file(const std::string& kind, const std::string& name) const;
  /// Makes one. Throws as info() does.
  template <class Interface>
  std::shared_ptr<Interface> make(const std::string& name) const;

 private:
  std::vector<std::filesystem::path> directories_;
  std::map<std::pair<std::string, std::string>, const PluginInfo*> builtin_;
  mutable std::map<std::pair<std::string, std::string>, const PluginInfo*> loaded_;
};

/// The directories of --plugin-path (in order), GRIT_PLUGIN_PATH (colon-separated), then `beside`.
std::vector<std::filesystem::path> plugin_directories(const std::vector<std::string>& option,
                                                      const std::filesystem::path& beside);

}  // namespace grit
