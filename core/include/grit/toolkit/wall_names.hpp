// Names of walls: look-up, and conversion to names of channels and variables.
#pragma once

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include "grit/error.hpp"
#include "grit/toolkit/did_you_mean.hpp"
#include "grit/world.hpp"

namespace grit {

/// Prefix of the channels and variables of a wall: '-', '.' and '+' become '_', and a name that begins with a digit
/// gets "wall_" in front.
inline std::string wall_stem(std::string name) {
  const auto is_other = [](unsigned char c) { return std::isalnum(c) == 0 && c != '_'; };
  std::replace_if(name.begin(), name.end(), is_other, '_');
  const bool digit = !name.empty() && std::isdigit(static_cast<unsigned char>(name.front())) != 0;
  return digit ? "wall_" + name : name;
}

/// Whether a text can be the name of a channel, or its prefix.
inline bool is_snake_case(const std::string& text) {
  const auto letter = [](char c) { return c >= 'a' && c <= 'z'; };
  const auto fits = [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '_'; };
  return !text.empty() && letter(text.front()) && std::all_of(text.begin(), text.end(), fits);
}

/// "a, b, c".
inline std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (const auto& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

inline std::vector<std::string> wall_names(const World& world) {
  std::vector<std::string> names;
  for (const auto& wall : world.walls()) names.push_back(wall.name);
  return names;
}

/// Index of a wall in World::walls(). Throws ParameterError for the parameter `key` if there is no such wall.
inline std::size_t wall_index(const World& world, const std::string& name, const std::string& key) {
  const auto names = wall_names(world);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  const std::string unknown = '"' + name + "\", which is not a wall";
  if (names.empty()) throw ParameterError({{key, unknown, "none, as the description has no walls"}});
  throw ParameterError({{key, unknown + did_you_mean(name, names), "one of the walls " + listed(names)}});
}

}  // namespace grit
