#include <stdexcept>

#include "fixture.hpp"

const grit::PluginInfo* grit_plugin() { throw std::runtime_error("no luck today"); }
