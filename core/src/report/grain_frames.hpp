// The frames of a run as a page carries them: 16-bit numbers, few enough for a browser.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "grit/description.hpp"
#include "report/packed.hpp"

namespace grit {

/// Bounds on what a page carries, so that it opens in seconds.
struct GrainLimits {
  std::size_t bytes = 96u << 20;           ///< of all frames before deflating; frames are left out evenly beyond it
  std::size_t contacts = 20'000;           ///< a frame: the strongest above the mean normal force
  std::size_t wall_corners = 3 * 100'000;  ///< a wall; one that has more is not shown
  std::size_t wall_bytes = 8u << 20;       ///< of all walls before deflating; beyond it they turn no further
  std::size_t map_bytes = 32u << 20;       ///< of all maps of cells before deflating
};

/// Adds the frames to `data`, and says how they are to be taken apart; null where no frame can be read.
///
///   low, high      corners of the box of all centres [m]: what 0 and 65535 of a position mean
///   mean_diameter  m
///   bodies         [{count, data}]: of each set of bodies, float32 radius [m], int32 id, and, where there are clumps,
///                  int32 clump
///   clumps         whether there are any
///   stages         by name {ranges, limits}, of the frames of the stage, and only what all frames of all stages have:
///     ranges         {speed, rotation, displacement}: what 65535 means, from 0 for speed, from −range for the vectors
///     limits         {speed: one, rotation: [x, y, z], displacement: [x, y, z]}: what 98 of 100 bodies stay below
///   walls          [{name, data}]: float32 corners of triangles, not displaced [m]; anew where a stage changes a wall
///                  or it turns
///   frames         [{time, step, stage, low, high, set, base, data, contacts, chains, strongest, mean_force, walls}]:
///     low, high      corners of the box of its centres [m]; not without bodies
///     set            place in bodies
///     unplaced       bodies without a finite position, which are left out; not without any
///     data           byte planes of uint16: x of all bodies, y, z, speed, then rotation x, y, z, displacement x, y, z
///     base           positions are less those of that frame, modulo 65536; itself: they are as they are
///     chains         byte planes of uint16: low and high half of the body's place, branch x, y, z (of 2 · reach, about
///                    32768), force (of strongest), all contacts after one another; contacts: how many
///     linear_chains  the same of the links of linear force chains, linear_contacts: how many; not without any
///     walls          [[place in walls, x, y, z]]: displacement of each wall [m]
///   layers         {frame, stage}: the place of the frame by whose heights layers are told, and the stage that begins
///                  there
///   maps           what CellMaps makes of the probes' fields
///   reach          m
///   left_out       frames that were not taken
Description grain_frames(std::span<const std::filesystem::path> files, const GrainLimits& limits, DataElements& data,
                         std::vector<std::string>& problems);

}  // namespace grit
