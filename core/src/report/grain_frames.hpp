// The frames of a run in the form of the page: 16-bit numbers, limited for a browser.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "grit/description.hpp"
#include "report/packed.hpp"

namespace grit {

/// Limits of the content of a page, so that it opens in seconds.
struct GrainLimits {
  std::size_t bytes = 96u << 20;           ///< of all frames before deflating; above it, frames are omitted evenly
  std::size_t contacts = 20'000;           ///< per frame: the strongest above the mean normal force
  std::size_t wall_corners = 3 * 100'000;  ///< per wall; one with more is not shown
  std::size_t wall_bytes = 8u << 20;       ///< of all walls before deflating; above it, rotations are not shown
  std::size_t map_bytes = 32u << 20;       ///< of all maps of cells before deflating
};

/// Adds the frames to `data` and returns how to decode them; null if no frame is readable.
///
///   low, high      corners of the box of all centres [m], i.e. 0 and 65535 of a position
///   mean_diameter  m
///   bodies         [{count, data}]: for each set of bodies, float32 radius [m], int32 id, and with clumps int32 clump
///   clumps         whether there are any
///   stages         by name {ranges, limits}, for the frames of the stage, only quantities in all frames of all stages:
///     ranges         {speed, rotation, displacement}: value of 65535; 0 is 0 for speed, −range for vectors
///     limits         {speed: one, rotation: [x, y, z], displacement: [x, y, z]}: bound of 98 % of the bodies
///   walls          [{name, data}]: float32 corners of triangles, without displacement [m]; a new entry if a stage
///   changes
///                  a wall or it rotates
///   frames         [{time, step, stage, low, high, set, base, data, contacts, chains, strongest, mean_force, walls}]:
///     low, high      corners of the box of its centres [m]; absent without bodies
///     set            index in bodies
///     unplaced       number of omitted bodies, without a finite position; absent if 0
///     data           byte planes of uint16: x of all bodies, y, z, speed, then rotation x, y, z, displacement x, y, z
///     base           positions are relative to those of that frame, modulo 65536; absolute if it is this frame
///     chains         byte planes of uint16: low and high half of the body's index, branch x, y, z (of 2 · reach, about
///                    32768), force (of strongest), each for all contacts; contacts: their number
///     linear_chains  the same for the links of linear force chains, linear_contacts: their number; absent if 0
///     walls          [[index in walls, x, y, z]]: displacement of each wall [m]
///   layers         {frame, stage}: index of the frame whose heights define the layers, and the stage that begins there
///   maps           CellMaps::result() of the probes' fields
///   reach          m
///   left_out       number of frames omitted
Description grain_frames(std::span<const std::filesystem::path> files, const GrainLimits& limits, DataElements& data,
                         std::vector<std::string>& problems);

}  // namespace grit
