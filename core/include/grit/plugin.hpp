// What a plugin exports: one function. It returns a PluginInfo, which begins with the build tag.
#pragma once

#include "grit/build_tag.hpp"

namespace grit {

class BodyKind;
class ContactLaw;
class Engine;
class Geometry;
class Probe;
class Scenario;

/// One plugin: a name in one registry. Exactly one of the makers is set, the one of its kind. Hidden, so that no shared
/// library uses the implicit constructor of another one, which sets that one's tag.
struct [[gnu::visibility("hidden")]] PluginInfo {
  BuildTag tag = build_tag();  ///< first, so that it can be read before anything else is trusted
  const char* kind = "";       ///< "body", "contact", "engine", "geometry", "probe" or "scenario"
  const char* name = "";       ///< kebab-case, the file's name without its ending
  const char* version = "";
  const char* doc = "";  ///< one line
  BodyKind* (*make_body)() = nullptr;
  ContactLaw* (*make_contact)() = nullptr;
  Engine* (*make_engine)() = nullptr;
  Geometry* (*make_geometry)() = nullptr;
  Probe* (*make_probe)() = nullptr;
  Scenario* (*make_scenario)() = nullptr;
};

/// The one symbol that a plugin exports, `extern "C"`.
using PluginEntry = const PluginInfo* (*)();
inline constexpr const char* plugin_entry_name = "grit_plugin";

}  // namespace grit

/// Declares the exported symbol; its definition is the plugin's.
extern "C" __attribute__((visibility("default"))) const grit::PluginInfo* grit_plugin();
