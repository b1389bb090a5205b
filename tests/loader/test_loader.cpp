// Every check of the loader, each with a plugin that fails it and the text that says so.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <link.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <ostream>

#include "grit/error.hpp"
#include "grit/toolkit/did_you_mean.hpp"
#include "plugins/build_facts.hpp"
#include "plugins/component.hpp"
#include "plugins/loader.hpp"
#include "plugins/registry.hpp"

namespace grit {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::AnyOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

const fs::path fixtures = FIXTURES;

std::string file_of(const std::string& name) { return (fixtures / "bodies" / (name + ".so")).string(); }

/// The text of the PluginError that `call` throws; empty, with a failure, if it throws none.
template <class Call>
std::string error_of(Call call) {
  try {
    call();
  } catch (const PluginError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no PluginError";
  return "";
}

std::string make_error(const std::string& name) {
  const Registry registry({fixtures});
  return error_of([&] { registry.make<BodyKind>(name); });
}

/// A plugin directory that goes with the test.
class Directory {
 public:
  Directory() {
    std::string pattern = (fs::temp_directory_path() / "grit-loader-XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
    fs::create_directories(path_ / "bodies");
  }
  ~Directory() { fs::remove_all(path_); }
  Directory(const Directory&) = delete;
  Directory& operator=(const Directory&) = delete;

  const fs::path& path() const { return path_; }
  fs::path body(const std::string& name) const { return path_ / "bodies" / (name + ".so"); }
  void write_text(const std::string& name) const { std::ofstream(body(name)) << std::string(100, '?'); }
  void copy_good(const std::string& name) const { fs::copy_file(file_of("good"), body(name)); }

 private:
  fs::path path_;
};

TEST(Loader, MakesWhatAGoodPluginMakes) {
  const Registry registry({fixtures});
  const auto cube = registry.make<BodyKind>("good");
  EXPECT_DOUBLE_EQ(cube->volume(0.5), 1.0);
  EXPECT_DOUBLE_EQ(cube->inertia(0.5, 6.0), 1.0);
  EXPECT_STREQ(registry.info("body", "good").version, "1.0.0");
  EXPECT_EQ(registry.file("body", "good"), file_of("good"));
}

TEST(Loader, KeepsALibraryWithoutItsRegistry) {
  std::shared_ptr<BodyKind> cube;
  {
    const Registry registry({fixtures});
    cube = registry.make<BodyKind>("good");
  }
  EXPECT_DOUBLE_EQ(cube->volume(0.5), 1.0);
}

TEST(Loader, ComesWithThePluginsOfTheBuild) {
  const auto law = Registry({GRIT_PLUGIN_DIR}).make<ContactLaw>("linear-rolling");
  EXPECT_EQ(law->loop().precision, "double");
}

// ---- what cannot be opened

TEST(Loader, SaysWhatThereIsForAnUnknownName) {
  const Directory directory;
  directory.write_text("sphere");
  directory.write_text("cylinder");
  const Registry registry({directory.path(), "/nowhere"});
  const auto error = error_of([&] { registry.make<BodyKind>("spehre"); });
  EXPECT_THAT(error, HasSubstr("unknown body plugin \"spehre\"; did you mean \"sphere\"?\n"));
  EXPECT_THAT(error, HasSubstr("available: cylinder, sphere"));
  EXPECT_THAT(error,
              HasSubstr("searched: " + directory.path().string() +
                        "/bodies, /nowhere/bodies (no such directory); --plugin-path DIR or GRIT_PLUGIN_PATH=DIR adds "
                        "DIR/bodies"));
  EXPECT_EQ(registry.search_text(),
            "searched: " + directory.path().string() +
                ", /nowhere (no such directory); --plugin-path DIR or GRIT_PLUGIN_PATH=DIR adds "
                "DIR");
}

TEST(Loader, GuessesNoNameThatIsFarOff) {
  const Directory directory;
  directory.write_text("sphere");
  const Registry registry({directory.path()});
  EXPECT_THAT(error_of([&] { registry.info("body", "tetrahedron"); }), Not(HasSubstr("did you mean")));
}

TEST(Loader, SaysThatThereIsNothing) {
  const auto error = error_of([] { Registry({}).info("probe", "x"); });
  EXPECT_THAT(error, AllOf(HasSubstr("available: none"), HasSubstr("searched: no directory")));
}

TEST(Loader, RefusesAKindThatIsNone) {
  const Registry registry({fixtures});
  EXPECT_THAT(
      error_of([&] { registry.names("prob"); }),
      "unknown kind of plugin \"prob\"; did you mean \"probe\"? Allowed are body, contact, engine, geometry, probe, "
      "scenario");
  EXPECT_THAT(error_of([&] { registry.info("bodies", "good"); }), HasSubstr("unknown kind of plugin \"bodies\""));
}

TEST(Loader, RefusesANameThatIsAPath) {
  const Registry registry({fixtures});
  for (const std::string name : {"../bodies/good", "/tmp/good", "./good", "good.so", "..", ".", "", "a\\b"}) {
    const auto error = error_of([&] { registry.make<BodyKind>(name); });
    EXPECT_THAT(error,
                AllOf(HasSubstr('"' + name + "\" is not the name of a body plugin"),
                      HasSubstr("allowed are letters, digits and hyphens, not a path"), HasSubstr("--plugin-path")));
  }
}

TEST(Loader, RefusesWhatIsNotASharedLibrary) {
  const Directory directory;
  directory.write_text("text");
  const Registry registry({directory.path()});
  EXPECT_THAT(error_of([&] { registry.make<BodyKind>("text"); }),
              AllOf(HasSubstr("body plugin \"text\" (" + directory.body("text").string() + "): cannot be opened"),
                    HasSubstr("invalid ELF header"), HasSubstr("build it with the function grit_plugin")));
}

/// The dynamic linker maps such a file, and the process ends where it reads behind its end.
TEST(Loader, RefusesAFileThatWasCutOff) {
  const Directory directory;
  directory.copy_good("cut");
  const Registry registry({directory.path()});
  for (auto size = fs::file_size(directory.body("cut")) - 1; size > 0; size = size * 4 / 5) {
    fs::resize_file(directory.body("cut"), size);
    EXPECT_THAT(error_of([&] { registry.make<BodyKind>("cut"); }),
                AllOf(HasSubstr("body plugin \"cut\" (" + directory.body("cut").string() + "): "),
                      AnyOf(AllOf(HasSubstr("is incomplete: it has " + std::to_string(size) + " bytes"),
                                  HasSubstr("copy or build the file again")),
                            HasSubstr("cannot be opened"))))
        << size;
  }
}

/// Writes a number of two bytes into a file.
void overwrite(const fs::path& file, std::streamoff offset, std::uint16_t number) {
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekp(offset).write(reinterpret_cast<const char*>(&number), sizeof number);
}

TEST(Loader, RefusesAFileOfAnotherMachine) {
  const Directory directory;
  directory.copy_good("other");
  overwrite(directory.body("other"), offsetof(ElfW(Ehdr), e_machine), EM_S390);
  const Registry registry({directory.path()});
  EXPECT_THAT(error_of([&] { registry.make<BodyKind>("other"); }),
              AllOf(HasSubstr("other.so): is of another machine: expected ELF class "),
                    HasSubstr(", machine " + std::to_string(EM_S390) + "\n"), HasSubstr("for this machine")));
}

TEST(Loader, RefusesAnUndefinedSymbol) {
  EXPECT_THAT(make_error("undefined-symbol"),
              AllOf(HasSubstr(file_of("undefined-symbol") + "): cannot be opened"), HasSubstr("undefined symbol"),
                    HasSubstr("nowhere_to_be_found"), HasSubstr("`ldd -r " + file_of("undefined-symbol") + "`")));
}

// ---- the one symbol

TEST(Loader, RefusesALibraryWithoutTheSymbol) {
  EXPECT_THAT(make_error("no-entry"), AllOf(HasSubstr(file_of("no-entry") + "): has no function grit_plugin"),
                                            HasSubstr("define extern \"C\" const grit::PluginInfo* grit_plugin()")));
}

TEST(Loader, RefusesASymbolThatReturnsNull) {
  EXPECT_THAT(make_error("null-entry"), AllOf(HasSubstr(file_of("null-entry") + "): its grit_plugin() returned null"),
                                              HasSubstr("return the address of a static PluginInfo")));
}

TEST(Loader, NamesAPluginWhoseSymbolThrows) {
  EXPECT_THAT(make_error("throwing-entry"),
              AllOf(HasSubstr(file_of("throwing-entry") + "): its grit_plugin() threw: no luck today"),
                    HasSubstr("fix the plugin")));
  EXPECT_THAT(
      make_error("entry-throwing-int"),
      HasSubstr(file_of("entry-throwing-int") + "): its grit_plugin() threw: something that is not a std::exc"));
}

TEST(Loader, RefusesALibraryThatChangesTheArithmetic) {
#ifndef __SSE__
  GTEST_SKIP() << "the setting is that of x86";
#endif
  const volatile double smallest = std::numeric_limits<double>::min();
  EXPECT_THAT(make_error("flushes-to-zero"),
              AllOf(HasSubstr(file_of("flushes-to-zero") + "): changes the arithmetic of the process"),
                    HasSubstr("link it without -ffast-math, -Ofast and -funsafe-math-optimizations")));
  EXPECT_GT(smallest / 2, 0) << "subnormal numbers are zero from now on";
}

// ---- the build tag

std::string layout_text(Layout layout) {
  return std::to_string(layout.size) + " bytes aligned to " + std::to_string(layout.alignment);
}

struct TagCase {
  std::string plugin, line;
  friend std::ostream& operator<<(std::ostream& out, const TagCase& one) { return out << one.plugin; }
};
class LoaderTag : public testing::TestWithParam<TagCase> {};

TEST_P(LoaderTag, RefusesTheMismatch) {
  const auto& [plugin, line] = GetParam();
  const auto error = make_error(plugin);
  EXPECT_THAT(error, HasSubstr("body plugin \"" + plugin + "\" (" + file_of(plugin) + "): was built differently"));
  EXPECT_THAT(error, HasSubstr("\n  " + line + "\n"));
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 2) << "more than this one mismatch:\n" << error;
  EXPECT_THAT(error, HasSubstr("rebuild it against this SDK: cmake --fresh -S SOURCES -B BUILD -Dgrit_DIR="));
  EXPECT_THAT(error, HasSubstr(std::string("/lib/cmake/grit -DGRIT_ARCH=") + build_facts().arch + " && "));
}

std::vector<TagCase> tag_cases() {
  const BuildTag tag = build_tag();
  const auto number = [](const char* what, std::uint32_t expected, std::uint32_t found) {
    return what + (": expected " + std::to_string(expected)) + ", found " + std::to_string(found);
  };
  const auto text = [](const char* what, std::string expected, char first) {
    const std::string found = first + expected.substr(1);
    return std::string(what) + ": expected \"" + expected + "\", found \"" + found + '"';
  };
  const auto layout = [](const char* what, Layout expected, Layout found) {
    return what + (": expected " + layout_text(expected)) + ", found " + layout_text(found);
  };
  return {
      {"wrong-tag-size", number("size of the build tag", sizeof(BuildTag), 12)},
      {"wrong-sdk-version", number("SDK version", sdk_version, sdk_version + 7)},
      {"wrong-compiler", text("compiler", tag.compiler, 'G')},
      {"wrong-library-abi", text("C++ library", tag.library_abi, 'L')},
      {"wrong-instruction-set", text("instruction set", tag.instruction_set, 'X')},
      {"other-instruction-set",
       std::string("instruction set: expected \"") + tag.instruction_set + "\", found \"" OTHER_INSTRUCTION_SET "\""},
      {"wrong-row", layout("Row", tag.row, {tag.row.size + 8, tag.row.alignment})},
      {"wrong-contact-row",
       layout("ContactRow", tag.contact_row, {tag.contact_row.size, tag.contact_row.alignment * 2})},
      {"wrong-body-sum", layout("BodySum", tag.body_sum, {tag.body_sum.size * 2, tag.body_sum.alignment})},
      {"wrong-pair-batch", layout("PairBatch", tag.pair_batch, {tag.pair_batch.size + 8, tag.pair_batch.alignment})},
      {"wrong-wall-batch", layout("WallBatch", tag.wall_batch, {tag.wall_batch.size - 8, tag.wall_batch.alignment})}};
}

INSTANTIATE_TEST_SUITE_P(EachField, LoaderTag, testing::ValuesIn(tag_cases()), [](const auto& info) {
  std::string name = info.param.plugin;
  std::ranges::replace(name, '-', '_');
  return name;
});

TEST(Loader, ReportsAllMismatchesAtOnce) {
  const auto error = make_error("wrong-everything");
  for (const char* what : {"SDK version", "compiler", "C++ library", "instruction set", "Row", "ContactRow", "BodySum",
                           "PairBatch", "WallBatch"})
    EXPECT_THAT(error, HasSubstr(std::string("\n  ") + what + ": expected "));
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 10);
}

TEST(Loader, ReadsNothingButTheMagicOfAForeignFile) {
  const auto error = make_error("wrong-magic");
  EXPECT_THAT(error, AllOf(HasSubstr(file_of("wrong-magic") + "): is not a plugin of grit"),
                           HasSubstr("magic: expected \"gritplg\", found \"Gritplg\""), HasSubstr("rebuild it")));
  EXPECT_THAT(error, Not(HasSubstr("SDK version")));
}

TEST(Loader, AcceptsItsOwnTag) { EXPECT_THAT(mismatches(build_tag(), build_tag()), IsEmpty()); }

// ---- what stands behind the tag

TEST(Loader, RefusesAnotherKind) {
  EXPECT_THAT(
      make_error("wrong-kind"),
      AllOf(HasSubstr(file_of("wrong-kind") + "): kind: expected \"body\" of a file in bodies/, found \"probe\""),
            HasSubstr("move the file to the folder of its kind")));
}

TEST(Loader, RefusesAnotherName) {
  EXPECT_THAT(make_error("wrong-name"),
              AllOf(HasSubstr(file_of("wrong-name") +
                              "): name: expected \"wrong-name\" as in the file name, found \"another-name\""),
                    HasSubstr("rename the file")));
  EXPECT_THAT(make_error("null-name"), HasSubstr("name: expected \"null-name\" as in the file name, found \"\""));
}

TEST(Loader, RefusesAPluginThatCannotMakeItsKind) {
  EXPECT_THAT(make_error("no-maker"),
              AllOf(HasSubstr(file_of("no-maker") + "): cannot create objects: PluginInfo::make_body is null"),
                    HasSubstr("set make_body to a function")));
}

TEST(Loader, RefusesAMakerThatMakesNothing) {
  EXPECT_THAT(make_error("null-maker"), AllOf(HasSubstr("body plugin \"null-maker\" (" + file_of("null-maker")),
                                              HasSubstr("returned null"), HasSubstr("return a new object")));
}

TEST(Loader, NamesAPluginWhoseMakerThrows) {
  EXPECT_THAT(make_error("throwing-maker"),
              AllOf(HasSubstr("body plugin \"throwing-maker\" (" + file_of("throwing-maker") +
                              "): its make_body() threw: out of clay"),
                    HasSubstr("fix the plugin")));
}

TEST(Loader, NamesAPluginWhoseDeclareThrows) {
  const Registry registry({fixtures});
  Component<BodyKind> component(registry);
  component.choose("throwing-declare");
  EXPECT_THAT(error_of([&] {
                Parameters parameters;
                component.declare(parameters);
              }),
              HasSubstr('(' + file_of("throwing-declare") + "): its declare() threw: nothing to declare"));
}

// ---- what is chosen

TEST(Registry, ListsFilesWithoutOpeningThem) {
  const Directory directory;
  directory.write_text("text");
  fs::create_directory(directory.body("folder"));
  std::ofstream(directory.path() / "bodies/README.md") << "not a plugin\n";
  std::ofstream(directory.path() / "bodies/two.dots.so") << "cannot be asked for\n";
  directory.copy_good("good");
  const Registry registry({directory.path(), "/nowhere"});
  EXPECT_THAT(registry.names("body"), ElementsAre("good", "text"));
  EXPECT_THAT(registry.names("probe"), IsEmpty());
  const auto installed = registry.installed();
  ASSERT_THAT(installed, SizeIs(2));
  EXPECT_EQ(installed[1].kind, "body");
  EXPECT_EQ(installed[1].name, "text");
  EXPECT_EQ(installed[1].file, directory.body("text"));
  EXPECT_THAT(error_of([&] { registry.make<BodyKind>("text"); }), HasSubstr("cannot be opened"));
}

TEST(Registry, RefusesASecondFileOfTheSameName) {
  const Directory first, second;
  first.copy_good("good"), second.write_text("good"), second.copy_good("other");
  const Registry registry({first.path(), second.path()});
  EXPECT_THAT(registry.names("body"), ElementsAre("good", "other"));
  EXPECT_EQ(registry.file("body", "good"), first.body("good"));
  for (int again = 0; again < 2; ++again)
    EXPECT_EQ(error_of([&] { registry.info("body", "good"); }),
              "body plugin \"good\" exists twice: " + first.body("good").string() + ", and " +
                  second.body("good").string() +
                  "\n  remove one from the folders that are searched, or rename the file and PluginInfo::name");
}

TEST(Registry, TakesAFileThatIsFoundTwice) {
  const Directory first;
  first.copy_good("good");
  const Registry registry({first.path(), first.path() / "bodies/..", first.path()});
  EXPECT_STREQ(registry.info("body", "good").name, "good");
}

TEST(Registry, PrefersTheFolderOfTheInstructionSet) {
  const Directory directory, another;
  const fs::path own = directory.path() / build_facts().arch;
  fs::create_directories(own / "bodies");
  fs::copy_file(file_of("good"), own / "bodies/good.so");
  directory.write_text("good");
  const Registry registry(plugin_directories({directory.path().string() + '/'}, another.path()));
  EXPECT_STREQ(registry.info("body", "good").name, "good");
  EXPECT_EQ(registry.file("body", "good").lexically_normal(), own / "bodies/good.so");
}

struct Point : BodyKind {
  void declare(Parameters&) override {}
  double volume(double) const override { return 0; }
  double inertia(double, double) const override { return 0; }
};

TEST(Registry, HasWhatIsBuiltIn) {
  PluginInfo info;
  info.kind = "body", info.name = "point", info.make_body = []() -> BodyKind* { return new Point; };
  Registry registry({fixtures});
  registry.add(info);
  EXPECT_EQ(&registry.info("body", "point"), &info);
  EXPECT_EQ(registry.make<BodyKind>("point")->volume(1), 0);
  EXPECT_EQ(registry.file("body", "point"), "");
  EXPECT_EQ(registry.title("body", "point"), "body plugin \"point\" (built in)");
  EXPECT_EQ(std::ranges::count(registry.names("body"), "point"), 1);
}

TEST(Registry, RefusesAFileWithTheNameOfWhatIsBuiltIn) {
  PluginInfo info;
  info.kind = "body", info.name = "good", info.make_body = []() -> BodyKind* { return new Point; };
  Registry registry({fixtures});
  registry.add(info);
  EXPECT_THAT(error_of([&] { registry.make<BodyKind>("good"); }),
              AllOf(HasSubstr("body plugin \"good\" exists twice: built into " + library_file().string() + ", and " +
                              file_of("good")),
                    HasSubstr("rename the file")));
  EXPECT_EQ(std::ranges::count(registry.names("body"), "good"), 1);
}

TEST(Registry, SearchesOptionThenVariableThenBeside) {
  ::setenv("GRIT_PLUGIN_PATH", "/c::/d", 1);
  const auto directories = plugin_directories({"/a", "/b"}, "/beside");
  ::unsetenv("GRIT_PLUGIN_PATH");
  EXPECT_THAT(directories, ElementsAre("/a", "/b", "/c", "/d", "/beside"));
  EXPECT_THAT(plugin_directories({}, "/beside"), ElementsAre("/beside"));
}

TEST(Registry, SearchesTheFolderOfItsInstructionSetFirst) {
  const auto folder = fs::temp_directory_path() / ("grit-test-" + std::to_string(::getpid()));
  const auto own = folder / "both" / build_facts().arch;
  fs::create_directories(own);
  fs::create_directories(folder / "one/another");
  const auto directories = plugin_directories({folder / "both", folder / "one"}, "/beside");
  fs::remove_all(folder);
  EXPECT_THAT(directories, ElementsAre(own, folder / "both", folder / "one", "/beside"));
}

TEST(Nearest, CountsEdits) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("spehre", "sphere"), 1u);
  EXPECT_EQ(edit_distance("linear-rolling", "linear-roling"), 1u);
}

