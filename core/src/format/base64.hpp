// Bytes as text.
#pragma once

#include <string>
#include <vector>

namespace grit {

/// Base64 of RFC 4648, with padding and without line breaks.
std::string base64(std::vector<unsigned char> bytes);

}  // namespace grit
