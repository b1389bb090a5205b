// Text files that a description names: their lines and numbers, and pieces of them in messages.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace grit {

/// The bytes of a file. If it cannot be read, `fault` says why, e.g. "No such file or directory". Files that a
/// description names are read by this function only: a regular file, or what is piped into the program as /dev/stdin;
/// no device, no named pipe, and nothing that is larger than the memory that is available.
std::string read_bytes(const std::filesystem::path& path, std::string& fault);

/// Whether bytes begin with a byte-order mark of UTF-16.
bool is_utf16(std::string_view bytes);

/// Text whose lines end in `\n`, from text whose lines end in `\n`, `\r\n` or `\r`. A byte-order mark of UTF-8 is
/// removed. Throws FileError for UTF-16; `name` is that of the file.
std::string plain_text(std::string bytes, const std::string& name);

/// The plain text of a file. Throws FileError "PATH: cannot be read: REASON", or for UTF-16.
std::string read_text(const std::filesystem::path& path);

/// A number in a text, or the reason why there is none.
struct WrittenNumber {
  double value = 0;
  std::string_view fault;  ///< e.g. "not a number"; empty for a number
};

/// Reads a word that is one number, in any locale: sign, digits, decimal point, exponent; or inf, nan. A number that is
/// too small for double precision becomes 0, one that is too large is a fault.
WrittenNumber parse_number(std::string_view word);

/// Text for a message: bytes of control characters, of invisible ones and of no UTF-8 become `\x00`. Longer texts than
/// `most` characters are cut.
std::string visible_text(std::string_view text, std::size_t most = std::string_view::npos);

/// The same in quotation marks.
std::string quoted_excerpt(std::string_view text, std::size_t most = 40);

}  // namespace grit
