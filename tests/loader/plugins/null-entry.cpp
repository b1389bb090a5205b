#include "fixture.hpp"

const grit::PluginInfo* grit_plugin() { return nullptr; }
