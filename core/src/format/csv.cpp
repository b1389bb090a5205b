#include "format/csv.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "grit/error.hpp"

namespace grit {
namespace {

/// Reads a line, without a carriage return or a byte order mark.
bool get_line(std::istream& stream, std::string& line) {
  const bool first = stream.tellg() == std::streampos(0);
  if (!std::getline(stream, line)) return false;
  if (first && line.starts_with("\xef\xbb\xbf")) line.erase(0, 3);
  if (line.ends_with('\r')) line.pop_back();
  return true;
}

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> all;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) {
    const auto first = cell.find_first_not_of(" \t\""), last = cell.find_last_not_of(" \t\"");
    all.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
  }
  return all;
}

}  // namespace

std::vector<std::vector<double>> read_columns(const std::string& file, const std::vector<std::string>& names) {
  std::ifstream stream(file);
  if (!stream) throw FileError(file + ": cannot be read");
  std::string line;
  get_line(stream, line);
  const auto head = cells(line);
  std::vector<std::size_t> indices;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(head, name);
    if (found == head.end()) throw FileError(file + ":1: there is no column \"" + name + "\" in \"" + line + '"');
    indices.push_back(static_cast<std::size_t>(found - head.begin()));
  }
  std::vector<std::vector<double>> columns(names.size());
  for (int number = 2; get_line(stream, line); ++number) {
    const auto row = cells(line);
    if (row.empty() || row.front().starts_with('#')) continue;
    for (std::size_t k = 0; k < names.size(); ++k) try {
        columns[k].push_back(std::stod(row.at(indices[k])));
      } catch (const std::exception&) {
        throw FileError(file + ':' + std::to_string(number) + ": no number in column \"" + names[k] + "\": \"" + line +
                        '"');
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
