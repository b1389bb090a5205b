#include "storage/file_checksum.hpp"

#include <array>
#include <boost/crc.hpp>
#include <fstream>

namespace grit {

std::uint32_t file_checksum(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  boost::crc_32_type sum;
  std::array<char, 1 << 16> part{};
  do {
    file.read(part.data(), part.size());
    sum.process_bytes(part.data(), static_cast<std::size_t>(file.gcount()));
  } while (file);
  return sum.checksum();
}

}  // namespace grit
