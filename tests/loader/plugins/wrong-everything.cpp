#include "fixture.hpp"

const grit::PluginInfo* grit_plugin() {
  return fixture::wrong_tag([](grit::BuildTag& tag) {
    tag.sdk_version += 7;
    tag.compiler[0] = tag.library_abi[0] = tag.instruction_set[0] = '#';
    for (grit::Layout* layout : {&tag.row, &tag.contact_row, &tag.body_sum, &tag.pair_batch, &tag.wall_batch})
      layout->size += 64;
  });
}
