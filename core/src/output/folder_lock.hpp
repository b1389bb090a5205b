// Keeps a folder for one program at a time.
#pragma once

#include <filesystem>

namespace grit {

/// A lock on an existing folder; nothing is written. Child processes inherit it, so that it lasts as long as any of
/// them that does not leave() it; the system releases it when they end or are killed. On a file system without locks it
/// is always granted.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// Whether the lock was acquired.
  bool held() const { return held_; }
  /// In a child process: gives up its part of the lock.
  void leave() const;

 private:
  int folder_;
  bool held_;
};

}  // namespace grit
