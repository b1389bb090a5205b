#include "bodies/packing_rows.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>

#include "format/number.hpp"
#include "grit/toolkit/text_file.hpp"

namespace grit {
namespace {

constexpr std::size_t most_problems = 10;                  // limits the output for a large file with many errors
constexpr std::size_t most_types = 10, longest_type = 20;  // in a message
constexpr std::string_view blanks = " \t\v\f";
constexpr auto quantities = static_cast<std::size_t>(Column::type);  // columns that are numbers

constexpr std::array<const char*, quantities> quantity_names{"x",  "y",  "z",  "radius", "diameter", "vx",
                                                             "vy", "vz", "wx", "wy",     "wz"};

std::string name_of(Column column) {
  if (column == Column::type) return "type";
  if (column == Column::id) return "id";
  if (column == Column::skip) return "-";
  return quantity_names[static_cast<std::size_t>(column)];
}

std::string_view trimmed(std::string_view text, std::string_view around) {
  const auto first = text.find_first_not_of(around);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(around) - first + 1);
}

bool has(std::span<const Column> columns, Column one) { return std::ranges::find(columns, one) != columns.end(); }

/// Index of the first column of this kind.
std::optional<std::size_t> place_of(std::span<const Column> columns, Column one) {
  const auto at = std::ranges::find(columns, one);
  if (at == columns.end()) return std::nullopt;
  return static_cast<std::size_t>(at - columns.begin());
}

}  // namespace

std::string lower_case(std::string_view text) {
  std::string all(text);
  for (char& c : all) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return all;
}

std::optional<Column> column_of_description(std::string_view name) {
  const auto& names = FileSource::column_names();
  const auto at = std::ranges::find(names, name);
  if (at == names.end()) return std::nullopt;
  return static_cast<Column>(at - names.begin());
}

Column column_of_header(std::string_view name) {
  static const std::vector<std::pair<Column, std::vector<std::string>>> known{
      {Column::x, {"x", "pos_x", "xu"}},
      {Column::y, {"y", "pos_y", "yu"}},
      {Column::z, {"z", "pos_z", "zu"}},
      {Column::radius, {"r", "radius"}},
      {Column::diameter, {"d", "diameter"}},
      {Column::vx, {"vx", "v_x", "vel_x", "velocity_x"}},
      {Column::vy, {"vy", "v_y", "vel_y", "velocity_y"}},
      {Column::vz, {"vz", "v_z", "vel_z", "velocity_z"}},
      {Column::wx, {"wx", "w_x", "omegax", "omega_x", "angvel_x"}},
      {Column::wy, {"wy", "w_y", "omegay", "omega_y", "angvel_y"}},
      {Column::wz, {"wz", "w_z", "omegaz", "omega_z", "angvel_z"}},
      {Column::type, {"type", "family", "matid"}},
      {Column::id, {"id"}}};
  const std::string wanted = lower_case(name);
  for (const auto& [column, names] : known)
    if (std::ranges::find(names, wanted) != names.end()) return column;
  return Column::skip;
}

std::vector<Column> columns_of_header(std::span<const std::string_view> names) {
  std::vector<Column> columns;
  for (const std::string_view name : names) {
    const Column column = column_of_header(name);
    columns.push_back(has(columns, column) ? Column::skip : column);
  }
  if (has(columns, Column::radius)) std::ranges::replace(columns, Column::diameter, Column::skip);
  return columns;
}

std::string lacking(std::span<const Column> columns) {
  std::string text;
  const auto lacks = [&](const std::string& what) { text += (text.empty() ? "" : ", ") + what; };
  for (const Column one : {Column::x, Column::y, Column::z})
    if (!has(columns, one)) lacks(name_of(one));
  if (!has(columns, Column::radius) && !has(columns, Column::diameter)) lacks("radius or diameter");
  return text;
}

bool TextLines::next() {
  if (rest_.empty()) return false;
  line_ = rest_.substr(0, rest_.find('\n'));
  rest_.remove_prefix(std::min(line_.size() + 1, rest_.size()));
  ++number_;
  return true;
}

std::string_view without_comment(std::string_view line) { return line.substr(0, line.find('#')); }

bool is_blank(std::string_view line) { return line.find_first_not_of(blanks) == line.npos; }

void split(std::string_view line, char separator, std::vector<std::string_view>& cells) {
  cells.clear();
  if (separator == ' ') {
    for (;;) {
      line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
      if (line.empty()) return;
      cells.push_back(line.substr(0, line.find_first_of(blanks)));
      line.remove_prefix(cells.back().size());
    }
  }
  for (;;) {
    const std::string_view cell = line.substr(0, line.find(separator));
    cells.push_back(trimmed(cell, " \t\v\f\""));
    if (cell.size() == line.size()) break;
    line.remove_prefix(cell.size() + 1);
  }
  if (cells.back().empty()) cells.pop_back();
}

