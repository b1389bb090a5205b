#include "format/csv.hpp"

#include <algorithm>
#include <sstream>
#include <string_view>

#include "format/number.hpp"
#include "grit/error.hpp"
#include "grit/toolkit/did_you_mean.hpp"
#include "grit/toolkit/text_file.hpp"

namespace grit {
namespace {

constexpr std::size_t longest_line = 100;  // in a message

/// Cells of a line, without the empty ones at its end. Commas in quotation marks do not separate cells.
std::vector<std::string> cells(std::string_view line) {
  constexpr const char* around = " \t\"";
  std::vector<std::string> all(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (c == ',' && !quoted) all.emplace_back();
    else all.back() += c;
  }
  for (std::string& cell : all) {
    const auto first = cell.find_first_not_of(around), last = cell.find_last_not_of(around);
    cell = first == cell.npos ? "" : cell.substr(first, last - first + 1);
  }
  while (!all.empty() && all.back().empty()) all.pop_back();
  return all;
}

}  // namespace

std::vector<std::vector<double>> read_columns(const std::string& file, const std::vector<std::string>& names) {
  std::istringstream text(read_text(file));
  int number = 1;
  const auto fail = [&](const std::string& what) {
    throw FileError(file + ':' + std::to_string(number) + ": " + what);
  };
  std::string line;
  std::getline(text, line);
  const auto head = cells(line);
  std::vector<std::size_t> indices;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(head, name);
    if (found == head.end())
      fail("there is no column \"" + name + "\" in " + quoted_excerpt(line, longest_line) +
           visible_text(did_you_mean(name, head)));
    indices.push_back(static_cast<std::size_t>(found - head.begin()));
  }
  std::vector<std::vector<double>> columns(names.size());
  while (std::getline(text, line)) {
    ++number;
    const auto row = cells(line);
    if (row.empty() || row.front().starts_with('#')) continue;
    if (row.size() > head.size())
      fail("found " + counted(row.size(), "cell", "cells") + " in " + quoted_excerpt(line, longest_line) +
           "; line 1 names " + counted(head.size(), "column", "columns") + "; numbers use a point, not a comma");
    for (std::size_t k = 0; k < names.size(); ++k) {
      const std::string cell = indices[k] < row.size() ? row[indices[k]] : "";
      const auto [value, fault] = parse_number(cell);
      if (!fault.empty()) fail("column \"" + names[k] + "\" is " + quoted_excerpt(cell) + ": " + std::string(fault));
      columns[k].push_back(value);
    }
  }
  return columns;
}

std::string quoted_cell(const std::string& text) {
  std::string all = "\"";
  for (const char c : text) all += c == '"' ? "\"\"" : std::string(1, c);
  return all + '"';
}

}  // namespace grit
