// The state that a frame holds.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "grit/geometry.hpp"
#include "grit/vec.hpp"
#include "storage/hdf5.hpp"

namespace grit {

/// The name of a file of a frame: 000123.h5, with other suffixes for other formats.
std::string frame_name(std::size_t number, const char* suffix = ".h5");
/// Its number, if a file name is frame_name() with this suffix.
std::optional<std::size_t> frame_number(const std::string& file_name, const char* suffix = ".h5");

/// Attributes NAME_x, NAME_y and NAME_z.
void set_vector(hdf5::Object& object, const std::string& name, const Vec3& vector);
Vec3 vector_of(const hdf5::Object& object, const std::string& name);

/// The pose and motion of a wall, as attributes of its triangles: reference, displacement, orientation, velocity, spin.
struct FrameWall {
  std::string name;
  Pose pose;
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();  ///< m/s, rad/s
};
void set_wall(hdf5::Object& object, const FrameWall& wall);

struct FrameBody {
  std::uint32_t id;
  std::size_t group;   ///< index of FrameState::groups
  std::int64_t clump;  ///< id; -1 for a single body
  Vec3 position, velocity, spin;
  double radius;
};

struct FrameClump {
  std::int64_t id;
  Vec3 centre, velocity, spin;
  Eigen::Quaterniond orientation;
  double radius;
};

struct FrameState {
  std::string stage;
  Vec3 cell_low, cell_high, strain_rate;  ///< infinite bounds along open sides
  Vec3 shear_rate, tilt;                  ///< see Cell
  std::vector<std::string> groups;        ///< ascending
  std::vector<FrameBody> bodies;          ///< ascending ids
  std::vector<FrameClump> clumps;         ///< ascending ids
  std::vector<FrameWall> walls;
};

/// Throws FileError, also for a frame of an earlier version, which lacks poses of walls and the cell.
FrameState read_frame_state(const std::filesystem::path& file);

/// Time of a frame [s]. Throws FileError.
double time_of_frame(const std::filesystem::path& file);

}  // namespace grit
