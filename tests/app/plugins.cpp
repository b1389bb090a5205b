// Installed components, and plugins that cannot be loaded: exit status 3.
#include <gmock/gmock.h>

#include "scenes.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

TEST(Plugins, ListsWhatIsInstalled) {
  const OwnFolder folder;
  const auto outcome = grit_in(folder.path(), {"plugins"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out,
              AllOf(StartsWith("grit " GRIT_VERSION ", instruction set "), HasSubstr("contact   linear-rolling"),
                    HasSubstr("lib/grit/contacts/linear-rolling.so"), HasSubstr("engine    gravity"),
                    HasSubstr("scenario  direct-shear")));
}

TEST(Plugins, ShowsOneInDetail) {
  const OwnFolder folder;
  const auto outcome = grit_in(folder.path(), {"plugins", "linear-rolling"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out,
              AllOf(StartsWith("contact \"linear-rolling\" "), HasSubstr("linear-rolling.so\nSDK "),
                    HasSubstr("contact_modulus"), HasSubstr("per interface of two materials"), Not(HasSubstr("/../"))));
}

TEST(Plugins, AnUnknownNameIsRefusedWithTheNearest) {
  const OwnFolder folder;
  for (const char* command : {"plugins", "describe"}) {
    const auto outcome = grit_in(folder.path(), {command, "linear-roling"});
    EXPECT_EQ(outcome.status, 3);
    EXPECT_THAT(outcome.err, HasSubstr("did you mean \"linear-rolling\"? 'grit " + std::string(command) +
                                       "' lists all\n  searched: " GRIT_PLUGIN_DIR
                                       "; --plugin-path DIR or GRIT_PLUGIN_PATH=DIR adds DIR\n"));
  }
  EXPECT_THAT(grit_in(folder.path(), {"describe", "wall"}).err, HasSubstr("did you mean \"walls\"?"));
}

TEST(Describe, ShowsSectionsAndComponents) {
  const OwnFolder folder;
  auto outcome = grit_in(folder.path(), {"describe", "stages"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("unbalanced-force"), HasSubstr("ramps")));
  outcome = grit_in(folder.path(), {"describe", "gravity"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, AllOf(StartsWith("engine \"gravity\""), HasSubstr("acceleration")));
  outcome = grit_in(folder.path(), {"describe", "at-rest"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(StartsWith("in the section stages\nname "), HasSubstr("\"at-rest\""),
                                 HasSubstr("\n        below "), Not(HasSubstr("unbalanced-force\""))));
  outcome = grit_in(folder.path(), {"describe", "stream"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(StartsWith("in the section bodies\nname "), HasSubstr("number_rate"),
                                 HasSubstr("\"disc\""), Not(HasSubstr("\"cloud\""))));
  EXPECT_THAT(grit_in(folder.path(), {"describe", "at-rst"}).err, HasSubstr("did you mean \"at-rest\"?"));
  outcome = grit_in(folder.path(), {"describe"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("\n  stages "), HasSubstr("\n  linear-rolling\n")));
}

/// A plugin folder in which the contact law "sticky" is not a library.
std::string broken_plugins(const OwnFolder& folder) {
  folder.write("broken/contacts/sticky.so", "no library");
  return (folder / "broken").string();
}

TEST(Plugins, ABrokenOneStopsARunThatNeedsIt) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto outcome = grit_in(
      folder.path(), {"run", "two.json", "--set", "/contacts/type=sticky", "--plugin-path", broken_plugins(folder)});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, AllOf(StartsWith("grit: contact plugin \"sticky\""), HasSubstr("broken/contacts/sticky.so"),
                                 HasSubstr("cannot be opened")));
  EXPECT_FALSE(std::filesystem::exists(folder / "results"));
}

TEST(Plugins, ABrokenOneDoesNotHideTheOthers) {
  const OwnFolder folder;
  const auto outcome = grit_in(folder.path(), {"plugins", "--plugin-path", broken_plugins(folder)});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, HasSubstr("broken/contacts/sticky.so"));
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("cannot be loaded"), HasSubstr("scenario  direct-shear")));
}

TEST(Plugins, TheEnvironmentNamesFoldersToo) {
  const OwnFolder folder;
  const auto outcome =
      shell(folder.path(), "GRIT_PLUGIN_PATH='" + broken_plugins(folder) + "' '" GRIT_BINARY "' plugins sticky");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, HasSubstr("broken/contacts/sticky.so"));
}

/// The message names both files.
TEST(Plugins, ASecondOneOfTheSameNameIsRefused) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const std::string mine = (folder / "mine").string(), law = mine + "/contacts/linear-rolling.so",
                    body = mine + "/bodies/sphere.so";
  std::filesystem::create_directories(folder / "mine/contacts");
  std::filesystem::copy(GRIT_PLUGIN_DIR "/contacts/linear-rolling.so", law);
  const auto twice = grit_in(folder.path(), {"run", "two.json", "--plugin-path", mine});
  EXPECT_EQ(twice.status, 3);
  EXPECT_THAT(twice.err, StartsWith("grit: contact plugin \"linear-rolling\" exists twice: " + law +
                                    ", and " GRIT_PLUGIN_DIR
                                    "/contacts/linear-rolling.so\n  remove one from the folders that are searched"));
  EXPECT_EQ(grit_in(folder.path(), {"run", "two.json", "--plugin-path", GRIT_PLUGIN_DIR}).status, 0) << "the same file";
  std::filesystem::remove(law);
  folder.write("mine/bodies/sphere.so", "another sphere");
  const auto built_in = grit_in(folder.path(), {"check", "two.json", "--plugin-path", mine});
  EXPECT_EQ(built_in.status, 3);
  EXPECT_THAT(built_in.err,
              StartsWith("grit: body plugin \"sphere\" exists twice: built into " GRIT_PLUGIN_DIR "/libgrit.so, and " +
                         body + "\n"));
  const auto list = grit_in(folder.path(), {"plugins", "--plugin-path", mine});
  EXPECT_EQ(list.status, 3);
  EXPECT_THAT(list.err, HasSubstr("exists twice"));
  EXPECT_THAT(list.out, HasSubstr("scenario  direct-shear"));
}

}  // namespace
}  // namespace grit
