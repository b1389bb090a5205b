#include "storage/parsed_json.hpp"

#include <gtest/gtest.h>

namespace grit::parsed_json_tests {
namespace {

std::string nested(std::size_t levels) { return std::string(levels, '[') + std::string(levels, ']'); }

TEST(Json, IsReadUpToAHundredLevels) {
  EXPECT_EQ(parsed_json(R"({"a": [1, 2.5, "x"]})").dump(), R"({"a":[1,2.5,"x"]})");
  EXPECT_EQ(parsed_json(nested(100)).dump(), nested(100));
  const std::string objects = std::string(99, '[') + R"({"a":1})" + std::string(99, ']');
  EXPECT_EQ(parsed_json(objects).dump(), objects);
  EXPECT_TRUE(parsed_json('[' + objects + ']').is_discarded());
  EXPECT_TRUE(parsed_json(nested(101)).is_discarded());
  EXPECT_TRUE(parsed_json(nested(1'000'000)).is_discarded());
  EXPECT_TRUE(parsed_json(std::string(1'000'000, '[')).is_discarded());
  EXPECT_TRUE(parsed_json("{\"a\": ").is_discarded());
  EXPECT_TRUE(parsed_json("").is_discarded());
}

}  // namespace
}  // namespace grit::parsed_json_tests
