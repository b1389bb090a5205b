#include "report/cell_maps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "format/symbols.hpp"
#include "output/colours.hpp"
#include "output/scale.hpp"
#include "output/strays.hpp"

namespace grit {
namespace {

constexpr double fraction_shown = 0.98;  // of the cells of a frame, by value: the rest gets the colours of the ends

/// One component of all rows; NaN for values that are not drawable().
std::vector<float> column(const Field& field, std::size_t component) {
  std::vector<float> all;
  for (std::size_t i = component; i < field.values.size(); i += field.width) {
    const double value = field.values[i];
    all.push_back(drawable(value) ? static_cast<float>(value) : std::numeric_limits<float>::quiet_NaN());
  }
  return all;
}

}  // namespace

CellMaps::Map& CellMaps::map_of(const FieldGroup& group) {
  const auto known = std::ranges::find(maps_, group.name, &Map::probe);
  if (known != maps_.end()) return *known;
  Map map{.probe = group.name, .fields = {}, .boxes = {}};
  for (const Field& field : group.fields) {
    if (field.name == "centre" || field.name == "size" || is_bookkeeping(field)) continue;
    map.fields.push_back({field.name,
                          field.unit,
                          field.doc,
                          components_of(field),
                          field.width,
                          {},
                          field_rank(field),
                          {},
                          largest_shown(field)});
    for (std::size_t k = 0; k < field.width; ++k) map.fields.back().is_signed.push_back(grit::is_signed(field, k));
  }
  return maps_.emplace_back(std::move(map));
}

void CellMaps::add(std::size_t frame, const std::string& stage, const std::vector<FieldGroup>& groups) {
  for (const FieldGroup& group : groups) {
    Map& map = map_of(group);
    const std::size_t cells = group.fields[0].values.size() / 3;
    // Cells far from all others are ignored.
    const std::vector<double>&centres = group.fields[0].values, &sizes = group.fields[1].values;
    const Fences fences(centres, median(sizes), far_to_draw);
    for (std::size_t i = 0; i < 3 * cells; ++i) {
      auto& [low, high] = map.boxes.try_emplace(stage).first->second;
      const double least = centres[i] - 0.5 * sizes[i], most = centres[i] + 0.5 * sizes[i];
      if (!fences.hold(i % 3, least, most)) continue;
      low[i % 3] = std::min(low[i % 3], least);
      high[i % 3] = std::max(high[i % 3], most);
    }
    std::vector<float> numbers;
    for (const std::size_t place : {0u, 1u})
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto all = column(group.fields[place], axis);
        numbers.insert(numbers.end(), all.begin(), all.end());
      }
    for (MapField& field : map.fields) {
      const auto found = std::ranges::find(group.fields, field.name, &Field::name);
      const bool there = found != group.fields.end() && found->width == field.width;
      auto& ranges = field.ranges[stage];
      ranges.resize(field.width);
      for (std::size_t k = 0; k < field.width; ++k) {
        const auto all = there ? column(*found, k) : std::vector<float>(cells, std::numeric_limits<float>::quiet_NaN());
        numbers.insert(numbers.end(), all.begin(), all.end());
        std::vector<float> finite;
        std::ranges::copy_if(all, std::back_inserter(finite), [](float value) { return std::isfinite(value); });
        if (finite.empty()) continue;
        std::ranges::sort(finite);
        const auto rim = static_cast<std::size_t>(0.5 * (1 - fraction_shown) * static_cast<double>(finite.size()));
        const Range here{finite[rim], finite[finite.size() - 1 - rim]};
        if (auto& range = ranges[k]) *range = {std::min(range->low, here.low), std::max(range->high, here.high)};
        else range = here;
      }
    }
    const std::size_t bytes = sizeof(float) * numbers.size();
    // A probe with one cell per grain must not use up the space of the others.
    if (bytes > bytes_left_ || map.bytes + bytes > bytes_ / groups.size()) {
      ++map.left_out;
      continue;
    }
    bytes_left_ -= bytes, map.bytes += bytes;
    map.frames.push_back(Description{{"frame", frame}, {"cells", cells}, {"data", data_.add_numbers<float>(numbers)}});
  }
}

Description CellMaps::result() const {
  Description all = Description::array();
  for (const Map& map : maps_) {
    if (map.boxes.empty() || map.fields.empty()) continue;  // no cell in any frame, or no field to show
    Description fields = Description::array(), boxes = Description::object();
    for (const auto& [stage, box] : map.boxes) boxes[stage] = {{"low", box.low}, {"high", box.high}};
    for (const MapField& field : map.fields) {
      std::vector<Range> whole(field.width, {0, 0});
      Description ranges = Description::object();
      for (const auto& [stage, components] : field.ranges) {
        Description& list = ranges[stage] = Description::array();
        for (std::size_t k = 0; k < components.size(); ++k) {
          const auto& range = components[k];
          const double high =
              range ? with_ends({range->low, range->high}, {.most = field.largest_shown}, false).high : 0;
          list.push_back(range ? Description{range->low, high} : Description());
          if (range) whole[k] = {std::min(whole[k].low, range->low), std::max(whole[k].high, range->high)};
        }
      }
      double largest = 0;
      for (const auto& [low, high] : whole) largest = std::max({largest, -low, high});
      const ReadableUnit shown = readable(field.unit, largest);
      fields.push_back(Description{{"name", field.name},
                                   {"label", spelled(field.name)},
                                   {"unit", field.unit},
                                   {"shown_unit", shown.unit},
                                   {"factor", shown.factor},
                                   {"about", with_symbols(field.doc)},
                                   {"components", field.components},
                                   {"signed", field.is_signed},
                                   {"rank", field.rank},
                                   {"ranges", ranges}});
    }
    all.push_back(Description{{"probe", map.probe},
                              {"boxes", boxes},
                              {"fields", fields},
                              {"frames", map.frames},
                              {"left_out", map.left_out}});
  }
  return all;
}

}  // namespace grit
