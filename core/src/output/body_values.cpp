#include "output/body_values.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>

#include "format/symbols.hpp"
#include "output/shown_fields.hpp"

namespace grit {

std::vector<BodyValues> values_of_bodies(const FieldGroup& table, std::span<const std::int64_t> ids) {
  const auto id = std::ranges::find_if(table.fields, [](const Field& f) { return f.name == "id" && f.width == 1; });
  if (id == table.fields.end()) return {};
  std::unordered_map<std::int64_t, std::size_t> row_of;
  constexpr double largest = 1e18;  // beyond any id, and in the range of integers
  for (std::size_t row = 0; row < id->values.size(); ++row)
    if (std::abs(id->values[row]) < largest) row_of.emplace(static_cast<std::int64_t>(id->values[row]), row);
  std::vector<std::optional<std::size_t>> rows;
  for (const std::int64_t body : ids) {
    const auto found = row_of.find(body);
    rows.push_back(found == row_of.end() ? std::nullopt : std::optional(found->second));
  }

  std::vector<BodyValues> all;
  for (const Field& field : table.fields) {
    if (&field == &*id || field.name == "centre" || field.name == "size" || field.width == 0 ||
        field.values.size() != field.width * id->values.size())
      continue;
    const auto add = [&](const std::string& component, bool is_signed, auto value) {
      BodyValues one{table.name + '/' + field.name, spelled(field.name), field.unit, field.doc, is_signed, {}};
      if (!component.empty()) one.name += '/' + component, one.label += ' ' + component;
      for (const auto& row : rows)
        one.of_bodies.push_back(row ? value(field.values.data() + *row * field.width)
                                    : std::numeric_limits<double>::quiet_NaN());
      all.push_back(std::move(one));
    };
    const std::vector<std::string> components = components_of(field);
    if (components == std::vector<std::string>{"x", "y", "z"})
      add("", false, [](const double* row) { return std::hypot(row[0], row[1], row[2]); });
    for (std::size_t k = 0; k < field.width; ++k)
      add(components.empty() ? "" : components[k], is_signed(field, k), [k](const double* row) { return row[k]; });
  }
  return all;
}

BodyValues values_of_bodies(std::span<const FieldGroup> tables, const World& world, const std::string& name) {
  const std::vector<std::int64_t> ids(world.ids().begin(), world.ids().end());
  for (const FieldGroup& table : tables)
    if (name.starts_with(table.name + '/'))
      for (BodyValues& one : values_of_bodies(table, ids))
        if (one.name == name) return std::move(one);
  return {};
}

}  // namespace grit
