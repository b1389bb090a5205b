// checkpoint.h5: damaged or foreign files are never read.
#include "output/checkpoint.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "folder.hpp"
#include "grit/error.hpp"
#include "storage/hdf5.hpp"
#include "storage/seal.hpp"

namespace grit::checkpoint_tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class CheckpointFile : public testing::Test {
 protected:
  CheckpointFile() {
    std::ofstream(folder_ / "strain.so") << "a plugin";
    facts_.description = {{"title", "sand"},
                          {"walls", {{"lid", {{"pressure", 1e5}}}}},
                          {"low", -1.0 / 0.0},
                          {"output", {{"checkpoint_every", 600}}}};
    facts_.plugins = {{"probe", "strain", "1.0.0", folder_ / "strain.so", build_tag()}};
    checkpoint_ = {"shear", 0.25, 1000, {}};
    for (int i = 0; i < 3'000'000; ++i) checkpoint_.state.push_back(static_cast<std::byte>(i * i % 251));
    write_checkpoint(path_, facts_, checkpoint_);
  }
  template <class Kind>
  std::string refusal() const {
    return error_of<Kind>([this] { read_checkpoint(path_, facts_); });
  }
  /// Writes one with other facts, as from another build.
  void rewrite(const std::string& facts, std::uint64_t format = 6) const {
    hdf5::File file(path_, hdf5::Mode::write_whole);
    file.set_attribute("format", format);
    file.set_attribute("stage", "shear");
    file.set_attribute("time", 0.25);
    file.set_attribute("step", std::uint64_t{1000});
    file.write("facts", std::as_bytes(std::span(facts)));
    file.write("state", checkpoint_.state);
    file.close();
    seal(path_);
  }
  std::string facts_text() const {
    const auto bytes = hdf5::File(path_, hdf5::Mode::read).dataset("facts").read_bytes();
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  Folder folder_;
  std::filesystem::path path_ = folder_ / "checkpoint.h5";
  RunFacts facts_;
  Checkpoint checkpoint_;
};

TEST_F(CheckpointFile, ReadsBackWhatWasWritten) {
  const Checkpoint back = read_checkpoint(path_, facts_);
  EXPECT_EQ(back.stage, "shear");
  EXPECT_EQ(back.time, 0.25);
  EXPECT_EQ(back.step, 1000u);
  EXPECT_TRUE(back.state == checkpoint_.state);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "checkpoint.h5.part"));
  facts_.description["output"]["checkpoint_every"] = 5;
  EXPECT_NO_THROW(read_checkpoint(path_, facts_)) << "the interval of checkpoints does not matter";
}

TEST_F(CheckpointFile, IsReplacedOnlyByACompleteOne) {
  std::filesystem::create_directory(folder_ / "checkpoint.h5.part");  // so that it cannot be written
  checkpoint_.step = 2000;
  EXPECT_NE(error_of<FileError>([this] { write_checkpoint(path_, facts_, checkpoint_); }), "");
  EXPECT_EQ(read_checkpoint(path_, facts_).step, 1000u);
}

TEST_F(CheckpointFile, OfAnotherDescriptionIsRefused) {
  facts_.description["walls"]["lid"]["pressure"] = 2e5;
  facts_.description["seed"] = 3;
  EXPECT_THAT(refusal<Error>(), AllOf(HasSubstr("checkpoint.h5: is of another description"),
                                      HasSubstr("\n  /walls/lid/pressure: found 200000.0, allowed 100000.0"),
                                      HasSubstr("\n  /seed: found 3, which the run does not have"),
                                      HasSubstr("start again (--overwrite)")));
}

TEST_F(CheckpointFile, OfAnotherBuildOfAPluginIsRefused) {
  std::ofstream(folder_ / "strain.so", std::ios::app) << ", built again";
  EXPECT_THAT(refusal<PluginError>(), AllOf(HasSubstr("written with other builds of plugins"),
                                            HasSubstr("/probe strain/build/checksum: found ")));
  facts_.plugins[0].version = "1.1.0";
  EXPECT_THAT(refusal<PluginError>(), HasSubstr("/probe strain/version: found \"1.1.0\", allowed \"1.0.0\""));
  facts_.plugins.clear();
  EXPECT_THAT(refusal<PluginError>(), HasSubstr("/probe strain: missing; the run has {"));
}

TEST_F(CheckpointFile, OfAnotherGritIsRefused) {
  std::string facts = facts_text();
  const auto at = facts.find("\"compiler\":\"") + 12;
  facts[at] = facts[at] == 'x' ? 'y' : 'x';
  rewrite(facts);
  EXPECT_THAT(refusal<FileError>(),
              AllOf(HasSubstr("checkpoint.h5: was written by another grit"), HasSubstr("/compiler: found ")));
  rewrite(facts_text(), 1);
  EXPECT_THAT(refusal<FileError>(), HasSubstr("checkpoint.h5: found format 1, allowed 6"));
  rewrite(R"({"grit": {}, "plugins": {}, "description": )" + std::string(8000, '[') + std::string(8000, ']') + '}');
  EXPECT_THAT(refusal<FileError>(), HasSubstr("its facts are not JSON")) << "too deep to be copied";
  rewrite("{");
  EXPECT_THAT(refusal<FileError>(), HasSubstr("its facts are not JSON"));
}

