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

TEST(FolderLocks, AreLeftByChildProcessesThatDoNotNeedThem) {
  const OwnFolder folder;
  std::optional<FolderLock> lock(folder.path());
  int left[2], ended[2];
  ASSERT_EQ(::pipe(left) + ::pipe(ended), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(ended[1]);
    lock->leave();
    char word = '!';
    const bool told = ::write(left[1], &word, 1) == 1;
    ::_exit(told && ::read(ended[0], &word, 1) == 0 ? 0 : 1);  // until the parent closes its end
  }
  char word;
  ASSERT_EQ(::read(left[0], &word, 1), 1);
  EXPECT_FALSE(FolderLock(folder.path()).held()) << "the parent still has it";
  lock.reset();
  EXPECT_TRUE(FolderLock(folder.path()).held());
  ::close(ended[1]);
  int status = 1;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace grit::folder_lock_tests
