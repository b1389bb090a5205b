#include "format/message.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>
#include <string>

namespace grit::message_tests {
namespace {

template <class Act>
std::string message_after(Act act) {
  try {
    act();
  } catch (const std::exception& error) {
    return message_of(error);
  }
  return "";
}

TEST(Message, OfTheFileSystemHasTheFormOfAllOthers) {
  EXPECT_EQ(message_after([] { std::filesystem::create_directories("/dev/null/folder"); }),
            "/dev/null/folder: cannot create directories: Not a directory; remove the cause, or give another path");
  const std::string name(300, 'a');
  EXPECT_EQ(message_after([&] { static_cast<void>(std::filesystem::exists(name)); }),
            name + ": cannot examine it: File name too long; remove the cause, or give another path");
}

TEST(Message, OfOtherErrorsIsTheirOwn) {
  EXPECT_EQ(message_after([] { throw std::runtime_error("a: found 1"); }), "a: found 1");
}

}  // namespace
}  // namespace grit::message_tests
