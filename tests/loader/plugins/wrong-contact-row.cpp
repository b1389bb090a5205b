#include "fixture.hpp"

const grit::PluginInfo* grit_plugin() {
  return fixture::wrong_tag([](grit::BuildTag& tag) { tag.contact_row.alignment *= 2; });
}
