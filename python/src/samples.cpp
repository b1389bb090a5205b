#include "samples.hpp"

#include <algorithm>
#include <span>

namespace grit::python {
namespace {

template <class Number>
py::array copied(std::span<const Number> numbers, std::size_t rows, const std::vector<std::size_t>& row = {}) {
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(rows)};
  shape.insert(shape.end(), row.begin(), row.end());
  py::array_t<Number> all(shape);
  std::ranges::copy(numbers, all.mutable_data());
  return all;
}

}  // namespace

void Samples::begin(const World&, std::span<const ProbeGroup> probes) {
  tables_.clear();
  for (const ProbeGroup& probe : probes)
    tables_.push_back({probe.name, {}, {}, std::vector<std::vector<double>>(probe.channels.size())});
}

void Samples::sample(std::size_t probe, const World& world, std::span<const std::span<const double>> values) {
  Table& table = tables_[probe];
  table.time.push_back(world.time()), table.step.push_back(world.step());
  for (std::size_t i = 0; i < values.size(); ++i)
    table.channels[i].insert(table.channels[i].end(), values[i].begin(), values[i].end());
}

py::array Samples::column(const ProbeGroup& probe, const std::string& name) const {
  const auto found = std::ranges::find(tables_, probe.name, &Table::probe);
  const Table none{probe.name, {}, {}, std::vector<std::vector<double>>(probe.channels.size())};
  const Table& table = found != tables_.end() ? *found : none;
  const std::size_t rows = table.time.size();
  if (name == "time") return copied(std::span(table.time), rows);
  if (name == "step") return copied(std::span(table.step), rows);
  const auto channel = std::ranges::find(probe.channels, name, &Channel::name);
  const auto index = static_cast<std::size_t>(channel - probe.channels.begin());
  return copied(std::span(table.channels.at(index)), rows, channel->shape);
}

}  // namespace grit::python
