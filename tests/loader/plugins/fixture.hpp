// What the bad plugins of these tests have in common: each is right but for one thing.
#pragma once

#include "grit/plugin.hpp"

namespace fixture {

/// A body plugin with everything right but what `spoil` does to it.
template <class Spoil>
const grit::PluginInfo* plugin(const char* name, Spoil spoil) {
  static grit::PluginInfo info;
  info.kind = "body", info.name = name, info.version = "1.0.0", info.doc = "of the loader's tests";
  info.make_body = []() -> grit::BodyKind* { return nullptr; };
  spoil(info);
  return &info;
}

/// What a plugin with other layouts looks like from here: nothing behind the tag can be used.
inline void ruin(grit::PluginInfo& info) {
  info.kind = info.name = info.version = info.doc = reinterpret_cast<const char*>(1);
}

/// A body plugin whose build tag, and nothing else, can be read.
template <class Spoil>
const grit::PluginInfo* wrong_tag(Spoil spoil) {
  return plugin("", [&](grit::PluginInfo& info) { ruin(info), spoil(info.tag); });
}

}  // namespace fixture
