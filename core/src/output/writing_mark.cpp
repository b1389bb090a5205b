#include "output/writing_mark.hpp"

#include <fcntl.h>
#include <unistd.h>

#include "storage/atomic_file.hpp"

namespace grit {
namespace {

/// A lock on the whole file, held by the open file description, not by the process: else closing any other descriptor
/// of the file would release it.
struct flock whole_file(short type) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  return lock;
}

void put(int file, short type) {
  const auto lock = whole_file(type);
  static_cast<void>(::fcntl(file, F_OFD_SETLK, &lock));
}

}  // namespace

WritingMark::WritingMark(const std::filesystem::path& file, Absent absent)
    : file_(::open(file.c_str(), O_RDWR | O_CLOEXEC | (absent == Absent::make ? O_CREAT : 0), 0666)) {
  set();
}

WritingMark::~WritingMark() {
  if (file_ >= 0) ::close(file_);
}

void WritingMark::set() const { put(file_, F_WRLCK); }
void WritingMark::clear() const { put(file_, F_UNLCK); }

bool WritingMark::is_of(const std::filesystem::path& file) const { return file_ < 0 || is_still_at(file, file_); }

bool is_being_written(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  auto lock = whole_file(F_RDLCK);
  const bool known = ::fcntl(file, F_OFD_GETLK, &lock) == 0;
  ::close(file);
  return known && lock.l_type != F_UNLCK;
}

}  // namespace grit
