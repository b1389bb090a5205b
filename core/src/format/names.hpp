// Names in messages.
#pragma once

#include <string>
#include <vector>

namespace grit {

inline std::string in_quotes(const std::string& text) { return '"' + text + '"'; }

/// "a, b, c"; `otherwise` if there is nothing to list.
inline std::string listed(const std::vector<std::string>& names, const std::string& otherwise = "none") {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return names.empty() ? otherwise : text;
}

}  // namespace grit
