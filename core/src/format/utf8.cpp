#include "format/utf8.hpp"

#include <boost/locale/utf.hpp>

namespace grit {

bool is_utf8(std::string_view text) {
  namespace utf = boost::locale::utf;
  const char *at = text.data(), *const end = at + text.size();
  while (at != end)
    if (!utf::is_valid_codepoint(utf::utf_traits<char>::decode(at, end))) return false;
  return true;
}

}  // namespace grit
