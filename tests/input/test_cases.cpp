// Kernel and schema accept every file in good/. Both refuse every file in bad/; the kernel with the texts expected in
// the comment of the file. Only the kernel refuses files in bad/beyond_schema/.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "components.hpp"
#include "input/schema.hpp"
#include "schema_check.hpp"

using namespace grit;
namespace fs = std::filesystem;

namespace {

const fs::path here = fs::path(GRIT_SOURCE_DIR) / "tests/input";

std::vector<fs::path> files(const std::string& folder) {
  std::vector<fs::path> all;
  for (const auto& entry : fs::directory_iterator(here / folder))
    if (entry.path().extension() == ".json") all.push_back(entry.path());
  std::ranges::sort(all);
  return all;
}
std::string name(const testing::TestParamInfo<fs::path>& info) { return info.param.stem().string(); }

const Registry& registry() {
  static Registry instance({});
  static const bool filled = (add_components(instance), true);
  static_cast<void>(filled);
  return instance;
}
const SchemaCheck& schema() {
  static const SchemaCheck check(scene_schema(registry()));
  return check;
}

void expect_refusal(const fs::path& file) {
  std::ifstream stream(file);
  const auto expected = Description::parse(stream).at("//").at("expect");
  ASSERT_FALSE(expected.empty());
  const std::string refusal = kernel_refusal(file, registry());
  for (const auto& text : expected) EXPECT_THAT(refusal, testing::HasSubstr(text.get<std::string>()));
}

class Good : public testing::TestWithParam<fs::path> {};
class Bad : public testing::TestWithParam<fs::path> {};
class BeyondSchema : public testing::TestWithParam<fs::path> {};

}  // namespace

TEST_P(Good, IsAcceptedByTheKernel) { EXPECT_EQ(kernel_refusal(GetParam(), registry()), ""); }
TEST_P(Good, IsAcceptedByTheSchema) { EXPECT_EQ(schema().refusal(GetParam()), ""); }
TEST_P(Bad, IsRefusedByTheKernel) { expect_refusal(GetParam()); }
TEST_P(Bad, IsRefusedByTheSchema) { EXPECT_NE(schema().refusal(GetParam()), ""); }
TEST_P(BeyondSchema, IsRefusedByTheKernel) { expect_refusal(GetParam()); }
TEST_P(BeyondSchema, IsAcceptedByTheSchema) { EXPECT_EQ(schema().refusal(GetParam()), ""); }

INSTANTIATE_TEST_SUITE_P(Input, Good, testing::ValuesIn(files("good")), name);
INSTANTIATE_TEST_SUITE_P(Input, Bad, testing::ValuesIn(files("bad")), name);
INSTANTIATE_TEST_SUITE_P(Input, BeyondSchema, testing::ValuesIn(files("bad/beyond_schema")), name);
