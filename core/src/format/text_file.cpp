#include "grit/toolkit/text_file.hpp"

#include <fcntl.h>
#include <linux/magic.h>
#include <spdlog/fmt/fmt.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <boost/locale/utf.hpp>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <system_error>
#include <utility>

#include "format/resources.hpp"
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

struct OpenFile {
  explicit OpenFile(int opened) : number(opened) {}
  ~OpenFile() {
    if (number >= 0) ::close(number);
  }
  OpenFile(const OpenFile&) = delete;
  const int number;
};

/// Whether a file is a pipe between processes, as /dev/stdin is in "cat grains.txt | grit …". A named pipe is not: it
/// may have no writer.
bool is_pipe_of_process(int file) {
  struct statfs about {};
  return ::fstatfs(file, &about) == 0 && about.f_type == PIPEFS_MAGIC;
}

bool is_visible(boost::locale::utf::code_point code) {
  constexpr boost::locale::utf::code_point no_break_space = 0xa0, byte_order_mark = 0xfeff;
  return code >= ' ' && !(code >= 0x7f && code <= no_break_space) && code != byte_order_mark;
}

}  // namespace

std::string read_bytes(const std::filesystem::path& path, std::string& fault) {
  fault.clear();
  const auto fail = [&](std::string why) {
    fault = std::move(why);
    return std::string();
  };
  const auto of_system = [](int reason) { return std::generic_category().message(reason != 0 ? reason : EIO); };
  // Without O_NONBLOCK a named pipe without a writer, or a device, could stop the program here.
  const OpenFile file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  struct stat about {};
  if (file.number < 0 || ::fstat(file.number, &about) != 0) return fail(of_system(errno));
  if (S_ISDIR(about.st_mode)) return fail(of_system(EISDIR));
  const bool piped = is_pipe_of_process(file.number);
  if (!S_ISREG(about.st_mode) && !piped)
    return fail(std::string("it is a ") + (S_ISFIFO(about.st_mode) ? "named pipe" : "device") +
                "; allowed are regular files");
  if (piped) ::fcntl(file.number, F_SETFL, 0);
  const double available = available_memory(), size = static_cast<double>(about.st_size);
  const auto too_large = [&](double found) {
    return fail("it has " + std::string(piped ? "more than " : "") + bytes_text(found) + ", and " +
                bytes_text(available) + " of memory are available");
  };
  if (size > available) return too_large(size);
  std::string bytes;
  constexpr std::size_t piece = 1 << 20;
  bytes.reserve(static_cast<std::size_t>(about.st_size) + piece);
  for (;;) {
    const std::size_t before = bytes.size();
    bytes.resize(before + piece);
    const ssize_t count = ::read(file.number, bytes.data() + before, piece);
    const int reason = errno;
    bytes.resize(before + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    if (count < 0 && reason != EINTR) return fail(of_system(reason));
    if (count == 0) return bytes;
    if (piped && 2 * static_cast<double>(bytes.size()) > available) return too_large(static_cast<double>(bytes.size()));
  }
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
  std::string fault;
  std::string bytes = read_bytes(path, fault);
  if (!fault.empty()) throw FileError(path.string() + ": cannot be read: " + fault);
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
