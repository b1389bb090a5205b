// A text file that is either the old one or the whole new one, whenever its writer is killed.
#pragma once

#include <filesystem>
#include <string_view>

namespace grit {

/// Where a file is written before it is renamed to `path`: beside it, so that the rename is atomic.
std::filesystem::path beside(const std::filesystem::path& path);

/// Renames what was written beside. Throws FileError.
void publish(const std::filesystem::path& path);

/// Returns when a file is on the disk itself, and so outlives the machine. Throws FileError.
void sync_to_disk(const std::filesystem::path& path);

/// Writes beside and publishes. Throws FileError with the system's reason; what was there stays.
void write_atomically(const std::filesystem::path& path, std::string_view text);

}  // namespace grit
