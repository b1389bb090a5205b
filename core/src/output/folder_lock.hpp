// Keeps a folder for one program at a time.
#pragma once

#include <filesystem>

namespace grit {

/// A lock on a folder that is there; nothing is written. Programs that this one starts have it too, so that it lasts as
/// long as any of them: the system takes it off those that end or are killed. Where a file system knows no such locks,
/// it is never refused.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// Whether nobody else had it.
  bool held() const { return held_; }

 private:
  int folder_;
  bool held_;
};

}  // namespace grit
