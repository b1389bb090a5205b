// Marks a file that is being changed in place, for its readers.
#pragma once

#include <filesystem>

namespace grit {

/// A lock on the file that readers query but never take, so that they never block the writer. The system releases it if
/// the writer is killed. It has no effect on file systems without such locks.
class WritingMark {
 public:
  enum class Absent { leave, make };
  /// Sets the mark. A missing file is created, or left missing for the error when it is opened.
  WritingMark(const std::filesystem::path& file, Absent absent);
  ~WritingMark();
  WritingMark(const WritingMark&) = delete;
  WritingMark& operator=(const WritingMark&) = delete;

  void set() const;
  void clear() const;
  /// Whether its file is still that of this path; true if it could not be opened.
  bool is_of(const std::filesystem::path& file) const;

 private:
  int file_;
};

/// Whether a writer has marked the file.
bool is_being_written(const std::filesystem::path& file);

}  // namespace grit
