// Descriptions that cannot be read: exit status 2, or 5 without the file. Every problem has its place and what is
// allowed.
#include <gmock/gmock.h>

#include <filesystem>
#include <string>
#include <vector>

#include "scenes.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

TEST(Descriptions, AllProblemsAreReportedAtOnceWithTheirLocations) {
  const OwnFolder folder;
  folder.write("bad.json", R"({
  "contacts": {"type": "linear-roling"},
  "materials": {"sand": {"density": "2600 kPa"}},
  "bodies": {"grains": {"type": "sphere", "materials": "sand", "source": {"type": "list", "bodies": [
    {"position": [0, 0, 0], "radius": "-1 mm"}
  ]}}},
  "walls": {"floor": {"type": "plane", "material": "steel"}},
  "stages": [{"name": "wait", "until": {"type": "step", "value": 200}, "limit": "1 s"}]
}
)");
  for (const char* command : {"run", "check", "expand"}) {
    const auto outcome = grit_in(folder.path(), {command, "bad.json"});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.out, IsEmpty());
    // file:line, pointer, found, nearest, allowed
    EXPECT_THAT(
        outcome.err,
        AllOf(
            HasSubstr("bad.json:2: /contacts/type: unknown contact \"linear-roling\"; did you mean \"linear-rolling\"? "
                      "Allowed are capillary, hertz-mindlin, jkr, linear-cohesive, linear-frictional, linear-rolling; "
                      "searched: " GRIT_PLUGIN_DIR
                      "/contacts; --plugin-path DIR or GRIT_PLUGIN_PATH=DIR adds DIR/contacts\n"),
            HasSubstr("bad.json:3: /materials/sand/density: "), HasSubstr("kPa"), HasSubstr("kg/m^3"),
            HasSubstr("bad.json:4: /bodies/grains/materials: "), HasSubstr("\"material\""),
            HasSubstr("bad.json:5: /bodies/grains/source/bodies/0/radius: found -1 mm; allowed is above 0 mm"),
            HasSubstr("bad.json:7: /walls/floor/material: found the material \"steel\", which is not defined"),
            HasSubstr("bad.json:8: /stages/0/until/type: unknown condition \"step\"; did you mean \"steps\"?"),
            EndsWith("problems in the description\n")));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "results"));
}

TEST(Descriptions, KeysOfAFileAreSuggestedAndListed) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto problems = [&](const std::string& text, std::vector<std::string> sets = {}) {
    folder.write("bad.json", text);
    std::vector<std::string> words{"check", "bad.json"};
    for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
    const auto outcome = grit_in(folder.path(), words);
    EXPECT_EQ(outcome.status, 2);
    return outcome.err;
  };
  const std::string all =
      "? Allowed are title, seed, contacts, materials, interfaces, domain, bodies, begin, walls, engines, specimen, "
      "time_step, "
      "guards, stages, probes, output, scenario, extends\ngrit: 1 problem in the description\n";
  EXPECT_EQ(problems("{\n\"scenaro\": {\"type\": \"direct-shear\"},\n\"walls\": {\"platen\": {}}}"),
            "bad.json:2: /scenaro: unknown key \"scenaro\"; did you mean \"scenario\"" + all)
      << "what the scenario would give is not missing";
  EXPECT_EQ(problems("{\"extend\": \"two.json\"}"),
            "bad.json:1: /extend: unknown key \"extend\"; did you mean \"extends\"" + all);
  EXPECT_THAT(problems("{\"extra\": 1}"), AllOf(HasSubstr("unknown key \"extra\""), HasSubstr("scenario, extends\n"),
                                                HasSubstr("missing key \"stages\"")));
  EXPECT_THAT(
      problems(two_grains, {"/extends=two.json"}),
      HasSubstr("--set: /extends: found \"extends\", which has an effect in a file only; write it in the file\n"));
}

