// Texts in UTF-8, as JSON, pages and messages need them.
#pragma once

#include <string_view>

namespace grit {

bool is_utf8(std::string_view text);

}  // namespace grit