char separator_of(std::string_view line) {
  if (line.find(';') != line.npos) return ';';
  if (line.find(',') == line.npos) return ' ';
  // Blanks within a cell, as in "0,01 2 3", separate cells: the comma is a wrong decimal point.
  std::vector<std::string_view> cells;
  split(line, ',', cells);
  const auto is_one_word = [](std::string_view cell) { return cell.find_first_of(blanks) == cell.npos; };
  return std::ranges::all_of(cells, is_one_word) ? ',' : ' ';
}

void PackingFaults::add(int line, std::string message) {
  if (problems_.size() < most_problems) problems_.push_back({path_, line, "", std::move(message)});
  else ++left_out_;
}

void PackingFaults::raise() {
  if (left_out_ > 0) problems_.push_back({path_, 0, "", std::to_string(left_out_) + " more lines have errors"});
  if (any()) throw DescriptionError(problems_);
}

void PackingFaults::raise(int line, std::string message) {
  throw DescriptionError({{path_, line, "", std::move(message)}});
}

RowReader::RowReader(const FileSource& source, PackingFaults& faults, std::vector<Column> columns, char separator,
                     bool more)
    : source_(source),
      faults_(faults),
      columns_(std::move(columns)),
      separator_(separator),
      more_(more),
      type_at_(place_of(columns_, Column::type)),
      id_at_(place_of(columns_, Column::id)) {}

std::optional<PackedBody> RowReader::read(std::string_view line, int number) {
  split(line, separator_, cells_);
  id_ = {};
  if (cells_.size() < columns_.size() || (cells_.size() > columns_.size() && !more_)) {
    std::string names;
    for (const Column one : columns_) names += ' ' + name_of(one);
    faults_.add(number, "found " + counted(cells_.size(), "column", "columns") + "; expected " +
                            (more_ ? "at least " : "") + std::to_string(columns_.size()) + ':' + names);
    return std::nullopt;
  }
  if (width_ == 0) width_ = cells_.size();
  if (cells_.size() != width_) {
    faults_.add(number, "found " + counted(cells_.size(), "column", "columns") + "; the first row has " +
                            std::to_string(width_));
    return std::nullopt;
  }
  if (id_at_) id_ = cells_[*id_at_];
  if (type_at_ && !source_.particle_type.empty() && !is_wanted(cells_[*type_at_])) return std::nullopt;
  PackedBody body;
  std::string wrong = problem(body);
  if (wrong.empty()) return body;
  faults_.add(number, std::move(wrong));
  return std::nullopt;
}

std::string RowReader::problem(PackedBody& body) const {
  std::array<double, quantities> values{};
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    if (columns_[k] >= Column::type) continue;
    const auto quantity = static_cast<std::size_t>(columns_[k]);
    auto [value, fault] = parse_number(cells_[k]);
    if (fault.empty() && !std::isfinite(value)) fault = "not finite";
    if (!fault.empty())
      return std::string(quantity_names[quantity]) + " is " + quoted_excerpt(cells_[k]) + ": " + std::string(fault);
    values[quantity] = value;
  }
  const auto value = [&](Column one) { return values[static_cast<std::size_t>(one)]; };
  const auto length = [&](Column one) { return source_.scale * value(one); };
  const bool by_diameter = has(columns_, Column::diameter);
  const double radius = by_diameter ? 0.5 * length(Column::diameter) : length(Column::radius);
  if (!(radius > 0))
    return by_diameter ? "diameter is " + number(2 * radius) + " m; it must be above 0"
                       : "radius is " + number(radius) + " m; it must be above 0";
  body.sphere = {length(Column::x), length(Column::y), length(Column::z), radius};
  body.velocity = {length(Column::vx), length(Column::vy), length(Column::vz)};
  body.spin = {value(Column::wx), value(Column::wy), value(Column::wz)};
  return "";
}

bool RowReader::is_wanted(std::string_view type) {
  const auto same_number = [&] {  // "2" and "2.0000e+00"
    const WrittenNumber a = parse_number(type), b = parse_number(source_.particle_type);
    return a.fault.empty() && b.fault.empty() && a.value == b.value;
  };
  const bool wanted = type == source_.particle_type || same_number();
  found_type_ = found_type_ || wanted;
  if (!wanted && types_.size() < most_types) types_.emplace(visible_text(type, longest_type));
  return wanted;
}

void RowReader::check_types() {
  if (source_.particle_type.empty() || found_type_) return;
  const std::string wanted = "particle type " + quoted_excerpt(source_.particle_type);
  if (!type_at_) return faults_.add(0, "has no types of particles; remove the " + wanted);
  std::string all;
  for (const std::string& one : types_) all += (all.empty() ? "" : ", ") + one;
  if (!all.empty()) faults_.add(0, "has no body of " + wanted + "; its types are " + all);
}

}  // namespace grit
