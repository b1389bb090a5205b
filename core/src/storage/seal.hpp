// The seal of a complete file: a checksum over all of it, so that no damaged byte reaches a library that trusts files.
#pragma once

#include <filesystem>

namespace grit {

/// Appends the length and the CRC-32 of a file to it, as its last line. HDF5 ignores what follows its data. The file is
/// on disk before the seal is, so that no seal outlives what it vouches for; and the seal is on disk on return. Throws
/// FileError.
void seal(const std::filesystem::path& path);

/// Whether a file is sealed. One without a seal is still being written, or its writer was killed. Throws FileError if
/// it was changed since it was sealed.
bool is_sealed(const std::filesystem::path& path);

/// Removes the seal, if there is one, before the file is changed. Throws FileError as is_sealed() does; the file then
/// stays as it is.
void unseal(const std::filesystem::path& path);

}  // namespace grit