TEST_F(CheckpointFile, WithAnyFlippedByteIsRefused) {
  const auto size = std::filesystem::file_size(path_);
  std::vector<std::uint64_t> places;
  for (std::uint64_t at = 0; at < 700; ++at) places.push_back(at);  // the first block, and headers
  for (std::uint64_t at = 700; at < size; at += size / 150) places.push_back(at);
  for (std::uint64_t at = size - 60; at < size; ++at) places.push_back(at);  // the seal
  for (const std::uint64_t at : places) {
    const auto flip = [&] {
      std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
      file.seekg(static_cast<std::streamoff>(at));
      const char byte = static_cast<char>(file.get() ^ 1 << at % 8);
      file.seekp(static_cast<std::streamoff>(at));
      file.put(byte);
    };
    flip();
    EXPECT_THAT(refusal<DamagedCheckpoint>(), AllOf(HasSubstr("checksum"), HasSubstr("not a complete checkpoint")))
        << at;
    flip();
  }
  EXPECT_NO_THROW(read_checkpoint(path_, facts_));
}

TEST_F(CheckpointFile, ThatIsDamagedIsRefused) {
  const auto size = std::filesystem::file_size(path_);
  std::filesystem::resize_file(path_, size / 2);
  EXPECT_THAT(refusal<FileError>(), HasSubstr("not a complete checkpoint"));
  std::ofstream(path_) << "not a checkpoint";
  EXPECT_THAT(refusal<FileError>(), HasSubstr("not a complete checkpoint"));
  std::filesystem::remove(path_);
  EXPECT_THAT(refusal<FileError>(), HasSubstr("checkpoint.h5"));
}

TEST(Guards, CanChangeOnTheWayUnlessTheySetTheTimeStep) {
  const auto can = [](const char* text, const char* guard, double limit) {
    return can_go_on_with(Description::parse(text), guard, limit);
  };
  EXPECT_TRUE(can(R"({"guards": {"travel": 0.05, "energy": 0.05}})", "energy", 2));
  EXPECT_FALSE(can(R"({"guards": {"travel": 0.05}})", "travel", 0.06));
  EXPECT_TRUE(can(R"({"guards": {"travel": 0.04}})", "travel", 0.05));
  EXPECT_FALSE(can(R"({"guards": {"travel": 0.1}})", "travel", 0.05));
  EXPECT_TRUE(can(R"({"guards": {"travel": 0.1}, "time_step": {"max_displacement": 0.04}})", "travel", 1));
  EXPECT_FALSE(can(R"({"guards": {"energy": 0.1}, "stages": [{"change": {"guards": {"energy": 0.1}}}]})", "energy", 1));
  EXPECT_FALSE(
      can(R"({"guards": {"energy": 0.1}, "stages": [{"ramps": [{"pointer": "/guards/energy"}]}]})", "energy", 1));
}

TEST_F(CheckpointFile, OfBeforeIsTakenIfTheLastIsDamagedOrMissing) {
  const auto previous = previous_checkpoint_path(folder_.path());
  EXPECT_EQ(checkpoint_path(folder_.path()), path_);
  const auto last = [&] { return last_checkpoint(folder_.path(), facts_); };
  ASSERT_TRUE(last());
  EXPECT_EQ(last()->note, "");
  checkpoint_.step = 2000;
  write_checkpoint(path_, facts_, checkpoint_, previous);
  EXPECT_EQ(last()->checkpoint.step, 2000u);
  EXPECT_EQ(last()->note, "");

  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) / 2);
  EXPECT_EQ(last()->checkpoint.step, 1000u);
  EXPECT_THAT(last()->note, AllOf(HasSubstr("checkpoint.h5: cannot read"),
                                  HasSubstr("the run continues from the checkpoint before it, " + previous.string())));
  std::filesystem::remove(path_);
  EXPECT_TRUE(has_checkpoint(folder_.path()));
  EXPECT_EQ(last()->checkpoint.step, 1000u);
  EXPECT_THAT(last()->note, HasSubstr("checkpoint.h5: is missing"));

  std::ofstream(path_) << "not a checkpoint", std::ofstream(previous) << "neither";
  EXPECT_THAT(error_of<DamagedCheckpoint>(last),
              AllOf(HasSubstr("checkpoint.h5: "), HasSubstr("checkpoint-previous.h5: "), HasSubstr("--overwrite")));
  std::filesystem::remove(path_), std::filesystem::remove(previous);
  EXPECT_FALSE(last());
}

}  // namespace
}  // namespace grit::checkpoint_tests
