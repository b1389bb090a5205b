#include "bodies/packing_file.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string_view>

#include "format/number.hpp"
#include "grit/error.hpp"
#include "grit/toolkit/text_file.hpp"

namespace grit {

namespace {

constexpr std::size_t most_problems = 10;  // limits the output for a large file with many errors
constexpr std::string_view blanks = " \t\v\f";

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what, int reason) {
  throw FileError(path.string() + ": " + what + ": " + (reason != 0 ? std::strerror(reason) : "input or output error"));
}

/// Removes the next word from `line` and returns it; empty at its end.
std::string_view next_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(blanks));
  line.remove_prefix(word.size());
  return word;
}

/// Reads a line that is neither blank nor a comment; returns its problem, or an empty string.
std::string read_grain(std::string_view line, Row& grain) {
  constexpr const char* names[] = {"x", "y", "z", "radius"};
  double* const numbers[] = {&grain.x, &grain.y, &grain.z, &grain.w};
  std::size_t found = 0;
  for (std::string_view word; !(word = next_word(line)).empty(); ++found) {
    if (found >= 4) continue;
    auto [value, fault] = parse_number(word);
    if (fault.empty() && !std::isfinite(value)) fault = "not finite";
    if (!fault.empty()) return std::string(names[found]) + " is " + quoted_excerpt(word) + ": " + std::string(fault);
    *numbers[found] = value;
  }
  if (found != 4) return "found " + std::to_string(found) + " numbers; expected four: x y z radius";
  if (!(grain.w > 0)) return "radius is " + number(grain.w) + " m; it must be above 0";
  return "";
}

void append(std::string& text, double number) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, number, std::chars_format::scientific, 16).ptr;
  text.append(digits, end);
}

}  // namespace

std::vector<Row> read_packing(const std::filesystem::path& path) {
  const std::string text = read_text(path);
  std::vector<Row> grains;
  std::vector<Problem> problems;
  std::size_t left_out = 0;
  int line_number = 0;
  for (std::string_view rest = text; !rest.empty();) {
    std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    ++line_number;
    line = line.substr(0, line.find('#'));
    if (line.find_first_not_of(blanks) == line.npos) continue;
    std::string wrong = read_grain(line, grains.emplace_back());
    if (wrong.empty()) continue;
    if (problems.size() < most_problems) problems.push_back({path.string(), line_number, "", std::move(wrong)});
    else ++left_out;
  }
  if (left_out > 0) problems.push_back({path.string(), 0, "", std::to_string(left_out) + " more lines have errors"});
  if (grains.empty())
    problems.push_back({path.string(), 0, "", "contains no grains; write one line per grain: x y z radius, in m"});
  if (!problems.empty()) throw DescriptionError(std::move(problems));
  return grains;
}

void write_packing(const std::filesystem::path& path, std::size_t grains, const std::function<Row(std::size_t)>& grain,
                   const std::string& comment) {
  const std::filesystem::path part = path.string() + ".part";
  errno = 0;
  std::ofstream file(part, std::ios::binary);
  if (!file) fail(part, "cannot write grains", errno);

  std::string text;
  std::istringstream lines(comment);
  for (std::string line; std::getline(lines, line);) text += "# " + line + '\n';
  text += "# x y z radius, m\n";
  constexpr std::size_t piece = 1 << 20;
  for (std::size_t i = 0; i < grains; ++i) {
    const Row one = grain(i);
    append(text, one.x), text += ' ';
    append(text, one.y), text += ' ';
    append(text, one.z), text += ' ';
    append(text, one.w), text += '\n';
    if (text.size() >= piece) file.write(text.data(), static_cast<std::streamsize>(text.size())), text.clear();
  }
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  std::error_code error;
  if (!file) {
    const int reason = errno;
    std::filesystem::remove(part, error);
    fail(part, "cannot write grains", reason);
  }
  std::filesystem::rename(part, path, error);
  if (error) {
    const int reason = error.value();
    std::filesystem::remove(part, error);
    fail(path, "cannot write grains", reason);
  }
}

}  // namespace grit
