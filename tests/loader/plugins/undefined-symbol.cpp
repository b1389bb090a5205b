#include "fixture.hpp"

void nowhere_to_be_found(grit::PluginInfo& info);

const grit::PluginInfo* grit_plugin() { return fixture::plugin("undefined-symbol", nowhere_to_be_found); }
