#include "format/resources.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "support/own_folder.hpp"

namespace grit::resources_tests {
namespace {

TEST(Resources, AreKnown) {
  EXPECT_GT(available_memory(), 1e6);
  EXPECT_TRUE(std::isfinite(available_memory()));
  EXPECT_GT(peak_memory(), 1e6);
  const OwnFolder folder;
  EXPECT_GT(available_disk(folder.path()), 0);
  EXPECT_TRUE(std::isfinite(available_disk(folder / "not/yet/there")));
}

TEST(Resources, AreNoMoreThanTheAddressSpaceAllows) {
  const pid_t child = ::fork();
  if (child == 0) {
    constexpr double more = 1e8;
    double pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const auto limit = static_cast<rlim_t>(pages * static_cast<double>(::sysconf(_SC_PAGESIZE)) + more);
    const rlimit both{limit, limit};
    if (::setrlimit(RLIMIT_AS, &both) != 0) ::_exit(2);
    ::_exit(available_memory() <= more ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(Resources, AreReadable) {
  EXPECT_EQ(bytes_text(0), "0 bytes");
  EXPECT_EQ(bytes_text(999), "999 bytes");
  EXPECT_EQ(bytes_text(16720), "16.7 kB");
  EXPECT_EQ(bytes_text(999.6e6), "1 GB");
  EXPECT_EQ(bytes_text(10.9e9), "10.9 GB");
  EXPECT_EQ(bytes_text(2.8e12), "2.8 TB");
  EXPECT_EQ(bytes_text(7e17), "700 PB");
  EXPECT_EQ(bytes_text(1e30), "1e+15 PB");
}

}  // namespace
}  // namespace grit::resources_tests
