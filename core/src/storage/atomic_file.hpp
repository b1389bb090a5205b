// Atomic replacement of files: a reader finds the old file or the complete new one, even if the writer is killed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

namespace grit {

/// The temporary file that is renamed to `path`: in the same folder, so that the rename is atomic.
std::filesystem::path temporary_path(const std::filesystem::path& path);

/// The same where others have files, too: under a name that nothing has yet.
std::filesystem::path free_temporary_path(const std::filesystem::path& path);

/// Renames the temporary file to `path`, or removes it and throws FileError.
void publish(const std::filesystem::path& path);
void publish(const std::filesystem::path& temporary, const std::filesystem::path& path);

/// The same, but another file of this name is kept, and an error.
void publish_new(const std::filesystem::path& path);

/// By which a file is known: it differs if the file was replaced or changed. None without the file.
struct FileStamp {
  std::uint64_t device = 0, number = 0, size = 0;
  std::int64_t seconds = 0, nanoseconds = 0;  ///< of the last change
  bool operator==(const FileStamp&) const = default;
};
std::optional<FileStamp> file_stamp(const std::filesystem::path& path);

/// Returns when a file is on disk and survives a crash of the machine. Throws FileError.
void sync_to_disk(const std::filesystem::path& path);

/// Returns when all that was written to the file system of a folder is on disk: faster than sync_to_disk() for many
/// files. Throws FileError.
void sync_file_system(const std::filesystem::path& folder);

/// Whether an open file is that of this path: it may have been removed or replaced.
bool is_still_at(const std::filesystem::path& path, int file);

/// Returns when the names of the files in a folder are on disk. Throws FileError; file systems that cannot do it are no
/// error.
void sync_folder(const std::filesystem::path& folder);

/// Writes a temporary file and renames it. Throws FileError with the system's reason; the old file then stays.
void write_atomically(const std::filesystem::path& path, std::string_view text);
/// The same where others have files, too: no other file is lost, also none of the name of the temporary one.
void write_beside_others(const std::filesystem::path& path, std::string_view text);
/// As write_atomically(), but another file of this name is kept, and an error.
void write_new(const std::filesystem::path& path, std::string_view text);

/// The path of an empty file of its own in the folder for temporary files; removed in the end.
class ScratchFile {
 public:
  /// Throws FileError.
  ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ~ScratchFile();
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace grit
