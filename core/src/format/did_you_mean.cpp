#include "grit/toolkit/did_you_mean.hpp"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <vector>

namespace grit {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> two_before, before(b.size() + 1), row(b.size() + 1);
  std::iota(before.begin(), before.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({before[j] + 1, row[j - 1] + 1, before[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], two_before[j - 2] + 1);
    }
    two_before = before;
    before = row;
  }
  return before.back();
}

namespace {

/// Length of the common beginning that ends in a slash.
std::size_t shared_path(std::string_view a, std::string_view b) {
  const auto end = std::ranges::mismatch(a, b).in1;
  const auto slash = std::string_view(a.begin(), end).rfind('/');
  return slash == std::string_view::npos ? 0 : slash + 1;
}

/// Whether a name of several words begins or ends with `words`.
bool has_words(std::string_view name, std::string_view words) {
  if (words.empty() || words.size() >= name.size()) return false;
  const auto separates = [](char c) { return c == '-' || c == '_' || c == ' '; };
  return (name.starts_with(words) && separates(name[words.size()])) ||
         (name.ends_with(words) && separates(name[name.size() - words.size() - 1]));
}

}  // namespace

std::optional<std::string> nearest(std::string_view name, std::span<const std::string> names) {
  const auto distance = [&](const std::string& other) { return edit_distance(name, other); };
  const auto closest = std::ranges::min_element(names, {}, distance);
  if (closest == names.end()) return std::nullopt;
  const std::size_t length = std::max(name.size(), closest->size()) - shared_path(name, *closest);
  if (2 * distance(*closest) <= length) return *closest;
  const auto fits = [&](const std::string& other) { return has_words(other, name); };
  const auto only = std::ranges::find_if(names, fits);
  return std::ranges::count_if(names, fits) == 1 ? std::optional(*only) : std::nullopt;
}

std::string did_you_mean(std::string_view name, std::span<const std::string> names) {
  const auto meant = nearest(name, names);
  return meant ? "; did you mean \"" + *meant + "\"?" : "";
}

std::string did_you_mean(std::string_view name, std::span<const std::string> names, std::string last) {
  std::string question = did_you_mean(name, names);
  if (question.empty()) return "; " + last;
  if (!last.empty()) last.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(last.front())));
  return question + ' ' + last;
}

}  // namespace grit
