// Checksums of whole files.
#pragma once

#include <cstdint>
#include <filesystem>

namespace grit {

/// CRC-32 of a file; that of no bytes if it cannot be read.
std::uint32_t file_checksum(const std::filesystem::path& path);

}  // namespace grit
