// Tells processes that read a file that it is being changed in place.
#pragma once

#include <filesystem>

namespace grit {

/// A lock on the file that readers ask for and never take: so none keeps the writer waiting, and the system takes it
/// off a writer that is killed. Where a file system knows no such locks, it says nothing.
class WritingMark {
 public:
  enum class Absent { leave, make };
  /// Sets the mark. A file that is not there is made, or left to who opens it to complain about.
  WritingMark(const std::filesystem::path& file, Absent absent);
  ~WritingMark();
  WritingMark(const WritingMark&) = delete;
  WritingMark& operator=(const WritingMark&) = delete;

  void set() const;
  void clear() const;

 private:
  int file_;
};

/// Whether a writer has its mark on the file.
bool is_being_written(const std::filesystem::path& file);

}  // namespace grit
