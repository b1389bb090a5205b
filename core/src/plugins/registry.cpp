#include "plugins/registry.hpp"

#include <algorithm>
#include <cassert>
#include <optional>
#include <set>

#include "format/names.hpp"
#include "grit/body_kind.hpp"
#include "grit/contact/contact_law.hpp"
#include "grit/engine.hpp"
#include "grit/error.hpp"
#include "grit/geometry.hpp"
#include "grit/probe.hpp"
#include "grit/scenario.hpp"
#include "grit/toolkit/did_you_mean.hpp"
#include "plugins/boundary.hpp"
#include "plugins/build_facts.hpp"
#include "plugins/guarded.hpp"
#include "plugins/loader.hpp"

namespace grit {
namespace {

namespace fs = std::filesystem;

const Kind& kind_named(const std::string& name) {
  const auto kind = std::ranges::find(kinds, name, &Kind::name);
  if (kind != std::end(kinds)) return *kind;
  std::vector<std::string> all;
  for (const auto& one : kinds) all.push_back(one.name);
  throw PluginError("unknown kind of plugin " + in_quotes(name) +
                    did_you_mean(name, all, "allowed are " + listed(all, "")));
}

/// Whether `name` is a plain file name, without a path.
bool is_plain(const std::string& name) {
  return !name.empty() && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
}

void refuse_path(const Kind& kind, const std::string& name, const std::string& option) {
  if (!is_plain(name))
    throw PluginError(in_quotes(name) + " is not the name of a " + kind.name +
                      " plugin: allowed are letters, digits and hyphens, not a path; give "
                      "the plugin's directory by " +
                      option + " or GRIT_PLUGIN_PATH");
}

/// The files of a plugin. A file that is found twice counts once, and one in the subfolder of a directory for this
/// instruction set replaces that of the directory.
std::vector<fs::path> find_files(const std::vector<fs::path>& directories, const Kind& kind, const std::string& name) {
  std::vector<fs::path> files;
  std::error_code none;
  const fs::path* last = nullptr;  // directory of the last file
  for (const auto& directory : directories) {
    const auto file = directory / kind.folder / (name + ".so");
    if (!fs::is_regular_file(file, none) || (last != nullptr && *last == directory / build_facts().arch)) continue;
    const auto is_same = [&](const fs::path& other) { return fs::equivalent(file, other, none); };
    if (std::ranges::any_of(files, is_same)) continue;
    files.push_back(file);
    last = &directory;
  }
  return files;
}

}  // namespace

Registry::Registry(std::vector<fs::path> directories, std::string option)
    : directories_(std::move(directories)), option_(std::move(option)) {}

void Registry::add(const PluginInfo& info) {
  assert(kind_named(info.kind).has_maker(info));
  builtin_.insert_or_assign({info.kind, info.name}, &info);
}

std::vector<Installed> Registry::installed() const {
  std::vector<Installed> all;
  for (const auto& kind : kinds)
    for (auto& name : names(kind.name)) {
      auto from = file(kind.name, name);
      all.push_back({kind.name, std::move(name), std::move(from)});
    }
  return all;
}

std::vector<std::string> Registry::names(const std::string& kind) const {
  const Kind& wanted = kind_named(kind);
  std::set<std::string> found;
  for (const auto& [key, info] : builtin_)
    if (key.first == kind) found.insert(key.second);
  std::error_code error, none;
  for (const auto& directory : directories_)
    for (fs::directory_iterator entry(directory / wanted.folder, error), end; !error && entry != end;
         entry.increment(error)) {
      const auto name = entry->path().stem().string();
      if (entry->path().extension() == ".so" && is_plain(name) && entry->is_regular_file(none)) found.insert(name);
    }
  return {found.begin(), found.end()};
}

const PluginInfo& Registry::info(const std::string& kind, const std::string& name) const {
  const Key key{kind, name};
  auto known = known_.find(key);
  if (known == known_.end()) {
    const auto built_in = builtin_.find(key);
    refuse_second(key, built_in != builtin_.end());
    const PluginInfo& info =
        built_in != builtin_.end() ? *built_in->second : load_plugin(file(kind, name), kind_named(kind), name);
    known = known_.emplace(key, &info).first;
  }
  return *known->second;
}

void Registry::refuse_second(const Key& key, bool is_built_in) const {
  const auto& [kind, name] = key;
  const auto files = find_files(directories_, kind_named(kind), name);
  if (files.size() + (is_built_in ? 1 : 0) < 2) return;
  const std::string first = is_built_in ? "built into " + library_file().string() : files[0].string();
  throw PluginError(kind + " plugin " + in_quotes(name) + " exists twice: " + first + ", and " +
                    files[is_built_in ? 0 : 1].string() +
                    "\n  remove one from the folders that are searched, or rename the file and PluginInfo::name");
}

fs::path Registry::file(const std::string& kind, const std::string& name) const {
  if (builtin_.contains({kind, name})) return {};
  const Kind& wanted = kind_named(kind);
  refuse_path(wanted, name, option_);
  if (auto found = find_files(directories_, wanted, name); !found.empty()) return std::move(found.front());

  const auto all = names(kind);
  throw PluginError("unknown " + kind + " plugin " + in_quotes(name) + did_you_mean(name, all) +
                    "\n  available: " + listed(all) + "\n  " + search_text(kind));
}

std::string Registry::search_text(const std::string& kind) const {
  const std::string folder_of_kind = kind.empty() ? "" : kind_named(kind).folder;
  std::vector<std::string> searched;
  std::error_code none;
  for (const auto& directory : directories_) {
    const auto folder = (kind.empty() ? directory : directory / folder_of_kind).lexically_normal();
    searched.push_back(folder.string() + (fs::is_directory(folder, none) ? "" : " (no such directory)"));
  }
  return "searched: " + listed(searched, "no directory") + "; " + option_ +
         (option_.starts_with("--") ? " DIR" : "=DIR") + " or GRIT_PLUGIN_PATH=DIR adds " +
         (kind.empty() ? "DIR" : "DIR/" + folder_of_kind);
}

std::string Registry::title(const std::string& kind, const std::string& name) const {
  const auto from = file(kind, name).string();
  return kind + " plugin " + in_quotes(name) + " (" + (from.empty() ? "built in" : from) + ")";
}

template <class Interface>
std::shared_ptr<Interface> Registry::make(const std::string& name) const {
  constexpr auto kind = kind_name<Interface>();
  const PluginInfo& plugin = info(kind, name);
  const std::string function = std::string("make_") + kind;
  std::string who = title(kind, name);
  std::shared_ptr<Interface> made(at_boundary(who, function + "()", plugin.*maker<Interface>));
  if (!made)
    throw PluginError(who + ": " + function + "() returned null\n  let " + function +
                      " return a new object, or throw with the reason");
  return builtin_.contains({kind, name}) ? made : guarded(std::move(made), std::move(who));
}

template std::shared_ptr<BodyKind> Registry::make(const std::string&) const;
template std::shared_ptr<ContactLaw> Registry::make(const std::string&) const;
template std::shared_ptr<Engine> Registry::make(const std::string&) const;
template std::shared_ptr<Geometry> Registry::make(const std::string&) const;
template std::shared_ptr<Probe> Registry::make(const std::string&) const;
template std::shared_ptr<Scenario> Registry::make(const std::string&) const;

}  // namespace grit