TEST(Descriptions, NamesThatAreMeantAreSuggested) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto problem = [&](const std::string& set) {
    const auto outcome =
        grit_in(folder.path(), {"check", "two.json", "--set",
                                R"(/walls={"bottom": {"type": "plane", "point": [0, 0, "-5 mm"], "material": "sand"}})",
                                "--set", set});
    EXPECT_EQ(outcome.status, 2) << set;
    EXPECT_THAT(outcome.err, HasSubstr("1 problem")) << set;
    return outcome.err;
  };
  EXPECT_THAT(problem("/bodies/grains/material=snad"),
              HasSubstr("/bodies/grains/material: found the material \"snad\", which is not defined; did you mean "
                        "\"sand\"? Allowed is one of sand\n"));
  EXPECT_THAT(problem(R"(/stages/0/until={"type": "pressure", "wall": "botom", "value": 1})"),
              HasSubstr("/stages/0/until/wall: found the wall \"botom\", which is not defined; did you mean "
                        "\"bottom\"? Allowed is one of bottom\n"));
  EXPECT_THAT(problem(R"(/probes/packing/stages=["prat"])"),
              HasSubstr("/probes/packing/stages/0: found the stage \"prat\", which is not defined; did you mean "
                        "\"part\"? Allowed is one of part\n"));
  EXPECT_THAT(
      problem(R"(/stages/0/change={"walls": {"botom": {"point": [0, 0, 0]}}})"),
      HasSubstr("/stages/0/change/walls/botom: found a wall that does not exist at the start of the run; did you "
                "mean \"bottom\"? Allowed are the walls of /walls: bottom. Define it there"));
  EXPECT_THAT(problem(R"(/stages/0/change={"wals": {}})"),
              HasSubstr("/stages/0/change/wals: found a change of \"wals\"; did you mean \"walls\"? Allowed is one of "
                        "materials, "));
  EXPECT_THAT(
      problem(R"(/stages/0/ramps=[{"pointer": "/walls/botom/motion/velocity/2", "from": 0, "to": 1, "duration": 1}])"),
      HasSubstr("/stages/0/ramps/0/pointer: found \"botom\", which is not defined in /walls; did you mean "
                "\"bottom\"? Allowed is one of bottom\n"));
  EXPECT_THAT(
      problem(R"(/stages/0/ramps=[{"pointer": "/wals/bottom/motion/velocity/2", "from": 0, "to": 1, "duration": 1}])"),
      HasSubstr("/stages/0/ramps/0/pointer: found \"/wals/bottom/motion/velocity/2\"; did you mean \"walls\"? "
                "Allowed is a JSON pointer below one of materials, "));
  EXPECT_THAT(problem(R"(/domain={"low": [0, 0, 0], "open_sides": ["-X"]})"),
              HasSubstr("/domain/open_sides/0: found \"-X\"; did you mean \"-x\"? Allowed is one of -x, "));
  EXPECT_THAT(
      problem(R"(/output/summary=["packing/void_rato"])"),
      HasSubstr("/output/summary/0: found \"packing/void_rato\", which is not a scalar channel of any probe; did "
                "you mean \"packing/void_ratio\"? Allowed is one of packing/time, "));
}

TEST(Descriptions, FilesOfAnotherKindAreToldFromWhatACommandTakes) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  folder.write("study.json", R"({
  "scene": "two.json",
  "settings": {"density": {"pointers": ["/materials/sand/density"], "values": [1000, 2000], "usual": "1000"}}
}
)");
  folder.write("fit.json", R"({
  "title": "fit",
  "base": "two.json",
  "parameters": {"density": {"pointers": ["/materials/sand/density"], "range": [1000, 2000]}},
  "targets": {"energy": {"type": "last", "of": "packing/kinetic_energy", "value": 1, "tolerance": 0.1}}
}
)");
  const auto refused = [&](const char* command, const char* file, const std::string& why) {
    const auto outcome = grit_in(folder.path(), {command, file});
    EXPECT_EQ(outcome.status, 2) << command;
    EXPECT_THAT(outcome.err, HasSubstr(why + "\ngrit: 1 problem")) << command;
  };
  const std::string study = "study.json:2: /scene: found a study; allowed is ",
                    use_study = ". 'grit study study.json' runs a study; with --dry-run it lists the runs",
                    fit = "fit.json:3: /base: found a calibration; allowed is ",
                    use_fit =
                        ". 'grit calibrate fit.json' runs a calibration; with --dry-run it prints the number of runs",
                    a_study = "a study, which names a description in \"scene\" and varies it",
                    a_calibration = "a calibration, which names a description in \"base\" and the parameters to find";
  for (const char* command : {"run", "check", "expand"}) {
    refused(command, "study.json", study + "a description" + use_study);
    refused(command, "fit.json", fit + "a description" + use_fit);
  }
  refused("study", "fit.json", fit + a_study + use_fit);
  refused("calibrate", "study.json", study + a_calibration + use_study);
  const std::string description = "/contacts: found a description of a simulation; allowed is ";
  refused("study", "two.json", description + a_study + ". 'grit run two.json' runs this one");
  refused("calibrate", "two.json", description + a_calibration + ". 'grit run two.json' runs this one");
}

TEST(Descriptions, OneProblemIsOneLineAndTheCount) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto outcome = grit_in(folder.path(), {"run", "two.json", "--set", "/seed=x"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(StartsWith("--set: /seed: found the text \"x\"; allowed is an integer"),
                                 EndsWith("\ngrit: 1 problem in the description\n")));
}

