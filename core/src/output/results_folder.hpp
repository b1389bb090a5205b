// The results folder of a run: run.json, series.h5, frames, description, packing, picture.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "grit/checkpoint.hpp"
#include "output/body_values.hpp"
#include "output/colours.hpp"
#include "output/folder_lock.hpp"
#include "output/frames.hpp"
#include "output/run_json.hpp"
#include "output/series.hpp"
#include "output/series_journal.hpp"
#include "output/single_channels.hpp"
#include "run/recorder.hpp"
#include "storage/atomic_file.hpp"
#include "storage/state_file.hpp"

namespace grit {

/// The picture drawn at the end: channels, or the time of samples, as "probe/channel", one curve per panel. See
/// grain_view() for view and color.
struct PictureRequest {
  std::string x;
  std::vector<std::string> y;
  std::string view = "xz", color = "rotation";
  ScaleEnds scale = {};  ///< of the colour
};

/// What to do if the folder holds a run.
enum class Existing {
  refuse,
  overwrite,  ///< remove its results; other files in it stay, and are refused under the names of results
  resume,     ///< keep the results up to the checkpoint from which the run is resumed
};

struct ResultsOptions {
  std::filesystem::path folder;
  Existing existing = Existing::refuse;
  std::string title;
  RunFacts facts;
  std::vector<WallShape> walls;
  std::vector<std::string> formats = {};  ///< of frames, beside HDF5
  std::optional<PictureRequest> picture;
  bool from_previous = false;  ///< resumes from the checkpoint before the last one
  Flushing flushing = {};
};

/// Throws FileError: another run is writing to the folder.
[[noreturn]] void refuse_busy(const std::filesystem::path& folder);

/// Removes from the folder of a run that is done what it needed to be resumed. Throws FileError.
void remove_checkpoints(const std::filesystem::path& folder);

/// Writes in begin() run.json and description.json; during the run series.h5, frames/, frames.xdmf, grains.pvd and
/// walls.pvd for VTK, run.json, series.journal, checkpoint.h5 and the one before it, checkpoint-previous.h5; at the end
/// packing.txt (`x y z radius` in m, by id, in full precision; not for a failed run), picture.svg, and run.json last,
/// so that its status implies that the rest is complete. When the run is done, final.h5 has its last state and the
/// checkpoints are removed, only then, as a run that is killed at its end resumes from them. All functions throw
/// FileError for write errors.
class ResultsFolder final : public Recorder {
 public:
  /// Creates the folder; what it holds stays as it is. Throws FileError if that fails, if another run is writing to it,
  /// if it holds a run and `existing` is refuse, or if a file that no run wrote would be lost.
  explicit ResultsFolder(ResultsOptions options);
  /// Unless begin() succeeded, removes the files and folders that were created, so that a run that does not reach its
  /// first step leaves nothing behind.
  ~ResultsFolder() override;

  const FolderLock& lock() const { return lock_; }

  /// The results of another run are removed only here, when all that can be refused has been. Throws Error for a
  /// channel of the picture that no probe has, or that is not a single value.
  void begin(const World& world, std::span<const ProbeGroup> probes) override;
  void expect_room() const override;
  void sample(std::size_t probe, const World& world, std::span<const std::span<const double>> values) override;
  void frame(const World& world, std::span<const FieldGroup> fields) override;
  void stage_ended(const World& world, const std::string& what) override;
  void flush() override;
  void serialize(Archive& archive) override;
  void finish(const World& world, const RunSummary& summary) override;

  /// Writes checkpoint.h5, once the samples and frames up to it are on disk.
  void checkpoint(const StateToSave& state);
  /// Writes final.h5, before finish().
  void final_state(const StateToSave& state);

 private:
  /// A channel of the picture, kept in memory.
  struct Kept {
    SingleChannel channel;
    std::vector<double> steps = {}, values = {};
  };

  /// The amount of results at a checkpoint.
  struct Extent {
    std::vector<std::uint64_t> samples;  ///< of each probe
    std::uint64_t frames = 0;
    std::vector<std::vector<double>> steps, values;  ///< of the picture's channels
    SeriesJournal::Extent journal;
    void serialize(Archive& archive) { archive(samples, frames, steps, values, journal); }
  };

  void draw_picture(const World& world, const RunSummary& summary) const;

  void note(const char* last_file);
  /// Whether a file that is written at the end has appeared or changed since it was noted.
  bool has_other(const char* file) const;
  /// Throws RefusedRecord if so.
  void expect_no_other(const char* file) const;
  /// Makes the folder that of this run: what another one left is removed.
  void take_over();
  void write_description() const;
  void restore(std::span<const ProbeGroup> probes);
  /// Returns when these files of the folder are on disk, as far as they exist.
  void sync(std::initializer_list<const char*> files) const;
  void discard() noexcept;

  ResultsOptions options_;
  std::vector<std::filesystem::path> made_;  ///< folders, the innermost first
  FolderLock lock_;
  RunJson run_json_;
  std::optional<Series> series_;
  std::optional<SeriesJournal> journal_;
  std::optional<Frames> frames_;
  std::vector<Kept> kept_;  ///< x first, then the y of the picture
  /// Of the bodies at the last frame, if the picture is coloured by a field; and the step of that frame.
  BodyValues color_values_;
  std::uint64_t color_step_ = 0;
  Extent resumed_;
  std::map<std::string, std::optional<FileStamp>> last_files_;  ///< of those written at the end
  bool announced_ = false;                                      ///< run.json is of this run
  bool begun_ = false;
};

}  // namespace grit
