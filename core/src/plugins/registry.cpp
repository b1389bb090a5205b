#include "plugins/registry.hpp"

#include <algorithm>
#include <cassert>
#include <optional>
#include <set>

#include "grit/body_kind.hpp"
#include "grit/contact/contact_law.hpp"
#include "grit/engine.hpp"
#include "grit/error.hpp"
#include "grit/geometry.hpp"
#include "grit/probe.hpp"
#include "grit/scenario.hpp"
#include "plugins/boundary.hpp"
#include "plugins/loader.hpp"
#include "plugins/nearest.hpp"

namespace grit {
namespace {

namespace fs = std::filesystem;

std::string quoted(const std::string& text) { return '"' + text + '"'; }

/// "a, b, c", or `otherwise` if there are none.
std::string listed(const std::vector<std::string>& all, const std::string& otherwise) {
  std::string text;
  for (const auto& one : all) text += (text.empty() ? "" : ", ") + one;
  return all.empty() ? otherwise : text;
}

const Kind& kind_named(const std::string& name) {
  const auto kind = std::ranges::find(kinds, name, &Kind::name);
  if (kind != std::end(kinds)) return *kind;
  std::vector<std::string> all;
  for (const auto& one : kinds) all.push_back(one.name);
  const auto meant = nearest(name, all);
  throw PluginError("unknown kind of plugin " + quoted(name) + (meant ? ", perhaps " + quoted(*meant) : "") +
                    "; allowed are " + listed(all, ""));
}

/// Whether `name` is a plain file name, without a path.
bool is_plain(const std::string& name) {
  return !name.empty() && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
}

void refuse_path(const Kind& kind, const std::string& name) {
  if (!is_plain(name))
    throw PluginError(quoted(name) + " is not the name of a " + kind.name +
                      " plugin: allowed are letters, digits and hyphens, not a path; give "
                      "the plugin's directory by --plugin-path or GRIT_PLUGIN_PATH");
}

std::optional<fs::path> find_file(const std::vector<fs::path>& directories, const Kind& kind, const std::string& name) {
  std::error_code none;
  for (const auto& directory : directories)
    if (auto file = directory / kind.folder / (name + ".so"); fs::is_regular_file(file, none)) return file;
  return std::nullopt;
}

}  // namespace

Registry::Registry(std::vector<fs::path> directories) : directories_(std::move(directories)) {}

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
  if (const auto built_in = builtin_.find(key); built_in != builtin_.end()) return *built_in->second;
  auto loaded = loaded_.find(key);
  if (loaded == loaded_.end())
    loaded = loaded_.emplace(key, &load_plugin(file(kind, name), kind_named(kind), name)).first;
  return *loaded->second;
}

fs::path Registry::file(const std::string& kind, const std::string& name) const {
  if (builtin_.contains({kind, name})) return {};
  const Kind& wanted = kind_named(kind);
  refuse_path(wanted, name);
  if (auto found = find_file(directories_, wanted, name)) return *std::move(found);

  const auto all = names(kind);
  const auto meant = nearest(name, all);
  std::vector<std::string> searched;
  std::error_code none;
  for (const auto& directory : directories_) {
    const auto folder = directory / wanted.folder;
    searched.push_back(folder.string() + (fs::is_directory(folder, none) ? "" : " (no such directory)"));
  }
  throw PluginError("unknown " + kind + " plugin " + quoted(name) + (meant ? ", perhaps " + quoted(*meant) : "") +
                    "\n  available: " + listed(all, "none") + "\n  searched: " + listed(searched, "no directory") +
                    "\n  copy " + name + ".so there, or give the parent directory of its folder " + wanted.folder +
                    "/ by --plugin-path or GRIT_PLUGIN_PATH");
}

std::string Registry::title(const std::string& kind, const std::string& name) const {
  const auto from = file(kind, name).string();
  return kind + " plugin " + quoted(name) + " (" + (from.empty() ? "built in" : from) + ")";
}

template <class Interface>
std::shared_ptr<Interface> Registry::make(const std::string& name) const {
  constexpr auto kind = kind_name<Interface>();
  const PluginInfo& plugin = info(kind, name);
  const std::string function = std::string("make_") + kind;
  std::shared_ptr<Interface> made(at_boundary(title(kind, name), function + "()", plugin.*maker<Interface>));
  if (!made)
    throw PluginError(title(kind, name) + ": " + function + "() returned null\n  let " + function +
                      " return a new object, or throw with the reason");
  return made;
}

template std::shared_ptr<BodyKind> Registry::make(const std::string&) const;
template std::shared_ptr<ContactLaw> Registry::make(const std::string&) const;
template std::shared_ptr<Engine> Registry::make(const std::string&) const;
template std::shared_ptr<Geometry> Registry::make(const std::string&) const;
template std::shared_ptr<Probe> Registry::make(const std::string&) const;
template std::shared_ptr<Scenario> Registry::make(const std::string&) const;

}  // namespace grit
