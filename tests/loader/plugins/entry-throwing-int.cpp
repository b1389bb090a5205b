#include "fixture.hpp"

const grit::PluginInfo* grit_plugin() { throw 42; }
