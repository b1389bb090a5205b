#include "output/shell_word.hpp"

#include <algorithm>
#include <string_view>

namespace grit {

std::string shell_word(const std::string& word) {
  const auto is_plain = [](char c) {
    constexpr std::string_view others = "_./-+,:=@%";
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    return letter || (c & 0x80) != 0 || others.find(c) != others.npos;
  };
  if (!word.empty() && std::ranges::all_of(word, is_plain)) return word;
  if (word.find_first_of("\\\"$`!") == word.npos) return '"' + word + '"';
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + '\'';
}

}  // namespace grit
