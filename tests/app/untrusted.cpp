// Descriptions and folders of strangers: what they may read, write and load.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "scenes.hpp"
#include "support/program.hpp"

namespace grit::untrusted_tests {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;

std::set<std::string> files_in(const std::filesystem::path& folder) {
  std::set<std::string> all;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) all.insert(entry.path().string());
  return all;
}

struct Untrusted : testing::Test {
  Untrusted() { folder.write("two.json", two_grains); }
  Outcome with(const std::string& does, const std::vector<std::string>& sets) const {
    std::vector<std::string> words{does, "two.json"};
    for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
    return grit_in(folder.path(), words);
  }
  OwnFolder folder;
};

/// Neither may stop the program, nor fill its memory.
TEST_F(Untrusted, FilesAreNoNamedPipesAndNoDevices) {
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const auto refused = [&](const std::string& set, const std::string& pointer) {
    for (const std::string& path : {pipe, std::string("/dev/zero")})
      for (const std::string does : {"check", "run"}) {
        std::string filled = set;
        filled.replace(filled.find('@'), 1, path);
        const auto outcome = with(does, {filled});
        EXPECT_EQ(outcome.status, 2) << does << ' ' << filled;
        EXPECT_THAT(outcome.err, AllOf(HasSubstr(pointer + ": "), HasSubstr(path), HasSubstr("1 problem"),
                                       AnyOf(HasSubstr("it is a named pipe; allowed are regular files"),
                                             HasSubstr("it is a device; allowed are regular files"))))
            << does;
      }
  };
  const std::string group = R"(/bodies/more={"type": "sphere", "material": "sand", )";
  refused(group + R"("source": {"type": "file", "path": "@"}})", "/bodies/more/source/path");
  refused(group + R"("stage": "part", "source": {"type": "file", "path": "@"}})", "/bodies/more/source/path");
  refused(group + R"("source": {"type": "cloud", "count": 3, "sizes": {"type": "list", "diameters": [0.001]},
                                "region": {"type": "mesh", "path": "@", "scale": 1}}})",
          "/bodies/more/source/region/path");
  refused(R"(/bodies/more={"type": "clump", "material": "sand", "shape": {"type": "file", "path": "@"},
             "source": {"type": "list", "bodies": [{"position": [1, 1, 1], "radius": 0.001}]}})",
          "/bodies/more/shape/path");
  refused(R"(/walls={"chute": {"type": "mesh", "path": "@", "scale": 1, "material": "sand"}})", "/walls/chute/path");
  refused(R"(/output/references={"lab": {"of": "packing/kinetic_energy",
             "curve": {"file": "@", "x": "time", "y": "energy"}}})",
          "/output/references/lab/curve/file");
  for (const std::string& path : {pipe, std::string("/dev/zero")}) {
    folder.write("child.json", R"({"extends": ")" + path + "\"}");
    const auto extended = grit_in(folder.path(), {"check", "child.json"});
    EXPECT_EQ(extended.status, 2);
    EXPECT_THAT(extended.err, HasSubstr("child.json:1: /extends: there is no file " + path + " to extend"));
    for (const std::string does : {"check", "run", "expand"}) {
      const auto itself = grit_in(folder.path(), {does, path});
      EXPECT_EQ(itself.status, 5) << does << itself.err;
      EXPECT_THAT(itself.err, HasSubstr("; allowed are regular files")) << does;
    }
    const auto advised = grit_in(folder.path(), {"advise", "two.json", "--study", path});
    EXPECT_NE(advised.status, 0);
  }
}

TEST_F(Untrusted, SamplesAreNoNamedPipes) {
  const std::string first = R"(/begin={"from": "sample"})", second = R"(/bodies/grains/source={"type": "sample"})";
  std::filesystem::create_directories(folder / "sample/frames");
  for (const char* file : {"sample/final.h5", "sample/frames/000000.h5"})
    ASSERT_EQ(::mkfifo((folder / file).c_str(), 0600), 0);
  for (const std::string& begin : {first, std::string(R"(/begin={"from": "sample", "at": "frame"})")}) {
    const auto outcome = with("check", {begin, second});
    EXPECT_EQ(outcome.status, 2) << begin;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("/begin/from: "), HasSubstr("holds no "))) << begin;
  }
}

/// Libraries are those of the installation and of --plugin-path, by name.
TEST_F(Untrusted, DescriptionsNameNoLibraryByItsPath) {
  const std::filesystem::path library = folder / "evil.so";
  std::filesystem::copy_file(GRIT_PLUGIN_DIR "/contacts/linear-frictional.so", library);
  const std::string stem = folder / "evil";
  const auto relative = std::filesystem::relative(stem, GRIT_PLUGIN_DIR "/contacts").string();
  for (const std::string& type : {std::string("evil"), std::string("./evil"), library.string(), stem, relative})
    for (const std::string pointer : {"/contacts/type", "/probes/packing/type"}) {
      const auto outcome = with("check", {pointer + '=' + type});
      EXPECT_EQ(outcome.status, 2) << type;
      EXPECT_THAT(outcome.err, HasSubstr("--set: " + pointer + ": unknown ")) << type;
    }
}

TEST_F(Untrusted, RunsWriteIntoTheirFolderOnly) {
  for (const std::string pointer : {"/probes", "/walls", "/bodies", "/materials", "/engines"})
    for (const std::string name : {"../escape", "..", "a/b", "/tmp/escape", ".hidden"}) {
      std::string token;
      for (const char c : name) token += c == '/' ? "~1" : std::string(1, c);
      const auto outcome = with("run", {pointer + '/' + token + "={}"});
      EXPECT_EQ(outcome.status, 2) << pointer << name;
      EXPECT_THAT(outcome.err, HasSubstr("found the name \"" + name + "\"; allowed are letters, digits and _ . + -"))
          << pointer << name;
    }
  const std::filesystem::path work = folder / "work";
  std::filesystem::create_directories(work);
  std::filesystem::rename(folder / "two.json", work / "two.json");
  const auto before = files_in(folder.path());
  const auto outcome =
      grit_in(work, {"run", "two.json", "--out", "out", "--quiet", "--set", "/title=../../escape", "--set",
                     R"(/output/frames={"every_steps": 100, "formats": ["vtk", "lammps-dump"]})", "--set",
                     R"(/output/picture={"x": "a..b/time", "y": ["a..b/kinetic_energy"]})", "--set",
                     R"(/output/summary=[])", "--set", R"(/probes={"a..b": {"type": "packing", "every_steps": 10}})",
                     "--set", R"(/walls/x..y={"type": "plane", "point": [0, 0, "-5 mm"], "material": "sand"})"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::set<std::string> made;
  std::ranges::set_difference(files_in(folder.path()), before, std::inserter(made, made.end()));
  EXPECT_GT(made.size(), 10u);
  const std::string out = work / "out";
  for (const std::string& file : made) EXPECT_TRUE(file == out || file.starts_with(out + '/')) << file;
}

}  // namespace
}  // namespace grit::untrusted_tests
