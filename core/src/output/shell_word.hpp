// Words of commands that people copy out of a message.
#pragma once

#include <string>

namespace grit {

/// A word as a shell takes it, an interactive one too: as it is, or in quotes where it has blanks or letters that a
/// shell would read; single ones where it has some that a shell reads within double quotes.
std::string shell_word(const std::string& word);

}  // namespace grit
