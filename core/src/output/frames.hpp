// frames/000123.h5, one file per instant, and frames.xdmf, which opens them all in ParaView.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "run/recorder.hpp"
#include "storage/hdf5.hpp"

namespace grit {

/// The shape of a wall at its initial position.
struct WallShape {
  std::string name;
  std::vector<Vec3> triangles;  ///< three corners each [m]
  std::string stage = {};       ///< stage with this shape; empty: all stages without a shape of their own
};

/// The triangles of a wall at its present position; none if no shape has its name.
std::vector<Vec3> triangles_of(const WallView& wall, std::span<const WallShape> shapes, const std::string& stage);

/// Writes frames: /bodies sorted by id, /contacts, /walls/<name>, /probes/<name>/<field>; every dataset has `units` and
/// `long_name`, the file `time`, `step`, `stage`. A file appears under its name only when it is whole. All functions
/// throw FileError.
class Frames {
 public:
  /// Keeps the first `kept` existing frames and removes later ones.
  Frames(const std::filesystem::path& results, std::vector<WallShape> walls, std::size_t kept = 0);

  void write(const World& world, std::span<const FieldGroup> fields);
  std::size_t count() const { return instants_.size(); }

 private:
  struct Instant {
    double time;
    std::size_t bodies, contacts;
    bool clump, group, rotation, displacement;
    struct WallField {
      std::string wall, probe, name;
      std::size_t width;
    };
    std::vector<std::pair<std::string, std::size_t>> walls;  ///< names and numbers of triangles
    std::vector<WallField> on_walls;                         ///< fields by triangle
  };
  static Instant instant_of(const hdf5::File& file);

  void write_index() const;

  std::filesystem::path results_;
  std::vector<WallShape> walls_;
  std::vector<Instant> instants_;
};

}  // namespace grit
