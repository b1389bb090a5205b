#include "output/series.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "grit/error.hpp"
#include "storage/seal.hpp"

namespace grit {
namespace {

// 16 KiB: keeps files of short runs small; long runs rarely open a new chunk, the only change of the index.
constexpr std::size_t numbers_per_chunk = 2048;

template <class T>
hdf5::Dataset column(hdf5::Group& group, const Channel& channel) {
  const auto row = std::max<std::size_t>(hdf5::product(channel.shape), 1);
  auto dataset =
      group.create_growing<T>(channel.name, channel.shape, std::max<std::size_t>(numbers_per_chunk / row, 1));
  dataset.set_attribute("units", channel.unit);
  dataset.set_attribute("long_name", channel.doc);
  if (!channel.coordinate.empty()) dataset.set_attribute("coordinates", channel.coordinate);
  if (!channel.components.empty())
    dataset.set_attribute("components", fmt::format("{}", fmt::join(channel.components, " ")));
  return dataset;
}

hdf5::Dataset reopened(const hdf5::Group& group, const Channel& channel, std::size_t rows) {
  auto dataset = group.dataset(channel.name);
  auto shape = dataset.shape();
  shape.erase(shape.begin());
  if (shape != channel.shape)
    throw FileError(dataset.where() +
                    ": has another shape than the probe's channel; resume with the original description, or write to "
                    "another folder");
  if (dataset.rows() < rows)
    throw FileError(dataset.where() + ": has " + std::to_string(dataset.rows()) + " of the " + std::to_string(rows) +
                    " samples at the checkpoint: the file was replaced or is damaged; start again (--overwrite)");
  dataset.truncate(rows);
  return dataset;
}

/// Marks a file while it is being written, also if writing fails.
class Marked {
 public:
  explicit Marked(const WritingMark& mark) : mark_(mark) { mark_.set(); }
  ~Marked() { mark_.clear(); }
  Marked(const Marked&) = delete;
  Marked& operator=(const Marked&) = delete;

 private:
  const WritingMark& mark_;
};

}  // namespace

Series::Series(const std::filesystem::path& path, std::span<const ProbeGroup> probes, Flushing flushing)
    : path_(path), mark_(path, WritingMark::Absent::make), file_(path, hdf5::Mode::replace), flushing_(flushing) {
  for (const auto& probe : probes) tables_.push_back(create(probe));
  file_.flush();
  mark_.clear();
}

Series::Series(const std::filesystem::path& path, std::span<const ProbeGroup> probes,
               std::span<const std::uint64_t> kept, Flushing flushing)
    : path_(path), mark_(path, WritingMark::Absent::leave), file_(path, hdf5::Mode::change), flushing_(flushing) {
  if (kept.size() != probes.size())
    throw FileError(path.string() + ": is of a run with " + std::to_string(kept.size()) +
                    " probes, but the description has " + std::to_string(probes.size()) +
                    "; resume with the original description");
  for (std::size_t i = 0; i < probes.size(); ++i) tables_.push_back(reopen(probes[i], kept[i]));
  file_.flush();
  mark_.clear();
}

Series::~Series() { mark_.set(); }

Series::Table Series::create(const ProbeGroup& probe) {
  auto group = file_.create_group(probe.name);
  Table table{column<double>(group, time_column), column<std::uint64_t>(group, step_column), {}, {}, {}, 0};
  for (const auto& channel : probe.channels) table.columns.push_back({column<double>(group, channel), {}});
  return table;
}

Series::Table Series::reopen(const ProbeGroup& probe, std::uint64_t samples) {
  const auto group = file_.group(probe.name);
  Table table{reopened(group, time_column, samples), reopened(group, step_column, samples), {}, {}, {}, samples};
  for (const auto& channel : probe.channels) table.columns.push_back({reopened(group, channel, samples), {}});
  return table;
}

void Series::append(std::size_t probe, double time, std::uint64_t step,
                    std::span<const std::span<const double>> values) {
  auto& table = tables_.at(probe);
  ++table.samples;
  table.waiting_times.push_back(time);
  table.waiting_steps.push_back(step);
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    auto& waiting = table.columns[i].waiting;
    waiting.insert(waiting.end(), values[i].begin(), values[i].end());
    waiting_ += values[i].size();
  }
  if (waiting_ >= flushing_.numbers || std::chrono::steady_clock::now() - flushed_ >= flushing_.interval) flush();
}

void Series::write() {
  const auto drain = [](hdf5::Dataset& dataset, auto& waiting) {
    if (!waiting.empty()) dataset.append(std::span(std::as_const(waiting)));
    waiting.clear();
  };
  for (auto& table : tables_) {
    drain(table.time, table.waiting_times);
    drain(table.step, table.waiting_steps);
    for (auto& column : table.columns) drain(column.dataset, column.waiting);
  }
  waiting_ = 0;
  flushed_ = std::chrono::steady_clock::now();
}

void Series::expect_own_file() const {
  if (!mark_.is_of(path_))
    throw FileError(path_.string() + ": was removed or replaced during the run, whose samples would be lost");
}

void Series::flush() {
  expect_own_file();
  const Marked marked(mark_);
  write();
  file_.flush();
}

std::vector<std::uint64_t> Series::samples() const {
  std::vector<std::uint64_t> samples;
  for (const auto& table : tables_) samples.push_back(table.samples);
  return samples;
}

void Series::close() {
  expect_own_file();
  const Marked marked(mark_);
  write();
  file_.close();
  seal(path_);
  expect_own_file();
}

}  // namespace grit
