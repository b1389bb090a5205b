#include "storage/seal.hpp"

#include <spdlog/fmt/fmt.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <ios>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "grit/error.hpp"
#include "storage/atomic_file.hpp"

namespace grit {
namespace {

constexpr std::string_view seal_mark = "\ngrit seal ";
constexpr std::size_t seal_length = seal_mark.size() + 16 + 1 + 8 + 1;

std::string seal_text(std::uint64_t length, unsigned long checksum) {
  return fmt::format("{}{:016x} {:08x}\n", seal_mark, length, checksum);
}

/// CRC-32 of the first `length` bytes.
unsigned long checksum_of(std::ifstream& file, std::uint64_t length, const std::filesystem::path& path) {
  constexpr std::uint64_t piece = std::uint64_t{1} << 20;
  std::string buffer(static_cast<std::size_t>(std::min(piece, length)), '\0');
  unsigned long checksum = crc32_z(0, nullptr, 0);
  file.clear(), file.seekg(0);
  for (std::uint64_t left = length; left > 0;) {
    const auto size = static_cast<std::size_t>(std::min(piece, left));
    if (!file.read(buffer.data(), static_cast<std::streamsize>(size)))
      throw FileError(path.string() + ": cannot read: its length changed, or the disk has a fault");
    checksum = crc32_z(checksum, reinterpret_cast<const Bytef*>(buffer.data()), size);
    left -= size;
  }
  return checksum;
}

/// The end of a file, if it is that of a sealed one.
std::optional<std::string> end_of(std::ifstream& file, std::uint64_t length) {
  if (length < seal_length) return std::nullopt;
  std::string end(seal_length, '\0');
  file.seekg(static_cast<std::streamoff>(length - seal_length));
  if (!file.read(end.data(), static_cast<std::streamsize>(end.size())) || !end.starts_with(seal_mark))
    return std::nullopt;
  return end;
}

}  // namespace

void seal(const std::filesystem::path& path) {
  sync_to_disk(path);
  std::error_code error;
  const std::uint64_t length = std::filesystem::file_size(path, error);
  if (error) throw FileError(path.string() + ": cannot read: " + error.message());
  std::ifstream written(path, std::ios::binary);
  const std::string text = seal_text(length, checksum_of(written, length, path));
  // Not a new file, if this one has been removed.
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out | std::ios::ate);
  file << text;
  file.close();
  if (!file) throw FileError(path.string() + ": cannot write: the disk is full, or the file cannot be changed");
  sync_to_disk(path);
}

bool is_sealed(const std::filesystem::path& path) {
  std::error_code missing;
  if (!std::filesystem::is_regular_file(path, missing)) return false;
  const std::uint64_t length = std::filesystem::file_size(path, missing);
  std::ifstream file(path, std::ios::binary);
  if (missing || !file) return false;
  const auto end = end_of(file, length);
  if (!end) return false;
  if (*end != seal_text(length - seal_length, checksum_of(file, length - seal_length, path)))
    throw FileError(path.string() + ": is damaged, or was changed by another program: its checksum differs");
  return true;
}

void unseal(const std::filesystem::path& path) {
  if (!is_sealed(path)) return;
  std::error_code error;
  const std::uint64_t length = std::filesystem::file_size(path, error);
  if (!error) std::filesystem::resize_file(path, length - seal_length, error);
  if (error) throw FileError(path.string() + ": cannot write: " + error.message());
}

}  // namespace grit
