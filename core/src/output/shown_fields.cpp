#include "output/shown_fields.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <string_view>

namespace grit {
namespace {

using std::string_view;

constexpr std::array<string_view, 10> bookkeeping{"id",    "bodies", "grains", "contacts", "chain",
                                                  "count", "number", "step",   "samples",  "start_position"};

constexpr std::array<string_view, 11> informative{
    "void_ratio",  "solid_fraction",    "strain",         "displacement",       "rotation", "velocity", "stress",
    "mean_stress", "deviatoric_stress", "friction_angle", "coordination_number"};

constexpr std::array<string_view, 2> of_reliability{"free_volume_fraction", "correlation"};

template <class List>
bool has(const List& list, const std::string& name) {
  return std::ranges::find(list, name) != list.end();
}

}  // namespace

std::vector<std::string> components_of(const Field& field) {
  if (field.components.size() == field.width) return field.components;
  if (field.width == 1) return {};
  if (field.width == 3) return {"x", "y", "z"};
  if (field.width == 9) return {"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"};
  std::vector<std::string> numbers;
  for (std::size_t i = 1; i <= field.width; ++i) numbers.push_back(std::to_string(i));
  return numbers;
}

bool is_bookkeeping(const Field& field) { return has(bookkeeping, field.name); }

int field_rank(const Field& field) {
  const auto place = std::ranges::find(informative, field.name) - informative.begin();
  return static_cast<int>(place) + (has(of_reliability, field.name) ? 1 : 0);
}

double largest_shown(const Field& field) {
  return field.name == "void_ratio" && field.unit == "1" ? 3 : std::numeric_limits<double>::infinity();
}

bool is_signed(const Field& field, std::size_t component) {
  const auto names = components_of(field);
  const bool is_stress = field.unit == "Pa";
  if (names.empty())
    return !is_stress &&
           (field.doc.find("positive") != std::string::npos || field.doc.find("clockwise") != std::string::npos);
  const std::string& name = names[component];
  const bool on_diagonal = name.size() == 2 && name[0] == name[1];
  return !(is_stress && on_diagonal);
}

}  // namespace grit
