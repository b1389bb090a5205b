// The folder that a run leaves behind: run.json, series.h5, frames, description, grains, picture.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "output/folder_lock.hpp"
#include "output/frames.hpp"
#include "output/run_json.hpp"
#include "output/series.hpp"
#include "output/single_channels.hpp"
#include "run/recorder.hpp"

namespace grit {

/// A picture drawn at the end: channels, or the time of the samples, as "probe/channel", one curve a panel; see
/// grain_view() for view and color.
struct PictureRequest {
  std::string x;
  std::vector<std::string> y;
  std::string view = "xz", color = "rotation";
};

/// What to do with a folder that holds a run.
enum class Existing {
  refuse,
  overwrite,  ///< its results are removed; other files in it stay
  resume,     ///< what it says up to the checkpoint from which the run goes on is kept
};

struct ResultsOptions {
  std::filesystem::path folder;
  Existing existing = Existing::refuse;
  std::string title;
  RunFacts facts;
  std::vector<WallShape> walls;
  std::optional<PictureRequest> picture;
  Flushing flushing = {};
};

/// Throws FileError that says so of a folder that another run keeps.
[[noreturn]] void refuse_busy(const std::filesystem::path& folder);

/// Writes, at the start: description.json, run.json; meanwhile: series.h5, frames/, frames.xdmf, run.json,
/// checkpoint.h5, which goes when the run is done; at the end:
/// packing.txt (`x y z radius` in m, by id, to the last bit; not for a failed run), picture.svg, and run.json last, so
/// that its status vouches for the rest. All functions throw FileError for what the disk refuses.
class ResultsFolder final : public Recorder {
 public:
  /// Makes the folder. Throws FileError where it cannot, where another run writes now, or where it holds a run and
  /// `existing` says refuse.
  explicit ResultsFolder(ResultsOptions options);
  /// Removes what was written, and the folders that were made, if begin() was never called: nothing is left of a run
  /// that does not get to its first step.
  ~ResultsFolder() override;

  /// Throws Error for a channel of the picture that no probe has, or that is not one number.
  void begin(const World& world, std::span<const ProbeGroup> probes) override;
  void sample(std::size_t probe, const World& world, std::span<const std::span<const double>> values) override;
  void frame(const World& world, std::span<const FieldGroup> fields) override;
  void stage_ended(const World& world, const std::string& what) override;
  void flush() override;
  void remember(Memory& memory) override;
  void checkpoint(const Checkpoint& checkpoint) override;
  void finish(const World& world, const RunSummary& summary) override;

 private:
  /// A channel that the picture shows, kept in memory.
  struct Kept {
    SingleChannel channel;
    std::vector<double> steps = {}, values = {};
  };

  /// How much there was at a checkpoint.
  struct Extent {
    std::vector<std::uint64_t> samples;  ///< of each probe
    std::uint64_t frames = 0;
    std::vector<std::vector<double>> steps, values;  ///< of the picture's channels
    void remember(Memory& memory) { memory(samples, frames, steps, values); }
  };

  void draw_picture(const World& world, const RunSummary& summary) const;

  void discard() noexcept;

  ResultsOptions options_;
  std::vector<std::filesystem::path> made_;  ///< folders, the innermost first
  FolderLock lock_;
  RunJson run_json_;
  std::optional<Series> series_;
  std::optional<Frames> frames_;
  std::vector<Kept> kept_;  ///< x first, then the y of the picture
  Extent resumed_;
};

}  // namespace grit
