// Reads the frames of a run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "grit/vec.hpp"
#include "output/body_values.hpp"
#include "run/recorder.hpp"

namespace grit {

/// One file of frames/. Lists have one entry per body or contact; vectors have three values per entry.
struct Frame {
  double time = 0;  ///< s
  std::uint64_t step = 0;
  std::string stage;

  std::vector<std::int64_t> id;          ///< rising
  std::vector<double> position, radius;  ///< m
  std::vector<double> velocity;          ///< m/s
  std::vector<double> rotation;          ///< rad; empty if not tracked
  std::vector<double> displacement;      ///< m; empty if not tracked
  std::vector<std::int64_t> clump;       ///< id of the clump, -1 for a single sphere; empty without clumps
  std::vector<std::int32_t> group;       ///< index of the body's group; empty if there is only one
  std::vector<std::string> group_names;  ///< ascending
  std::vector<BodyValues> values;        ///< of the bodies, from the fields of probes
  std::size_t bodies() const { return id.size(); }

  std::vector<std::int64_t> body_a;  ///< id of a contact's first body
  std::vector<double> normal_force;  ///< N, > 0 in compression
  std::vector<double> branch;        ///< from the first body's centre to the second's or to the wall [m]
  /// Number, from 1, of the linear force chain of each contact, 0 for none; empty if no probe records it.
  std::vector<std::uint32_t> chain;

  struct Wall {
    std::string name;
    std::vector<double> corners;     ///< of its triangles in their present position: nine values per triangle [m]
    Vec3 displacement;               ///< since the start of the run [m]
    std::vector<Field> fields = {};  ///< of its triangles, named "PROBE/FIELD"
  };
  std::vector<Wall> walls;
};

/// The frame files of a run's folder in the order of their numbers.
std::vector<std::filesystem::path> frame_files(const std::filesystem::path& folder);

/// Throws FileError for an incomplete file.
Frame read_frame(const std::filesystem::path& file);

/// The maps of a frame, one group per probe: its fields "centre" and "size" first, then those with as many rows. Throws
/// FileError.
std::vector<FieldGroup> read_maps(const std::filesystem::path& file);

/// Number of bodies in a frame. Throws FileError.
std::size_t bodies_in_frame(const std::filesystem::path& file);

/// The stage of a frame. Throws FileError.
std::string stage_of_frame(const std::filesystem::path& file);

}  // namespace grit
