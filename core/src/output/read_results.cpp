#include "output/read_results.hpp"

#include <spdlog/fmt/fmt.h>
#include <sys/stat.h>

#include <cstdint>
#include <thread>

#include "format/names.hpp"
#include "grit/toolkit/did_you_mean.hpp"
#include "grit/toolkit/text_file.hpp"
#include "output/writing_mark.hpp"
#include "storage/parsed_json.hpp"
#include "storage/seal.hpp"
#include "storage/trial.hpp"

namespace grit {
namespace {

/// Differs if the file was written in between. The resolution of file times is up to 10 ms, so that a stamp is valid
/// only for a file that has rested for longer.
struct Stamp {
  ino_t inode;
  off_t size;
  std::int64_t changed_ns;
  bool operator==(const Stamp&) const = default;
};

constexpr std::int64_t rest_ns = 20'000'000;
constexpr std::chrono::milliseconds retry_interval{10};

Stamp stamp_of(const std::filesystem::path& path) {
  struct stat state {};
  if (::stat(path.c_str(), &state) != 0) throw FileError(path.string() + ": there is no such file");
  if (!S_ISREG(state.st_mode)) throw FileError(path.string() + ": is not a file");
  return {state.st_ino, state.st_size, state.st_mtim.tv_sec * 1'000'000'000 + state.st_mtim.tv_nsec};
}

bool has_rested(const Stamp& stamp) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const auto age = std::chrono::duration_cast<std::chrono::nanoseconds>(now).count() - stamp.changed_ns;
  return age < 0 || age >= rest_ns;  // negative if another machine's clock is ahead
}

/// The series of a run that was killed, or goes on, have no seal, and no checksums of their metadata: reads all of them
/// in a child process.
void try_reading(const std::filesystem::path& path) {
  constexpr std::uintmax_t bytes_per_second = 10'000'000;  // far less than any disk reads
  constexpr unsigned least = 20;
  std::error_code none;
  const std::uintmax_t length = std::filesystem::file_size(path, none);
  const auto seconds = none ? least : least + static_cast<unsigned>(length / bytes_per_second);
  try_in_child(path, seconds, [&] {
    const hdf5::File file(path, hdf5::Mode::copy);
    for (const std::string& probe : file.names()) {
      const auto group = file.group(probe);
      for (const std::string& name : group.names()) try {
          const auto channel = group.dataset(name);
          for (const char* text : {"units", "long_name", "coordinates", "components"})
            if (channel.has_attribute(text)) static_cast<void>(channel.text(text));
          static_cast<void>(channel.read<double>());
        } catch (const FileError&) {  // others may still be read
        }
    }
  });
}

/// Throws FileError for series without a seal if their run is done: the seal was the last that it wrote to them.
void expect_unfinished_run(const std::filesystem::path& path) {
  const auto run = read_run_json(path.parent_path());
  if (run && run->value("status", Description()) == "done")
    throw FileError(path.string() +
                    ": is damaged: its run is done, and the checksum at its end is missing; copy it again, or run the "
                    "description again");
}

/// A copy of the file taken while no writer was active: during a flush the file is temporarily inconsistent.
hdf5::File settled(const std::filesystem::path& path, std::chrono::milliseconds patience) {
  const auto until = std::chrono::steady_clock::now() + patience;
  for (;;) {
    const Stamp before = stamp_of(path);
    const auto has_stayed = [&] { return !is_being_written(path) && stamp_of(path) == before; };
    if (has_rested(before) && !is_being_written(path)) try {
        if (!is_sealed(path)) expect_unfinished_run(path), try_reading(path);
        hdf5::File copy(path, hdf5::Mode::copy);
        if (has_stayed()) return copy;
      } catch (const FileError&) {
        if (has_stayed()) throw;
      }
    if (std::chrono::steady_clock::now() >= until)
      throw BeingWritten(
          fmt::format("{}: has been written to for {} s; try again, or check whether its run is suspended",
                      path.string(), static_cast<double>(patience.count()) / 1000));
    std::this_thread::sleep_for(retry_interval);
  }
}

}  // namespace

SeriesFile::SeriesFile(const std::filesystem::path& folder, std::chrono::milliseconds patience)
    : file_(settled(folder / "series.h5", patience)) {}

SampledChannel SeriesFile::channel(const std::string& name) const {
  const auto slash = name.find('/');
  const std::string probe = name.substr(0, slash), channel = slash == std::string::npos ? "" : name.substr(slash + 1);
  if (!file_.has(probe))
    throw FileError(file_.where() + ": there is no probe \"" + probe + '"' +
                    did_you_mean(probe, file_.names(), "the probes are " + listed(file_.names())));
  const auto group = file_.group(probe);
  if (channel.empty() || !group.has(channel))
    throw FileError(file_.where() + ": probe \"" + probe + "\" has no channel \"" + channel + '"' +
                    did_you_mean(channel, group.names(), "its channels are " + listed(group.names())));
  const auto dataset = group.dataset(channel);
  const auto text = [&](const char* attribute, const char* otherwise) {
    return dataset.has_attribute(attribute) ? dataset.text(attribute) : otherwise;
  };
  return {text("units", "1"),          text("long_name", ""), text("coordinates", ""),
          dataset.words("components"), dataset.rows(),        dataset.read<double>()};
}

std::vector<std::string> SeriesFile::channels() const {
  std::vector<std::string> names;
  for (const auto& probe : file_.names())
    for (const auto& channel : file_.group(probe).names()) names.push_back(probe + '/' + channel);
  return names;
}

SampledChannel read_channel(const std::filesystem::path& folder, const std::string& name) {
  return SeriesFile(folder).channel(name);
}

std::optional<Description> read_run_json(const std::filesystem::path& folder) {
  std::string fault;
  Description json = parsed_json(read_bytes(folder / "run.json", fault));
  if (!json.is_object()) return std::nullopt;
  return json;
}

}  // namespace grit
