// frames/000123.h5, one file per instant, frames.xdmf, which opens them all in ParaView, and files in other formats.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "output/wall_shape.hpp"
#include "run/recorder.hpp"
#include "storage/hdf5.hpp"

namespace grit {

struct FrameExport;

/// Writes frames: /bodies sorted by id, /contacts, /walls/<name>, /probes/<name>/<field>; every dataset has `units` and
/// `long_name`, the file `time`, `step`, `stage`. Beside each frame are the files of frame_exports() in these formats.
/// A file appears under its name only when it is whole. The indices are rewritten with a frame only while that is
/// cheap, so that many frames do not cost more each: they may lack the last tenth of the frames until update_indices().
/// All functions throw FileError.
class Frames {
 public:
  /// Keeps the first `kept` frames and removes later ones, in all formats. Frames that were removed are left out of the
  /// index; a damaged one is an error, and so is a later one that no run wrote, before anything is changed. `formats`:
  /// those of FrameExport, in which frames are written.
  Frames(const std::filesystem::path& results, std::vector<WallShape> walls, std::size_t kept = 0,
         std::span<const std::string> formats = {});

  /// Throws RefusedRecord if the next frame would replace a file.
  void expect_room() const;
  void write(const World& world, std::span<const FieldGroup> fields);
  std::size_t count() const { return instants_.size(); }
  /// Adds frames to the indices that they lack.
  void update_indices();
  /// Returns when all frames are on disk.
  void sync();

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
  static std::optional<Instant> kept_instant(const std::filesystem::path& path);

  std::vector<std::filesystem::path> later() const;
  void write_indices();
  void write_collection(const FrameExport& one) const;
  void write_xdmf() const;

  std::filesystem::path results_;
  std::vector<WallShape> walls_;
  std::vector<const FrameExport*> exports_;
  std::vector<std::optional<Instant>> instants_;  ///< none of a frame that was removed before the run was resumed
  std::size_t synced_;                            ///< number of frames on disk
  std::size_t indexed_ = 0;                       ///< number of frames in the indices
  std::chrono::steady_clock::time_point indexed_at_;
  std::chrono::steady_clock::duration indexing_{};  ///< time that writing them took
};

}  // namespace grit
