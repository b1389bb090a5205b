// The Debian packages, looked into and unpacked without an installation. tests/package/bare.sh installs them.
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "support/program.hpp"

namespace grit {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::Not;

const std::vector<std::string> all_packages{"grit", "grit-mpi", "grit-dev", "python3-grit", "grit-doc"};

std::string printed(const std::string& script) {
  const OwnFolder folder;
  const auto outcome = shell(folder.path(), script);
  EXPECT_EQ(outcome.status, 0) << script << '\n' << outcome.err;
  return outcome.out;
}

/// The file of a package; its name has the version.
std::string deb(const std::string& package) { return "$(ls '" DEBS "/" + package + "'_*.deb)"; }

std::string field(const std::string& package, const std::string& name) {
  std::string text = printed("dpkg-deb -f " + deb(package) + ' ' + name);
  if (text.ends_with('\n')) text.pop_back();
  return text;
}

/// Files, not folders, from lines of tar.
std::vector<std::string> files(const std::string& listing) {
  std::vector<std::string> all;
  std::istringstream lines(printed(listing));
  for (std::string line; std::getline(lines, line);)
    if (!line.ends_with('/')) all.push_back(line);
  return all;
}

const std::vector<std::string>& files_of(const std::string& package) {
  static std::map<std::string, std::vector<std::string>> known;
  auto& all = known[package];
  if (all.empty()) all = files("dpkg-deb --fsys-tarfile " + deb(package) + " | tar t");
  return all;
}

TEST(Debs, AreFour) {
  EXPECT_EQ(printed("ls '" DEBS "' | sed 's/_.*//' | sort"), "grit\ngrit-dev\ngrit-doc\ngrit-mpi\npython3-grit\n");
}

TEST(Debs, HaveTheirFilesInDebiansPlaces) {
  const std::string folder = "./usr/lib/grit/" OTHER "/";
  EXPECT_THAT(files_of("grit"),
              IsSupersetOf({std::string("./usr/bin/grit"), folder + "grit", folder + "libgrit.so",
                            folder + "contacts/" LAW ".so", std::string("./usr/share/man/man1/grit.1.gz"),
                            std::string("./usr/share/man/man1/grit-run.1.gz"),
                            std::string("./usr/share/bash-completion/completions/grit"),
                            std::string("./usr/share/zsh/vendor-completions/_grit")}));
  EXPECT_THAT(
      files_of("grit-dev"),
      IsSupersetOf({"./usr/include/grit/plugin.hpp", "./usr/lib/cmake/grit/grit-config.cmake",
                    "./usr/lib/cmake/grit/" OTHER "/grit-targets.cmake", "./usr/lib/cmake/grit/testing/probe.cpp"}));
  EXPECT_THAT(files_of("python3-grit"), Contains("./usr/lib/python3/dist-packages/grit/__init__.py"));
  EXPECT_THAT(files_of("grit-doc"),
              IsSupersetOf({"./usr/share/doc/grit/README.md", "./usr/share/doc/grit/docs/tutorial/README.md",
                            "./usr/share/doc/grit/docs/plugins/README.md"}));
  for (const auto& package : all_packages)
    EXPECT_THAT(files_of(package), IsSupersetOf({"./usr/share/doc/" + package + "/copyright",
                                                 "./usr/share/doc/" + package + "/changelog.gz",
                                                 "./usr/share/doc/" + package + "/changelog.Debian.gz"}));
}

TEST(Debs, HoldEachFileOfAnInstallationOnce) {
  std::map<std::string, std::string> owner;
  for (const auto& package : all_packages)
    for (const auto& file : files_of(package)) {
      EXPECT_TRUE(owner.try_emplace(file, package).second) << file << " is in " << package << " and " << owner[file];
    }
  const auto installed = files("tar tzf '" ARCHIVE "'");
  EXPECT_GT(installed.size(), 300u);
  for (std::string file : installed) {
    file.replace(0, file.find('/'), "./usr");
    for (const auto& [here, there] : {std::pair<std::string, std::string>{"/" LIBRARIES "/", "/lib/"},
                                      {"/share/grit/python/", "/lib/python3/dist-packages/"}})
      if (const auto at = file.find(here); at == 5) file.replace(at, here.size(), there);
    if (!file.ends_with("/LICENSE")) EXPECT_TRUE(owner.contains(file)) << file;  // it is in copyright
  }
}

TEST(Debs, DependOnWhatTheyLoad) {
  for (const char* library :
       {"libc6 (>= ", "libstdc++6 (>= ", "libhdf5-", "libnlopt0", "libboost-program-options", "libudunits2-0"})
    EXPECT_THAT(field("grit", "Depends"), HasSubstr(library));
  const std::string same = "grit (= " + field("grit", "Version") + ")";
  EXPECT_THAT(field("grit-dev", "Depends"),
              AllOf(HasSubstr(same), HasSubstr("libeigen3-dev"), ContainsRegex("clang-|g\\+\\+-")));
  EXPECT_THAT(field("python3-grit", "Depends"),
              AllOf(HasSubstr(same), HasSubstr("python3-numpy"), HasSubstr("python3-h5py")));
  EXPECT_EQ(field("grit-doc", "Depends"), "");
}

TEST(Debs, SayWhatTheyAre) {
  const std::map<std::string, std::string> sections{
      {"grit", "science"}, {"grit-mpi", "science"}, {"grit-dev", "libdevel"}, {"python3-grit", "python"}, {"grit-doc", "doc"}};
  for (const auto& [package, section] : sections) {
    EXPECT_EQ(field(package, "Section"), section);
    EXPECT_THAT(field(package, "Version"), testing::StartsWith(GRIT_VERSION));
    EXPECT_EQ(field(package, "Version"), field("grit", "Version"));
    EXPECT_THAT(field(package, "Maintainer"), ContainsRegex("^[^<]+ <[^ ]+@[^ ]+>$"));
    EXPECT_THAT(field(package, "Description"),
                AllOf(HasSubstr("discrete element method"), HasSubstr("\n A JSON file")));
    const std::string folder = "/usr/share/doc/" + package;
    EXPECT_THAT(printed("dpkg-deb --fsys-tarfile " + deb(package) + " | tar xO ." + folder + "/copyright"),
                AllOf(HasSubstr("BSD 3-Clause License"), HasSubstr("Vega")));
    EXPECT_THAT(printed("dpkg-deb --fsys-tarfile " + deb(package) + " | tar xO ." + folder + "/changelog.gz | gzip -d"),
                HasSubstr("# Changelog"));
  }
  EXPECT_EQ(field("grit-doc", "Architecture"), "all");
  EXPECT_EQ(field("grit", "Architecture"), printed("dpkg --print-architecture | tr -d '\\n'"));
}

TEST(Debs, RunWhereTheyAreUnpacked) {
  const OwnFolder folder;
  const auto outcome = shell(
      folder.path(), "for each in '" DEBS
                     "'/*.deb; do dpkg-deb -x $each .; done; "
                     "env -u GRIT_ISA -u GRIT_PLUGIN_PATH usr/bin/grit plugins; env -u GRIT_ISA usr/bin/grit --help; "
                     "PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=usr/lib/python3/dist-packages /usr/bin/python3 -c "
                     "'import grit; print(grit.__file__)'");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("usr/lib/grit/" OTHER "/contacts/" LAW ".so"),
                                 HasSubstr("\nDocumentation: " + (folder / "usr/share/doc/grit/docs").string() + '\n'),
                                 HasSubstr("usr/lib/python3/dist-packages/grit/__init__.py")));
}

TEST(Debs, AreTakenByLintian) {
  // The tag is about uploads to Debian.
  const OwnFolder folder;
  if (shell(folder.path(), "command -v lintian").status != 0) GTEST_SKIP() << "lintian is not installed";
  const auto outcome = shell(
      folder.path(),
      "lintian --allow-root --fail-on error,warning --suppress-tags initial-upload-closes-no-bugs '" DEBS "'/*.deb");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, IsEmpty());
}

}  // namespace
}  // namespace grit
