#include "storage/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>

#include "grit/error.hpp"

namespace grit {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, int code) {
  throw FileError(path.string() + ": cannot write: " + std::strerror(code));
}

}  // namespace

std::filesystem::path temporary_path(const std::filesystem::path& path) {
  auto temporary = path;
  temporary += ".part";
  return temporary;
}

std::filesystem::path free_temporary_path(const std::filesystem::path& path) {
  auto temporary = temporary_path(path);
  for (int number = 2; file_stamp(temporary); ++number)
    temporary = temporary_path(path).string() + std::to_string(number);
  return temporary;
}

void publish(const std::filesystem::path& path) { publish(temporary_path(path), path); }

void publish(const std::filesystem::path& temporary, const std::filesystem::path& path) {
  std::error_code error, ignored;
  const auto found = std::filesystem::symlink_status(path, ignored).type();
  const bool is_special = found == std::filesystem::file_type::character ||
                          found == std::filesystem::file_type::block || found == std::filesystem::file_type::fifo ||
                          found == std::filesystem::file_type::socket;
  if (!is_special) {
    std::filesystem::rename(temporary, path, error);
    if (!error) return;
  }
  std::filesystem::remove(temporary, ignored);
  throw FileError(path.string() + (is_special ? ": is a device, a pipe or a socket; give the name of a file"
                                              : ": cannot replace the file: " + error.message()));
}

void publish_new(const std::filesystem::path& path) {
  const auto temporary = temporary_path(path);
  if (::renameat2(AT_FDCWD, temporary.c_str(), AT_FDCWD, path.c_str(), RENAME_NOREPLACE) == 0) return;
  int error = errno;
  if (error == EINVAL || error == ENOSYS) {  // unknown to this file system
    if (!file_stamp(path)) return publish(path);
    error = EEXIST;
  }
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
  throw FileError(path.string() + ": cannot create it: " + std::strerror(error) +
                  (error == EEXIST ? "; grit does not replace a file that it did not write: move it away" : ""));
}

std::optional<FileStamp> file_stamp(const std::filesystem::path& path) {
  struct stat file {};
  if (::lstat(path.c_str(), &file) != 0) return std::nullopt;
  return FileStamp{file.st_dev, file.st_ino, static_cast<std::uint64_t>(file.st_size), file.st_mtim.tv_sec,
                   file.st_mtim.tv_nsec};
}

void sync_to_disk(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool done = file >= 0 && ::fsync(file) == 0;
  const int error = errno;
  if (file >= 0) ::close(file);
  if (!done) fail(path, error);
}

void sync_file_system(const std::filesystem::path& folder) {
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const bool done = file >= 0 && ::syncfs(file) == 0;
  const int error = errno;
  if (file >= 0) ::close(file);
  if (!done) fail(folder, error);
}

bool is_still_at(const std::filesystem::path& path, int file) {
  struct stat opened {
  }, found{};
  return ::fstat(file, &opened) == 0 && ::stat(path.c_str(), &found) == 0 && opened.st_dev == found.st_dev &&
         opened.st_ino == found.st_ino;
}

void sync_folder(const std::filesystem::path& folder) {
  const int file = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const bool done = file >= 0 && (::fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP || errno == EBADF);
  const int error = errno;
  if (file >= 0) ::close(file);
  if (!done) fail(folder, error);
}

namespace {

/// `mode`: of fopen().
void write_temporary(const std::filesystem::path& temporary, const std::filesystem::path& path, std::string_view text,
                     const char* mode) {
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(temporary.c_str(), mode), std::fclose);
  if (!file) fail(path, errno);
  // Removes the incomplete file that a full disk leaves.
  const auto give_up = [&](int error) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    fail(path, error);
  };
  if (std::fwrite(text.data(), 1, text.size(), file.get()) != text.size()) give_up(errno);
  if (std::fclose(file.release()) != 0) give_up(errno);
}

}  // namespace

void write_atomically(const std::filesystem::path& path, std::string_view text) {
  write_temporary(temporary_path(path), path, text, "wb");
  publish(path);
}

void write_beside_others(const std::filesystem::path& path, std::string_view text) {
  const auto temporary = free_temporary_path(path);
  write_temporary(temporary, path, text, "wbx");  // which another process may have made now
  publish(temporary, path);
}

void write_new(const std::filesystem::path& path, std::string_view text) {
  write_temporary(temporary_path(path), path, text, "wb");
  publish_new(path);
}

ScratchFile::ScratchFile() {
  std::string name = (std::filesystem::temp_directory_path() / "grit-XXXXXX").string();
  const int file = ::mkostemp(name.data(), O_CLOEXEC);
  if (file < 0) fail(name, errno);
  ::close(file);
  path_ = name;
}

ScratchFile::~ScratchFile() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

}  // namespace grit