TEST(Nearest, NeedsHalfOfTheNameWithoutACommonPath) {
  const std::vector<std::string> names{"packing/time", "packing/step", "walls/time"};
  EXPECT_EQ(nearest("packing/tmie", names), "packing/time");
  EXPECT_EQ(nearest("paking/time", names), "packing/time");
  EXPECT_EQ(nearest("packing/nope", names), std::nullopt);
  EXPECT_EQ(nearest("time", names), std::nullopt);
  EXPECT_EQ(nearest("x", {}), std::nullopt);
}

TEST(Nearest, IsAQuestion) {
  const std::vector<std::string> names{"sand", "steel"};
  EXPECT_EQ(did_you_mean("snad", names), "; did you mean \"sand\"?");
  EXPECT_EQ(did_you_mean("water", names), "");
  const std::vector<std::string> laws{"hertz-mindlin", "linear-cohesive", "linear-rolling"};
  EXPECT_EQ(did_you_mean("hertz", laws), "; did you mean \"hertz-mindlin\"?");
  EXPECT_EQ(did_you_mean("mindlin", laws), "; did you mean \"hertz-mindlin\"?");
  EXPECT_EQ(did_you_mean("linear", laws), "") << "two have this word";
  EXPECT_EQ(did_you_mean("her", laws), "") << "not a word of a name";
  EXPECT_EQ(did_you_mean("snad", names, "allowed are sand, steel"), "; did you mean \"sand\"? Allowed are sand, steel");
  EXPECT_EQ(did_you_mean("water", names, "allowed are sand, steel"), "; allowed are sand, steel");
  EXPECT_EQ(fault_text("\"snad\"" + did_you_mean("snad", names), "sand"),
            "found \"snad\"; did you mean \"sand\"? Allowed is sand");
}

}  // namespace
}  // namespace grit
