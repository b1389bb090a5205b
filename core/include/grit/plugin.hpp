// A plugin exports one function, grit_plugin(). It returns a PluginInfo, which begins with the build tag.
#pragma once

#include "grit/build_tag.hpp"

namespace grit {

class BodyKind;
class ContactLaw;
class Engine;
class Geometry;
class Probe;
class Scenario;

/// Describes a plugin. Exactly one of the make_ functions is set, that of its kind. Hidden, so that no shared library
/// uses the implicit constructor of another one, which would set the tag of that one.
struct [[gnu::visibility("hidden")]] PluginInfo {
  BuildTag tag = build_tag();  ///< first: it is checked before anything else is read
  const char* kind = "";       ///< "body", "contact", "engine", "geometry", "probe" or "scenario"
  const char* name = "";       ///< kebab-case; the file name without its extension
  const char* version = "";
  const char* doc = "";  ///< one line
  BodyKind* (*make_body)() = nullptr;
  ContactLaw* (*make_contact)() = nullptr;
  Engine* (*make_engine)() = nullptr;
  Geometry* (*make_geometry)() = nullptr;
  Probe* (*make_probe)() = nullptr;
  Scenario* (*make_scenario)() = nullptr;
};

/// Type and name of the exported `extern "C"` function.
using PluginEntry = const PluginInfo* (*)();
inline constexpr const char* plugin_entry_name = "grit_plugin";

}  // namespace grit

/// The exported function; the plugin defines it.
extern "C" __attribute__((visibility("default"))) const grit::PluginInfo* grit_plugin();
