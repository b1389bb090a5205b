#include "report/packed.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <numeric>

#include "results.hpp"

namespace grit::packed_tests {
namespace {

using testing::ElementsAre;

TEST(Packed, IsRestoredAtAnyLength) {
  for (std::size_t length = 0; length < 70; ++length) {
    std::vector<std::uint8_t> bytes(length);
    for (std::size_t i = 0; i < length; ++i) bytes[i] = static_cast<std::uint8_t>(i * 37 + length);
    EXPECT_EQ(unpacked(packed(std::as_bytes(std::span(bytes)))), std::string(bytes.begin(), bytes.end())) << length;
  }
}

TEST(Packed, IsShortWhereNumbersAreAlike) {
  const std::vector<std::byte> zeros(100'000);
  EXPECT_LT(packed(zeros).size(), 1000u);
}

TEST(BytePlanes, HoldLowBytesFirst) {
  const std::vector<std::uint16_t> numbers{0x1234, 0xff00, 0x00ff};
  EXPECT_THAT(byte_planes(numbers), ElementsAre(std::byte{0x34}, std::byte{0}, std::byte{0xff}, std::byte{0x12},
                                                std::byte{0xff}, std::byte{0}));
}

TEST(Quantised, IsTheNearestOf65536) {
  EXPECT_EQ(quantised(-1, -1, 1), 0);
  EXPECT_EQ(quantised(1, -1, 1), 65535);
  EXPECT_EQ(quantised(0.25, 0, 1), 16384);
  EXPECT_EQ(quantised(2, -1, 1), 65535) << "outside";
  EXPECT_EQ(quantised(-2, -1, 1), 0) << "outside";
  EXPECT_EQ(quantised(std::numeric_limits<double>::infinity(), 0, 1), 65535);
  EXPECT_EQ(quantised(std::numeric_limits<double>::quiet_NaN(), 0, 1), 0);
  EXPECT_EQ(quantised(3, 3, 3), 0) << "no range";
}

TEST(DataElements, AreNumbered) {
  DataElements data;
  EXPECT_EQ(data.add_numbers<float>(std::vector<float>{1, 2}), 0u);
  EXPECT_EQ(data.add_numbers<float>(std::vector<float>{3}), 1u);
  EXPECT_THAT(numbers_of<float>(data.html(), 0), ElementsAre(1, 2));
  EXPECT_THAT(numbers_of<float>(data.html(), 1), ElementsAre(3));
}

TEST(DataElements, KeepTheNumbersOfEqualData) {
  DataElements first;
  first.add_numbers<float>(std::vector<float>{1, 2});
  first.add_numbers<float>(std::vector<float>{3});
  DataElements second = first.next();
  EXPECT_GT(second.end(), first.end()) << "two states differ even without new data";
  EXPECT_EQ(second.add_numbers<float>(std::vector<float>{3}), 1u);
  EXPECT_GE(second.add_numbers<float>(std::vector<float>{4}), first.end());
  EXPECT_EQ(second.texts().size(), 2u);
  DataElements third = second.next();
  EXPECT_GE(third.add_numbers<float>(std::vector<float>{1, 2}), second.end())
      << "a number of the first one is not reused";
}

}  // namespace
}  // namespace grit::packed_tests
