#include "storage/atomic_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "folder.hpp"
#include "grit/error.hpp"

namespace grit::atomic_file_tests {
namespace {

std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename());
  return names;
}

TEST(AtomicFile, LeavesNothingBesideItWhereItCannotBeReplaced) {
  const OwnFolder folder;
  const auto taken = folder / "run.json";
  std::filesystem::create_directory(taken);
  for (const auto write : {write_atomically, write_beside_others, write_new}) {
    EXPECT_THROW(write(taken, "text"), FileError);
    EXPECT_THAT(names_in(folder.path()), testing::ElementsAre("run.json"));
  }
}

TEST(AtomicFile, LeavesOthersOfTheNameOfATemporaryFile) {
  const OwnFolder folder;
  for (const char* name : {"page.html", "page.html.part", "page.html.part2"}) std::ofstream(folder / name) << "old";
  EXPECT_EQ(free_temporary_path(folder / "page.html"), folder / "page.html.part3");
  write_beside_others(folder / "page.html", "new");
  const auto text = [&](const char* name) {
    std::ifstream file(folder / name);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  EXPECT_EQ(text("page.html"), "new");
  EXPECT_EQ(text("page.html.part"), "old");
  EXPECT_EQ(text("page.html.part2"), "old");
  EXPECT_EQ(names_in(folder.path()).size(), 3u);
}

TEST(AtomicFile, DoesNotReplaceAPipe) {
  const OwnFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  try {
    write_atomically(folder / "pipe", "text");
    FAIL();
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), testing::EndsWith("pipe: is a device, a pipe or a socket; give the name of a file"));
  }
  EXPECT_TRUE(std::filesystem::is_fifo(folder / "pipe"));
  EXPECT_THAT(names_in(folder.path()), testing::ElementsAre("pipe"));
}

}  // namespace
}  // namespace grit::atomic_file_tests
