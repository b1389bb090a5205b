// Quotes words of commands in messages, for copying into a shell.
#pragma once

#include <string>

namespace grit {

/// A word quoted for a shell, also an interactive one: plain if possible, else in double quotes, or in single quotes if
/// it has characters that are special within double quotes.
std::string shell_word(const std::string& word);

}  // namespace grit
