// Reads back the instants that a run has left in its folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "grit/vec.hpp"
#include "run/recorder.hpp"

namespace grit {

/// One file of frames/. Lists have one entry a body or a contact, those of vectors three numbers.
struct Frame {
  double time = 0;  ///< s
  std::uint64_t step = 0;
  std::string stage;

  std::vector<std::int64_t> id;          ///< rising
  std::vector<double> position, radius;  ///< m
  std::vector<double> velocity;          ///< m/s
  std::vector<double> rotation;          ///< rad; empty where it is not kept
  std::vector<double> displacement;      ///< m; empty where it is not kept
  std::vector<std::int64_t> clump;       ///< id of the clump, -1 for a sphere by itself; empty without clumps
  std::size_t bodies() const { return id.size(); }

  std::vector<std::int64_t> body_a;  ///< id of a contact's first body
  std::vector<double> normal_force;  ///< N, > 0 in compression
  std::vector<double> branch;        ///< from the first body's centre to the second's or to the wall [m]
  /// The linear force chain, from 1, that each contact is a link of, 0 for none; empty where no probe tells.
  std::vector<std::uint32_t> chain;

  struct Wall {
    std::string name;
    std::vector<double> corners;  ///< of its triangles where it has moved and turned to: nine numbers a triangle [m]
    Vec3 displacement;            ///< since the start of the run [m]
  };
  std::vector<Wall> walls;
};

/// The files of a run's folder in the order of their numbers; none if there is no frame.
std::vector<std::filesystem::path> frame_files(const std::filesystem::path& folder);

/// Throws FileError for what is not whole.
Frame read_frame(const std::filesystem::path& file);

/// Tables of a frame that are maps, a group a probe: its fields "centre" and "size" first, then those of as many rows.
/// Throws FileError.
std::vector<FieldGroup> read_maps(const std::filesystem::path& file);

/// How many bodies a frame has. Throws FileError.
std::size_t bodies_in_frame(const std::filesystem::path& file);

/// The stage that a frame is of. Throws FileError.
std::string stage_of_frame(const std::filesystem::path& file);

}  // namespace grit
