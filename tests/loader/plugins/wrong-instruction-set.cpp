#include "fixture.hpp"

const grit::PluginInfo* grit_plugin() {
  return fixture::wrong_tag([](grit::BuildTag& tag) { tag.instruction_set[0] = 'X'; });
}
