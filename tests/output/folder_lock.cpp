#include "output/folder_lock.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "support/program.hpp"

namespace grit::folder_lock_tests {
namespace {

TEST(FolderLocks, AreHeldByOneAtATime) {
  const OwnFolder folder;
  std::optional<FolderLock> first(folder.path());
  EXPECT_TRUE(first->held());
  EXPECT_FALSE(FolderLock(folder.path()).held());
  first.reset();
  EXPECT_TRUE(FolderLock(folder.path()).held());
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(FolderLocks, LastAsLongAsChildProcesses) {
  const OwnFolder folder;
  std::optional<FolderLock> lock(folder.path());
  std::optional<Program> started(std::in_place, std::vector<std::string>{"sleep", "1000"}, folder.path());
  lock.reset();
  EXPECT_FALSE(FolderLock(folder.path()).held());
  started->interrupt();
  started->finish();
  EXPECT_TRUE(FolderLock(folder.path()).held());
}

}  // namespace
}  // namespace grit::folder_lock_tests
