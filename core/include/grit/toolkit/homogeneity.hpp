// Probes of the homogeneity of a prepared specimen.
#pragma once

#include <string>

#include "grit/description.hpp"

namespace grit {

/// Adds two probes that are sampled at the start and end of the stage `settle`: `prepared-cells`, void ratios of
/// averaging cells that extend through the specimen along `depth_axis` (cubes if that is empty), and `prepared-chains`:
/// fabric, forces by direction and linear force chains. The scatter of the cells and the anisotropy are added to the
/// summary of a run. The description must already contain its stages and output.
inline void add_homogeneity_probes(Description& description, const std::string& depth_axis) {
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
