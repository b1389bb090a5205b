// The code for GPUs that nvcc makes of contact laws, by the report of its assembler.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <regex>
#include <string>

#include "support/own_folder.hpp"
#include "support/program.hpp"
#include "support/scene.hpp"

namespace grit::test::gpu_code_tests {
namespace {

class GpuCode : public testing::TestWithParam<std::string> {};

TEST_P(GpuCode, NeitherSpillsNorLeavesFunctionsOut) {
  Description d = description(GetParam(), {{"density", 2600}}, {{{0, 0, 0}, 1e-3}});
  const Started started(scene_of(d));
  const auto on_device = started.live.components().law->device();
  ASSERT_TRUE(on_device);
  if (on_device->ptx.empty()) GTEST_SKIP() << "built without nvcc";
  const std::string ptx(on_device->ptx.data());
  EXPECT_THAT(ptx, testing::Not(testing::HasSubstr("trap;"))) << "a function of the law is not constexpr";
  OwnFolder folder;
  folder.write("law.ptx", ptx);
  const auto report = shell(folder.path(), "PATH=$PATH:/usr/local/cuda/bin ptxas -v -arch=sm_90 -o law.cubin law.ptx");
  if (report.status == 127) GTEST_SKIP() << "there is no ptxas";
  ASSERT_EQ(report.status, 0) << report.err;
  std::smatch found;
  ASSERT_TRUE(std::regex_search(report.err, found, std::regex("(\\d+) bytes spill stores, (\\d+) bytes spill loads")));
  EXPECT_EQ(found[1], "0");
  EXPECT_EQ(found[2], "0");
  ASSERT_TRUE(std::regex_search(report.err, found, std::regex("Used (\\d+) registers")));
  EXPECT_LE(std::stoi(found[1]), 136) << "three blocks of 128 threads fit a multiprocessor";
  RecordProperty("registers", std::stoi(found[1]));
}

INSTANTIATE_TEST_SUITE_P(Laws, GpuCode,
                         testing::Values("capillary", "hertz-mindlin", "jkr", "linear-cohesive", "linear-frictional",
                                         "linear-rolling"),
                         [](const auto& one) { return std::regex_replace(one.param, std::regex("-"), "_"); });

}  // namespace
}  // namespace grit::test::gpu_code_tests