TEST(Descriptions, SetsAreCheckedToo) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto said = [&](const std::string& set) {
    const auto outcome = grit_in(folder.path(), {"check", "two.json", "--set", set});
    EXPECT_EQ(outcome.status, 2);
    return outcome.err;
  };
  EXPECT_THAT(said("nonsense"), HasSubstr("found \"nonsense\"; allowed is /pointer=value"));
  EXPECT_THAT(said("/stages/7/name=x"), HasSubstr("no entry \"7\" in /stages, which has 1"));
  EXPECT_THAT(said("/guards/overlaps=1"),
              AllOf(HasSubstr("--set: /guards/overlaps"), HasSubstr("did you mean \"overlap\"?")));
}

TEST(Descriptions, FilesThatAreNoDescriptionsAreRefused) {
  const OwnFolder folder;
  folder.write("empty.json", "");
  folder.write("comma.json", "{\n  \"seed\": 1,\n}\n");
  folder.write("list.json", "[]");
  folder.write("nothing.json", "{}");
  folder.write("child.json", R"({"extends": "parent.json"})");
  const auto said = [&](const char* file) {
    const auto outcome = grit_in(folder.path(), {"run", file});
    EXPECT_EQ(outcome.status, 2) << file;
    return outcome.err;
  };
  EXPECT_THAT(said("empty.json"), HasSubstr("empty.json:1: not JSON"));
  EXPECT_THAT(said("comma.json"), HasSubstr("comma.json:3: not JSON"));
  EXPECT_THAT(said("list.json"), HasSubstr("list.json:1: found a list; a description is an object"));
  EXPECT_THAT(said("nothing.json"), AllOf(HasSubstr("missing key \"contacts\""), HasSubstr("missing key \"stages\"")));
  EXPECT_THAT(said("child.json"), HasSubstr("parent.json"));
}

TEST(Descriptions, FilesThatCannotBeReadEndWithStatus5) {
  const OwnFolder folder;
  std::filesystem::create_directory(folder / "directory.json");
  auto outcome = grit_in(folder.path(), {"run", "missing.json"});
  EXPECT_EQ(outcome.status, 5);
  EXPECT_THAT(outcome.err, HasSubstr("missing.json: cannot be read: No such file or directory"));
  outcome = grit_in(folder.path(), {"run", "directory.json"});
  EXPECT_EQ(outcome.status, 5);
  EXPECT_THAT(outcome.err, HasSubstr("directory.json: cannot be read: Is a directory"));
}

TEST(Descriptions, FilesThatTheyNameAreRefusedWithTheirKey) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto refused = [&](const std::string& set, const std::string& pointer, const std::string& file) {
    for (const char* command : {"check", "run"}) {
      const auto outcome = grit_in(folder.path(), {command, "two.json", "--set", set});
      EXPECT_EQ(outcome.status, 2) << command << ' ' << set;
      EXPECT_THAT(outcome.err,
                  AllOf(HasSubstr("--set: " + pointer + ": "), HasSubstr(file),
                        HasSubstr("cannot be read: No such file or directory"), HasSubstr("; allowed is ")))
          << command;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "results")) << set;
  };
  const std::string group = R"(/bodies/more={"type": "sphere", "material": "sand", )";
  refused(group + R"("source": {"type": "file", "path": "no.txt"}})", "/bodies/more/source/path", "no.txt");
  refused(group + R"("stage": "part", "source": {"type": "file", "path": "no.txt"}})", "/bodies/more/source/path",
          "no.txt");
  refused(group + R"("source": {"type": "cloud", "count": 3, "sizes": {"type": "list", "diameters": [0.001]},
                                "region": {"type": "mesh", "path": "no.stl", "scale": 1}}})",
          "/bodies/more/source/region/path", "no.stl");
  refused(R"(/bodies/more={"type": "clump", "material": "sand", "shape": {"type": "file", "path": "no.txt"},
             "source": {"type": "list", "bodies": [{"position": [1, 1, 1], "radius": 0.001}]}})",
          "/bodies/more/shape/path", "no.txt");
  refused(R"(/walls={"chute": {"type": "mesh", "path": "no.stl", "scale": 1, "material": "sand"}})",
          "/walls/chute/path", "no.stl");
  refused(R"(/output/references={"lab": {"of": "packing/kinetic_energy",
             "curve": {"file": "no.csv", "x": "time", "y": "energy"}}})",
          "/output/references/lab/curve/file", "no.csv");
}

}  // namespace
}  // namespace grit
