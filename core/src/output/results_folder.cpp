#include "output/results_folder.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "bodies/packing_file.hpp"
#include "bodies/restored.hpp"
#include "format/duration.hpp"
#include "format/number.hpp"
#include "format/symbols.hpp"
#include "grit/error.hpp"
#include "output/body_columns.hpp"
#include "output/checkpoint.hpp"
#include "output/grain_view.hpp"
#include "output/own_files.hpp"
#include "output/picture.hpp"
#include "storage/atomic_file.hpp"

namespace grit {
namespace {

/// Writes the bodies by id. Positions are not copied, as packings may be large.
void write_grains(const std::filesystem::path& path, const World& world, const std::string& comment) {
  const auto order = bodies_by_id(world);
  const Cell& cell = world.cell();
  const auto grain = [&](std::size_t i) -> Row {
    const Row& x = world.positions()[order[i]];
    const Vec3 inside = cell.inside(xyz(x));
    return {inside.x(), inside.y(), inside.z(), x.w};
  };
  write_packing(path, order.size(), grain, comment);
}

/// The comment of a packing: title, and the cell if it is periodic, which another description needs.
std::string comment_on(const World& world, const std::string& title) {
  const Cell& cell = world.cell();
  if (!(cell.periodic[0] || cell.periodic[1] || cell.periodic[2])) return title;
  const Vec3 &a = cell.low, &b = cell.high;
  const std::string box = fmt::format("{}\ncell {} {} {} to {} {} {}", title, a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
  const Vec3& tilt = cell.tilt;
  return box + (cell.skewed() ? fmt::format(", tilt xy {} xz {} yz {}, m", tilt[0], tilt[1], tilt[2]) : ", m");
}

/// Creates a folder. Returns all folders that were created, the innermost first.
std::vector<std::filesystem::path> made(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> all;
  std::error_code error;
  for (auto at = std::filesystem::absolute(folder).lexically_normal(); !std::filesystem::exists(at, error);
       at = at.parent_path())
    if (all.push_back(at); !at.has_relative_path()) break;
  std::filesystem::create_directories(folder, error);
  if (error) throw FileError(folder.string() + ": cannot create the results folder: " + error.message());
  return all;
}

// Written once, at the end of a run.
constexpr std::array last_files{"packing.txt", "picture.svg", "final.h5"};

/// Checks that the folder may be used. Nothing is changed.
std::filesystem::path checked(const ResultsOptions& options, const FolderLock& lock) {
  const auto& folder = options.folder;
  if (!lock.held()) refuse_busy(folder);
  if (options.existing == Existing::resume) return folder;
  if (options.existing == Existing::refuse && holds_a_run(folder))
    for (const char* mark : {"run.json", "series.h5", "checkpoint.h5", "final.h5"})
      if (std::filesystem::exists(folder / mark))
        throw FileError(folder.string() + ": holds a run already (" + mark +
                        "); choose another folder, resume that run, or allow it to be overwritten");
  refuse_foreign_files(folder);
  return folder;
}

}  // namespace

void refuse_busy(const std::filesystem::path& folder) {
  throw FileError(folder.string() + ": another run is writing there; wait for it, or choose another folder");
}

void remove_checkpoints(const std::filesystem::path& folder) {
  for (const auto& path : {checkpoint_path(folder), previous_checkpoint_path(folder), folder / "series.journal"}) {
    std::error_code error;
    if (std::filesystem::remove(path, error); error)
      throw FileError(path.string() + ": cannot remove it: " + error.message());
  }
}

ResultsFolder::ResultsFolder(ResultsOptions options)
    : options_(std::move(options)),
      made_(made(options_.folder)),
      lock_(options_.folder),
      run_json_(checked(options_, lock_) / "run.json", options_.facts) {}

ResultsFolder::~ResultsFolder() {
  if (!begun_ && options_.existing != Existing::resume) discard();
}

void ResultsFolder::take_over() {
  refuse_foreign_files(options_.folder);  // some may be new: the simulation takes long to make
  const bool replaces = holds_a_run(options_.folder);
  run_json_.announce();  // first, so that a folder in which the run is killed is known as its own
  announced_ = true;
  if (replaces) remove_results(options_.folder);
  write_description();
}

void ResultsFolder::discard() noexcept {
  std::error_code none;
  if (announced_) try {
      journal_.reset(), series_.reset(), frames_.reset();
      remove_results(options_.folder);
      std::filesystem::remove(options_.folder / "frames", none);
      std::filesystem::remove(options_.folder / "description.json", none);
      std::filesystem::remove(options_.folder / "run.json", none);  // last, for the same reason
    } catch (const FileError&) {
      return;  // what is left is known as its own
    }
  for (const auto& folder : made_) std::filesystem::remove(folder, none);  // if it is empty
}

void ResultsFolder::write_description() const {
  if (!options_.facts.description.is_null())
    write_atomically(options_.folder / "description.json", options_.facts.description.dump(2) + '\n');
}

void ResultsFolder::begin(const World& world, std::span<const ProbeGroup> probes) {
  if (options_.picture) {
    const SingleChannels channels(probes);
    kept_.push_back({channels.at(options_.picture->x, "/output/picture/x")});
    for (std::size_t i = 0; i < options_.picture->y.size(); ++i)
      kept_.push_back({channels.at(options_.picture->y[i], fmt::format("/output/picture/y/{}", i))});
    grain_view(world, {}, options_.picture->view, options_.picture->color);
  }
  const bool resumes = options_.existing == Existing::resume;
  if (resumes) {
    expect_restored(resumed_.frames <= world.step() + 1, "there are more frames than steps");
    restore(probes);
    for (std::size_t i = 0; i < kept_.size() && i < resumed_.steps.size(); ++i)
      kept_[i].steps = resumed_.steps[i], kept_[i].values = resumed_.values[i];
  } else {
    take_over();
    journal_.emplace(options_.folder / "series.journal");
    series_.emplace(options_.folder / "series.h5", probes, options_.flushing);
    frames_.emplace(options_.folder, options_.walls, 0, options_.formats);
  }
  run_json_.begin(world, resumes);
  for (const char* file : last_files) note(file);
  begun_ = true;
  if (!resumes) return;
  write_description();
  // The damaged one must not become the one before the next.
  if (options_.from_previous)
    std::filesystem::rename(previous_checkpoint_path(options_.folder), checkpoint_path(options_.folder));
}

/// Nothing is changed unless everything can be restored: series.h5 may be in any state.
void ResultsFolder::restore(std::span<const ProbeGroup> probes) {
  const auto path = options_.folder / "series.h5", part = temporary_path(path);
  journal_.emplace(options_.folder / "series.journal", resumed_.journal);
  restore_series(*journal_, probes, resumed_.samples, part);
  try {
    frames_.emplace(options_.folder, options_.walls, resumed_.frames, options_.formats);
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw;
  }
  publish(path);
  journal_->cut();
  series_.emplace(path, probes, resumed_.samples, options_.flushing);
}

void ResultsFolder::note(const char* file) { last_files_[file] = file_stamp(options_.folder / file); }

bool ResultsFolder::has_other(const char* file) const {
  const auto found = file_stamp(options_.folder / file);
  return found && found != last_files_.at(file);
}

void ResultsFolder::expect_no_other(const char* file) const {
  if (has_other(file))
    throw RefusedRecord((options_.folder / file).string() +
                        ": appeared or was changed during the run, and would be lost; move it away");
}

void ResultsFolder::expect_room() const {
  frames_->expect_room();
  for (const char* file : last_files) expect_no_other(file);
}

void ResultsFolder::sample(std::size_t probe, const World& world, std::span<const std::span<const double>> values) {
  journal_->append(probe, world.time(), world.step(), values);
  series_->append(probe, world.time(), world.step(), values);
  for (auto& kept : kept_)
    if (kept.channel.probe == probe) {
      kept.steps.push_back(static_cast<double>(world.step()));
      kept.values.push_back(kept.channel.of(world, values));
    }
}

void ResultsFolder::frame(const World& world, std::span<const FieldGroup> fields) {
  frames_->write(world, fields);
  if (options_.picture && names_a_field(options_.picture->color))
    color_values_ = values_of_bodies(fields, world, options_.picture->color), color_step_ = world.step();
}

void ResultsFolder::stage_ended(const World& world, const std::string& what) {
  flush();
  run_json_.stage_ended(world, what);
}

void ResultsFolder::flush() {
  journal_->flush();
  series_->flush();
  frames_->update_indices();
}

void ResultsFolder::serialize(Archive& archive) {
  if (!archive.restoring()) {
    resumed_ = {series_->samples(), frames_->count(), {}, {}, journal_->extent()};
    for (const Kept& kept : kept_) resumed_.steps.push_back(kept.steps), resumed_.values.push_back(kept.values);
  }
  archive(resumed_, run_json_);
  // A resumed run does not make the first bodies again.
  const auto is_clipped = [](const WallShape& shape) { return shape.clipped; };
  std::vector<WallShape> clipped;
  std::ranges::copy_if(options_.walls, std::back_inserter(clipped), is_clipped);
  archive(clipped);
  if (!archive.restoring()) return;
  for (std::size_t i = 0; i < std::max(resumed_.steps.size(), resumed_.values.size()); ++i)
    if (resumed_.steps.size() != resumed_.values.size() || resumed_.steps[i].size() != resumed_.values[i].size())
      throw Error(
          "the saved state is damaged or was altered: its curves have different lengths; use another checkpoint");
  std::erase_if(options_.walls, is_clipped);
  std::ranges::move(clipped, std::back_inserter(options_.walls));
}

void ResultsFolder::sync(std::initializer_list<const char*> files) const {
  for (const char* file : files)
    if (std::filesystem::exists(options_.folder / file)) sync_to_disk(options_.folder / file);
  sync_folder(options_.folder);
  for (const auto& folder : made_) sync_folder(folder.parent_path());
}

void ResultsFolder::checkpoint(const StateToSave& state) {
  journal_->sync();
  frames_->sync();
  sync({"run.json", "description.json"});
  write_checkpoint(checkpoint_path(options_.folder), options_.facts, state, previous_checkpoint_path(options_.folder));
}

void ResultsFolder::final_state(const StateToSave& state) {
  expect_no_other("final.h5");
  write_checkpoint(options_.folder / "final.h5", options_.facts, state);
  note("final.h5");
}

void ResultsFolder::finish(const World& world, const RunSummary& summary) {
  series_->close();
  frames_->update_indices();
  if (summary.status != "failed") {
    for (const char* file : {"packing.txt", "picture.svg"}) expect_no_other(file);
    write_grains(options_.folder / "packing.txt", world, comment_on(world, options_.title));
  } else if (!has_other("packing.txt")) {  // one from an interruption does not belong to the end
    std::error_code ignored;
    std::filesystem::remove(options_.folder / "packing.txt", ignored);
  }
  if (options_.picture && !kept_.empty() && !has_other("picture.svg")) draw_picture(world, summary);
  for (const char* file : {"packing.txt", "picture.svg"}) note(file);
  series_->expect_own_file();
  run_json_.finish(world, summary);
  if (summary.status == "done") {
    frames_->sync();
    sync({"series.h5", "packing.txt", "picture.svg", "run.json", "description.json"});
  } else if (has_checkpoint(options_.folder)) {
    return;
  }
  journal_.reset();
  remove_checkpoints(options_.folder);
}

void ResultsFolder::draw_picture(const World& world, const RunSummary& summary) const {
  Picture picture;
  picture.title = options_.title.empty() ? options_.folder.filename().string() : options_.title;
  picture.facts = fmt::format("{} grains  ·  {} simulated  ·  {} steps  ·  {:.3g} million particle-steps/s",
                              grouped(summary.bodies), written_time(summary.time), grouped(summary.steps),
                              1e-6 * summary.particle_steps_per_second);
  const auto axis = [](const SingleChannel& channel) {
    return Axis{channel_label(channel.probe_name, channel.name), channel.unit};
  };
  const auto& x = kept_.front();
  for (const auto& y : std::span(kept_).subspan(1)) {
    // Probes may sample at different steps: only common steps give a point.
    Curve curve;
    for (std::size_t i = 0, j = 0; i < x.steps.size() && j < y.steps.size();) {
      if (x.steps[i] == y.steps[j]) {
        curve.x.push_back(x.values[i]);
        curve.y.push_back(y.values[j]);
        ++i, ++j;
      } else {
        x.steps[i] < y.steps[j] ? ++i : ++j;
      }
    }
    picture.panels.push_back({axis(x.channel), axis(y.channel), {std::move(curve)}});
  }
  // Of the last frame, which is that of this instant unless the run failed.
  const bool known = !color_values_.name.empty() && color_step_ == world.step() &&
                     color_values_.of_bodies.size() == world.ids().size();
  picture.grains = grain_view(world, options_.walls, options_.picture->view, options_.picture->color,
                              known ? &color_values_ : nullptr);
  picture.grains->ends = options_.picture->scale;
  write_atomically(options_.folder / "picture.svg", draw(picture));
}

}  // namespace grit
