// A tag that ends after its size: whoever reads on reads somebody else's memory.
#include "fixture.hpp"

const grit::PluginInfo* grit_plugin() {
  static const struct {
    char magic[8] = "gritplg";
    std::uint32_t tag_size = sizeof(magic) + sizeof(tag_size);
  } short_tag;
  return reinterpret_cast<const grit::PluginInfo*>(&short_tag);
}
