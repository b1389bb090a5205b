// Words of commands that people copy out of a message.
#pragma once

#include <string>

namespace grit {

/// A word as a shell takes it: as it is, or in double quotes where it has blanks or letters that a shell would read.
std::string shell_word(const std::string& word);

}  // namespace grit
