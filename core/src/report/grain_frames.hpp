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
  std::size_t value_bytes = 32u << 20;     ///< of all numbers of bodies from fields, the same of those of triangles
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
///     values         [[low, high, limit]]: 0 and 65535 of each of values, bound of 98 % of their magnitudes; null
///                    without numbers
///     wall_fields    [limit]: the same bound of the triangles that are not 0
///   values         [{name, label, unit, factor, about, signed}]: numbers of bodies from fields of probes (BodyValues)
///   wall_fields    the same for triangles of walls, with the name of the wall
///   values_left_out  number of both omitted for lack of space
///   walls          [{name, data, low, high}]: float32 corners of triangles, without displacement [m], and the box of
///                  them; a new entry if a stage changes a wall or it rotates
///   frames         [{time, step, stage, low, high, set, base, data, contacts, chains, strongest, mean_force, walls}]:
///     low, high      corners of the box of its centres [m]; absent without bodies, as are those far from all others
///     surface        [low, high]: corners of the box of the same bodies [m]
///     set            index in bodies
///     unplaced       number of omitted bodies, without a finite position; absent if 0
///     data           byte planes of uint16: x of all bodies, y, z, speed, then rotation x, y, z, displacement x, y, z
///     base           positions are relative to those of that frame, modulo 65536; absolute if it is this frame
///     chains         byte planes of uint16: low and high half of the body's index, branch x, y, z (of 2 · reach, about
///                    32768), force (of strongest), each for all contacts; contacts: their number
///     linear_chains  the same for the links of linear force chains, linear_contacts: their number; absent if 0
///     values         byte planes of uint16: each of values for all bodies, 65535 for none; absent if there are none
///     walls          [[index in walls, x, y, z]]: displacement of each wall [m]
///     wall_fields    [[index in the frame's walls, index in wall_fields, data]]: float32, of each triangle
///   layers         {frame, stage}: index of the frame whose heights define the layers, and the stage that begins there
///   maps           CellMaps::result() of the probes' fields
///   reach          m
///   left_out       number of frames omitted
Description grain_frames(std::span<const std::filesystem::path> files, const GrainLimits& limits, DataElements& data,
                         std::vector<std::string>& problems);

}  // namespace grit
