#include "grit/toolkit/text_file.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <boost/locale/utf.hpp>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <utility>

#include "grit/error.hpp"

namespace grit {
namespace {

/// Whether a number that double precision cannot represent, without its sign, is too large, not too small.
bool is_too_large(std::string_view number) {
  int exponent = 0;
  if (const auto e = number.find_first_of("eE"); e != number.npos) {
    std::string_view power = number.substr(e + 1);
    if (power.starts_with('+')) power.remove_prefix(1);
    const auto error = std::from_chars(power.data(), power.data() + power.size(), exponent).ec;
    if (error == std::errc::result_out_of_range) return !power.starts_with('-');
    number = number.substr(0, e);
  }
  const auto point = static_cast<std::int64_t>(std::min(number.find('.'), number.size()));
  const auto first = number.find_first_of("123456789");
  return first != number.npos && exponent + point > static_cast<std::int64_t>(first);
}

bool has_decimal_comma(std::string_view word) {
  const auto comma = word.find(',');
  if (comma == word.npos || word.find(',', comma + 1) != word.npos) return false;
  if (word.find_first_of("0123456789", comma) != comma + 1) return false;
  std::string with_point(word);
  with_point[comma] = '.';
  return parse_number(with_point).fault.empty();
}

bool is_visible(boost::locale::utf::code_point code) {
  constexpr boost::locale::utf::code_point no_break_space = 0xa0, byte_order_mark = 0xfeff;
  return code >= ' ' && !(code >= 0x7f && code <= no_break_space) && code != byte_order_mark;
}

}  // namespace

std::string read_bytes(const std::filesystem::path& path, std::error_code& error) {
  error.clear();
  const auto fail = [&](int reason) {
    error = std::error_code(reason != 0 ? reason : EIO, std::generic_category());
    return std::string();
  };
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) return fail(errno);
  std::string bytes;
  constexpr std::size_t piece = 1 << 20;
  std::error_code unknown;  // a pipe has no size
  if (const auto size = std::filesystem::file_size(path, unknown); !unknown) bytes.reserve(size + piece);
  do {
    const std::size_t size = bytes.size();
    bytes.resize(size + piece);
    file.read(bytes.data() + size, piece);
    bytes.resize(size + static_cast<std::size_t>(file.gcount()));
  } while (file);
  if (file.bad()) return fail(errno);
  return bytes;
}

bool is_utf16(std::string_view bytes) { return bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff"); }

std::string plain_text(std::string bytes, const std::string& name) {
  if (is_utf16(bytes)) throw FileError(name + ": the file is UTF-16 text; save it as UTF-8");
  if (bytes.starts_with("\xef\xbb\xbf")) bytes.erase(0, 3);
  std::size_t kept = std::min(bytes.find('\r'), bytes.size());
  for (std::size_t i = kept; i < bytes.size(); ++i) {
    const bool ends = bytes[i] == '\r';
    if (ends && i + 1 < bytes.size() && bytes[i + 1] == '\n') continue;
    bytes[kept++] = ends ? '\n' : bytes[i];
  }
  bytes.resize(kept);
  return bytes;
}

std::string read_text(const std::filesystem::path& path) {
  std::error_code error;
  std::string bytes = read_bytes(path, error);
  if (error) throw FileError(path.string() + ": cannot be read: " + error.message());
  return plain_text(std::move(bytes), path.string());
}

WrittenNumber parse_number(std::string_view word) {
  if (word.empty()) return {0, "empty"};
  if (has_decimal_comma(word)) return {0, "numbers use a point, not a comma"};
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  double value = 0;
  const char* const last = word.data() + word.size();
  const auto [end, error] = std::from_chars(word.data(), last, value);
  if (error == std::errc::invalid_argument) return {0, "not a number"};
  if (end != last)
    return {0, *end == ',' ? "a comma follows the number; separate numbers by blanks" : "text follows the number"};
  if (error == std::errc()) return {value, {}};
  const bool negative = word.starts_with('-');
  if (is_too_large(word.substr(negative ? 1 : 0))) return {0, "beyond the largest number, 1.8e308"};
  return {negative ? -0.0 : 0.0, {}};
}

std::string visible_text(std::string_view text, std::size_t most) {
  namespace utf = boost::locale::utf;
  std::string shown;
  const char *at = text.data(), *const end = at + text.size();
  for (std::size_t count = 0; at != end; ++count) {
    if (count == most) return shown + "…";
    const char* next = at;
    const utf::code_point code = utf::utf_traits<char>::decode(next, end);
    const bool valid = utf::is_valid_codepoint(code);
    if (!valid) next = at + 1;
    if (valid && is_visible(code)) shown.append(at, next);
    else
      for (const char* byte = at; byte != next; ++byte)
        shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(*byte));
    at = next;
  }
  return shown;
}

std::string quoted_excerpt(std::string_view text, std::size_t most) { return '"' + visible_text(text, most) + '"'; }

}  // namespace grit
