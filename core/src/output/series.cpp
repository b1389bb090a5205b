#include "output/series.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "grit/error.hpp"

namespace grit {
namespace {

// 16 KiB: small runs stay small files, and long ones open a new chunk, the one change of the index, seldom.
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
                    ": has another shape than the probe's channel: resume with the description that "
                    "the run began with, or write to another folder");
  dataset.truncate(rows);
  return dataset;
}

}  // namespace

Series::Series(const std::filesystem::path& path, std::span<const ProbeGroup> probes, Flushing flushing)
    : file_(path, hdf5::Mode::replace), flushing_(flushing) {
  for (const auto& probe : probes) tables_.push_back(create(probe));
  file_.flush();
}

Series::Series(const std::filesystem::path& path, std::span<const ProbeGroup> probes, std::uint64_t last_step,
               Flushing flushing)
    : file_(path, hdf5::Mode::change), flushing_(flushing) {
  for (const auto& probe : probes) tables_.push_back(file_.has(probe.name) ? reopen(probe, last_step) : create(probe));
  file_.flush();
}

Series::Table Series::create(const ProbeGroup& probe) {
  auto group = file_.create_group(probe.name);
  Table table{column<double>(group, {"time", "s", "simulated time since the start of the run", {}}),
              column<std::uint64_t>(group, {"step", "1", "steps since the start of the run", {}}),
              {},
              {},
              {}};
  for (const auto& channel : probe.channels) table.columns.push_back({column<double>(group, channel), {}});
  return table;
}

Series::Table Series::reopen(const ProbeGroup& probe, std::uint64_t last_step) {
  const auto group = file_.group(probe.name);
  const auto steps = group.dataset("step").read<std::uint64_t>();
  const auto rows = static_cast<std::size_t>(std::ranges::upper_bound(steps, last_step) - steps.begin());
  Table table{reopened(group, {"time", "s", "", {}}, rows), reopened(group, {"step", "1", "", {}}, rows), {}, {}, {}};
  for (const auto& channel : probe.channels) table.columns.push_back({reopened(group, channel, rows), {}});
  return table;
}

void Series::append(std::size_t probe, double time, std::uint64_t step,
                    std::span<const std::span<const double>> values) {
  auto& table = tables_.at(probe);
  table.waiting_times.push_back(time);
  table.waiting_steps.push_back(step);
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    auto& waiting = table.columns[i].waiting;
    waiting.insert(waiting.end(), values[i].begin(), values[i].end());
    waiting_ += values[i].size();
  }
  if (waiting_ >= flushing_.numbers || std::chrono::steady_clock::now() - flushed_ >= flushing_.interval) flush();
}

void Series::flush() {
  const auto drain = [](hdf5::Dataset& dataset, auto& waiting) {
    if (!waiting.empty()) dataset.append(std::span(std::as_const(waiting)));
    waiting.clear();
  };
  for (auto& table : tables_) {
    drain(table.time, table.waiting_times);
    drain(table.step, table.waiting_steps);
    for (auto& column : table.columns) drain(column.dataset, column.waiting);
  }
  file_.flush();
  waiting_ = 0;
  flushed_ = std::chrono::steady_clock::now();
}

void Series::close() {
  flush();
  file_.close();
}

}  // namespace grit
