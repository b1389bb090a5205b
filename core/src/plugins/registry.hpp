// Available components: built-in ones and plugins on the search path, loaded on demand.
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

/// Not copyable: components hold a pointer to it. For use from one thread. Created components outlive it.
class Registry {
 public:
  /// Directories are searched in this order; each contains one folder per kind with files <name>.so. `option`: what
  /// names a further one, in messages.
  explicit Registry(std::vector<std::filesystem::path> directories, std::string option = "--plugin-path");
  Registry(const Registry&) = delete;
  Registry& operator=(const Registry&) = delete;

  /// Adds a built-in component. `info` must outlive the registry.
  void add(const PluginInfo& info);

  /// All available components, by kind and name; files are listed, not opened.
  std::vector<Installed> installed() const;
  /// The names of one kind, sorted; files are listed, not opened. Throws PluginError for an unknown kind.
  std::vector<std::string> names(const std::string& kind) const;
  /// Loads the plugin, if necessary, and checks it. Throws PluginError if it is unknown (with the nearest name and the
  /// directories searched), is a second one of this kind and name (with both files), cannot be loaded, was built
  /// differently (with all mismatches), has a wrong kind or name, or has no make_ function.
  const PluginInfo& info(const std::string& kind, const std::string& name) const;
  /// The file of a component, which is not opened; empty for a built-in one. The first, if there is another one.
  /// Throws PluginError if unknown.
  std::filesystem::path file(const std::string& kind, const std::string& name) const;
  /// Creates a component. Throws PluginError as info() does, and if its make_ function throws or returns null. An
  /// exception out of the functions of one that is not built in becomes a PluginError: see plugins/guarded.hpp.
  template <class Interface>
  std::shared_ptr<Interface> make(const std::string& name) const;
  /// The name of a plugin in messages, e.g. `contact plugin "linear-rolling"
  /// (/usr/lib/grit/contacts/linear-rolling.so)`.
  std::string title(const std::string& kind, const std::string& name) const;
  /// Where plugins are searched, and how to add a directory, for messages: of one kind, or of all if it is empty.
  std::string search_text(const std::string& kind = "") const;

 private:
  using Key = std::pair<std::string, std::string>;  // kind and name

  void refuse_second(const Key& key, bool is_built_in) const;

  std::vector<std::filesystem::path> directories_;
  std::string option_;
  std::map<Key, const PluginInfo*> builtin_;
  mutable std::map<Key, const PluginInfo*> known_;  // checked and, unless built in, loaded
};

/// The directories of --plugin-path (in order), of GRIT_PLUGIN_PATH (colon-separated), and `beside`. Before each user
/// directory comes its subfolder with the name of this build's `arch`, if it exists, so that one directory can serve
/// several builds.
std::vector<std::filesystem::path> plugin_directories(const std::vector<std::string>& option,
                                                      const std::filesystem::path& beside);

/// Why a directory that a user names cannot have plugins: a relative clause, empty if it can.
std::string fault_of_plugin_directory(const std::filesystem::path& directory);

}  // namespace grit
