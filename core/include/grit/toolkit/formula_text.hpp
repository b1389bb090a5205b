// Formulas of descriptions, as texts: names, and what muParser would do beyond an expression.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string_view>

namespace grit {

/// Whether a text can be a name in a formula: letters, digits and _, not starting with a digit.
inline bool is_formula_name(std::string_view text) {
  const auto fits = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  return !text.empty() && std::isdigit(static_cast<unsigned char>(text.front())) == 0 &&
         std::all_of(text.begin(), text.end(), fits);
}

/// Where a formula assigns; npos if it does not. muParser takes "a = 1" for an assignment to its variable, which other
/// formulas then see.
inline std::size_t assignment_in(std::string_view formula) {
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (formula[i] != '=') continue;
    const bool compares = (i > 0 && std::string_view("<>!=").find(formula[i - 1]) != std::string_view::npos) ||
                          (i + 1 < formula.size() && formula[i + 1] == '=');
    if (!compares) return i;
  }
  return std::string_view::npos;
}

/// What is allowed instead of an assignment, for messages.
inline constexpr const char* no_assignment = "an expression without assignments; \"==\" compares";

}  // namespace grit
