#include "format/base64.hpp"

#include <gtest/gtest.h>

#include <string>

namespace grit {
namespace {

std::string encoded(const std::string& text) { return base64({text.begin(), text.end()}); }

// The test vectors of RFC 4648.
TEST(Base64, PadsTheEnd) {
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foob"), "Zm9vYg==");
  EXPECT_EQ(encoded("fooba"), "Zm9vYmE=");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

TEST(Base64, HasTheLettersOfAllBytes) { EXPECT_EQ(base64({0xfb, 0xef, 0xff, 0x00}), "++//AA=="); }

}  // namespace
}  // namespace grit
