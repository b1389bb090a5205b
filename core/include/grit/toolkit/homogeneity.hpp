// How even a specimen is before its test.
#pragma once

#include <string>

#include "grit/description.hpp"

namespace grit {

/// Adds probes that look as the stage `settle` begins and as it ends: `prepared-cells`, the void ratio of averaging
/// cells, as deep as the specimen along `depth_axis`, or cubes where that is empty, and `prepared-chains`, fabric,
/// forces by direction and linear chains. How much cells differ and the anisotropy are told at the end of a run. Needs
/// the stages and the output.
inline void look_how_even_it_is(Description& description, const std::string& depth_axis) {
  for (const Description& stage : description.at("stages")) {
    if (stage.at("name") != "settle") continue;
    const Description twice = {{"stages", {"settle"}}, {"every_time", stage.at("limit")}, {"frames", false}};
    Description cells = twice, chains = twice;
    cells["type"] = "void-ratio", cells["depth_axis"] = depth_axis;
    chains["type"] = "force-chains";
    description["probes"]["prepared-cells"] = cells;
    description["probes"]["prepared-chains"] = chains;
    for (const char* channel : {"prepared-cells/standard_deviation", "prepared-chains/anisotropy"})
      description["output"]["summary"].push_back(channel);
  }
}

}  // namespace grit
