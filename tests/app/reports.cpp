// Pages and pictures of runs, as the command line makes them.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "scenes.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

class Reports : public testing::Test {
 protected:
  Reports() { folder.write("two.json", two_grains); }
  Outcome grit(std::vector<std::string> words) const { return grit_in(folder.path(), std::move(words)); }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder / name); }
  std::string text(const std::string& name) const { return text_of(folder / name); }

  OwnFolder folder;
};

TEST_F(Reports, AreMadeAtTheEndOfARunUnlessSwitchedOff) {
  ASSERT_EQ(grit({"run", "two.json"}).status, 0);
  EXPECT_THAT(text("results/two/report.html"),
              AllOf(StartsWith("<!doctype html>"), HasSubstr("<h1>two grains</h1>"), HasSubstr(">done</span>")));
  const auto outcome = grit({"run", "two.json", "--overwrite", "--no-report"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, Not(HasSubstr("report")));
  EXPECT_FALSE(exists("results/two/report.html")) << "that of the run that was replaced";
}

TEST_F(Reports, SayWhyARunFailed) {
  EXPECT_EQ(grit({"run", "two.json", "--set", "/guards/travel=1e-6"}).status, 4);
  EXPECT_THAT(text("results/two/report.html"), AllOf(HasSubstr(">failed</span>"), HasSubstr("/guards/travel")));
}

TEST_F(Reports, AreMadeAgainFromOneOrSeveralFolders) {
  ASSERT_EQ(grit({"run", "two.json", "--no-report"}).status, 0);
  auto outcome = grit({"report", "results/two"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out, "report: results/two/report.html\n");
  EXPECT_THAT(outcome.err, IsEmpty());
  outcome = grit({"report", "results/two", "results/two", "--out", "both.html"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(text("both.html"), AllOf(HasSubstr("<h1>Runs side by side</h1>"), HasSubstr("\"results/two (1)\""),
                                       HasSubstr("\"results/two (2)\"")))
      << "or their curves would be one";
}

TEST_F(Reports, ReplaceOnlyTheirOwn) {
  ASSERT_EQ(grit({"run", "two.json", "--no-report"}).status, 0);
  const auto refused = grit({"report", "results/two", "--out", "two.json"});
  EXPECT_EQ(refused.status, 5);
  EXPECT_THAT(refused.err, HasSubstr("two.json: grit did not write this file"));
  EXPECT_EQ(text("two.json"), two_grains);
  for (const char* name : {"report.html", "curves.svg", "curves.png"}) {
    folder.write(std::string("results/two/") + name, "mine");
    const auto outcome =
        name == std::string("report.html") ? grit({"report", "results/two"}) : grit({"report", "--png", "results/two"});
    EXPECT_EQ(outcome.status, 5) << name;
    EXPECT_THAT(outcome.err, HasSubstr(std::string("results/two/") + name + ": grit did not write this file"));
    EXPECT_EQ(outcome.err.find("--out") == std::string::npos, name != std::string("report.html")) << outcome.err;
    EXPECT_EQ(text(std::string("results/two/") + name), "mine");
    std::filesystem::remove(folder / (std::string("results/two/") + name));
  }
  for (int twice = 0; twice < 2; ++twice) {
    EXPECT_EQ(grit({"report", "results/two"}).status, 0);
    EXPECT_EQ(grit({"report", "--png", "results/two"}).status, 0);
  }
  ASSERT_EQ(grit({"run", "two.json", "--overwrite", "--no-report"}).status, 0);
  for (const char* old : {"report.html", "curves.svg", "curves.png", "map-packing-stress.svg"})
    EXPECT_FALSE(exists(std::string("results/two/") + old)) << old << ": of the run that was replaced";
}

TEST_F(Reports, LeaveFilesBesideThem) {
  ASSERT_EQ(grit({"run", "two.json", "--no-report"}).status, 0);
  const std::vector<std::string> others{"results/two/curves.png.log", "results/two/curves.svg.part", "page.html.part"};
  for (const auto& other : others) folder.write(other, "mine");
  EXPECT_EQ(grit({"report", "--png", "results/two"}).status, 0);
  EXPECT_EQ(grit({"report", "results/two", "--out", "page.html"}).status, 0);
  EXPECT_THAT(text("page.html"), StartsWith("<!doctype html>"));
  EXPECT_TRUE(exists("results/two/curves.png"));
  for (const auto& other : others) EXPECT_EQ(text(other), "mine") << other;
}

TEST_F(Reports, SayWhatTheConverterSaid) {
  ASSERT_EQ(grit({"run", "two.json", "--no-report"}).status, 0);
  const auto fake = folder.write("bin/rsvg-convert", "#!/bin/sh\necho 'no fonts' >&2\nexit 1\n");
  std::filesystem::permissions(fake, std::filesystem::perms::owner_all);
  const auto outcome = Program({"env", "PATH=" + (folder / "bin").string() + ":/usr/bin:/bin", GRIT_BINARY, "report",
                                "--png", "results/two"},
                               folder.path())
                           .finish();
  EXPECT_EQ(outcome.status, 5);
  EXPECT_THAT(outcome.err, HasSubstr("results/two/curves.png: cannot be written: no fonts\n"));
}

TEST_F(Reports, NameWhatIsOmitted) {
  ASSERT_EQ(grit({"run", "two.json", "--no-report"}).status, 0);
  folder.write("results/two/run.json", "{");
  const auto outcome = grit({"report", "results/two"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err, "grit: omitted: results/two/run.json: is not the JSON of a run\n");
}

TEST_F(Reports, NeedFoldersOfRuns) {
  EXPECT_EQ(grit({"report"}).status, 1);
  EXPECT_THAT(grit({"report"}).err, HasSubstr("no folder of results was given"));
  const auto nothing = grit({"report", "nothing"});
  EXPECT_EQ(nothing.status, 5);
  EXPECT_THAT(nothing.err, HasSubstr("nothing: there is no such folder"));
  const auto other = grit({"report", "."});
  EXPECT_EQ(other.status, 5);
  EXPECT_THAT(other.err, HasSubstr("holds no run"));
  EXPECT_THAT(grit({"report", ".", "--png", "--out", "x.html"}).err, HasSubstr("--png writes into the folders"));
}

TEST_F(Reports, DrawPicturesWithoutABrowser) {
  ASSERT_EQ(grit({"run", "two.json", "--no-report"}).status, 0);
  const auto outcome = grit({"report", "--png", "results/two"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out,
            "picture: results/two/curves.png\npicture: results/two/grains.png\n"
            "picture: results/two/layers.png\n"
            "picture: results/two/map-packing-coordination_number.png\n"
            "picture: results/two/map-packing-solid_fraction.png\n"
            "picture: results/two/map-packing-stress.png\npicture: results/two/map-packing-void_ratio.png\n");
  for (const char* name : {"curves", "grains", "layers", "map-packing-stress"}) {
    EXPECT_THAT(text(std::string("results/two/") + name + ".png"), StartsWith("\x89PNG\r\n\x1a\n"));
    EXPECT_FALSE(exists(std::string("results/two/") + name + ".png.log"));
  }
  EXPECT_THAT(text("results/two/curves.svg"), HasSubstr("coordination number"));
  EXPECT_FALSE(exists("results/two/report.html"));
}

TEST_F(Reports, LayCurvesOfSeveralFoldersOverEachOther) {
  ASSERT_EQ(grit({"run", "two.json", "--no-report"}).status, 0);
  ASSERT_EQ(grit({"run", "two.json", "--no-report", "--out", "results/stiff", "--set",
                  "/materials/sand/contact_modulus=\"200 MPa\""})
                .status,
            0);
  const auto outcome = grit({"report", "--png", "results/two", "results/stiff"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("picture: results/stiff/curves.png\n"),
                                 HasSubstr("picture: results/two/curves-overlaid.png\n")));
  EXPECT_THAT(text("results/two/curves-overlaid.svg"), AllOf(HasSubstr(">two<"), HasSubstr(">stiff<")));
  EXPECT_THAT(text("results/two/curves.svg"), Not(HasSubstr(">two<")));
  EXPECT_FALSE(exists("results/stiff/curves-overlaid.svg"));
}

TEST_F(Reports, ListWhatDiffersBetweenRuns) {
  for (const char* modulus : {"100", "200"})
    ASSERT_EQ(grit({"run", "two.json", "--no-report", "--out", std::string("results/") + modulus, "--set",
                    std::string("/materials/sand/contact_modulus=") + modulus + " MPa"})
                  .status,
              0);
  ASSERT_EQ(grit({"report", "results/100", "results/200", "--out", "both.html"}).status, 0);
  EXPECT_THAT(text("both.html"), HasSubstr("<td class=\"name\">/materials/sand/contact_modulus</td>"
                                           "<td>100000000</td><td>200000000</td></tr>"))
      << "in SI, as a description without a scenario is compared with all defaults";

  // A guard stops them in the first step.
  folder.write("shear.json", R"({"extends": ")" GRIT_SOURCE_DIR R"(/sims/direct-shear/quick.json"})");
  folder.write("soft.json", R"({"extends": "shear.json", "scenario": {"normal_stress": "50 kPa"}})");
  for (const char* name : {"shear", "soft"})
    ASSERT_EQ(
        grit({"run", std::string(name) + ".json", "--no-report", "--set", "/guards/travel=1e-9", "--set", "/seed=3"})
            .status,
        4);
  ASSERT_EQ(grit({"report", "results/shear", "results/soft", "--out", "both.html"}).status, 0);
  const std::string html = text("both.html"), row = "<tr class=\"differs\">";
  EXPECT_THAT(html, HasSubstr(row + "<td class=\"name\">/scenario/normal_stress</td><td>200 kPa</td>"
                                    "<td>50 kPa</td></tr>"));
  EXPECT_EQ(html.find(row), html.rfind(row)) << "what follows from the scenario is not listed";
}

TEST_F(Reports, DrawTheOthersWhereAFolderIsBad) {
  for (const std::string name : {"two", "three"})
    ASSERT_EQ(grit({"run", "two.json", "--no-report", "--out", "results/" + name}).status, 0);
  folder.write("results/empty/notes.txt", "");
  auto outcome = grit({"report", "--png", "nothing", "results/two", "results/empty", "results/three"});
  EXPECT_EQ(outcome.status, 5);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("grit: nothing: there is no such folder; give one that 'grit run' has written\n"),
                    HasSubstr("grit: results/empty: holds no run")));
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("picture: results/two/grains.png\n"), HasSubstr("picture: results/three/grains.png\n"),
                    HasSubstr("picture: results/two/curves-overlaid.png\n")));
  EXPECT_TRUE(exists("results/three/curves.png"));
}

TEST_F(Reports, ShowTheOthersWhereAFolderIsBad) {
  for (const std::string name : {"two", "three"})
    ASSERT_EQ(grit({"run", "two.json", "--no-report", "--out", "results/" + name}).status, 0);
  folder.write("results/empty/notes.txt", "");
  auto outcome = grit({"report", "nothing", "results/empty", "results/two", "results/three"});
  EXPECT_EQ(outcome.status, 5);
  EXPECT_THAT(outcome.err,
              AllOf(StartsWith("grit: nothing: there is no such folder; give one that 'grit run' has written\n"
                               "grit: results/empty: holds no run"),
                    HasSubstr("give a folder that 'grit run' has written\n")));
  EXPECT_EQ(outcome.out, "report: results/two/report.html\n") << "in the first that holds a run";
  EXPECT_THAT(text("results/two/report.html"),
              AllOf(HasSubstr("<h1>Runs side by side</h1>"), HasSubstr("two</th>"), HasSubstr("three</th>"),
                    HasSubstr("<li>nothing: there is no such folder")));
  EXPECT_FALSE(exists("nothing"));
  EXPECT_FALSE(exists("results/empty/report.html"));

  outcome = grit({"report", "results/two", "nothing", "--out", "one.html"});
  EXPECT_EQ(outcome.status, 5);
  EXPECT_THAT(text("one.html"), HasSubstr("<h1>two grains</h1>"));

  outcome = grit({"report", "nothing", "results/empty", "--out", "none.html"});
  EXPECT_EQ(outcome.status, 5);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("nothing: there is no such folder"), HasSubstr("empty: holds no run")));
  EXPECT_FALSE(exists("none.html"));
}

TEST_F(Reports, FailWhereNothingOfARunCanBeRead) {
  folder.write("results/half/run.json", "{");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"report", "--png", "results/half"}, {"report", "results/half"}}) {
    const auto outcome = grit(words);
    EXPECT_EQ(outcome.status, 5);
    EXPECT_THAT(outcome.err, HasSubstr("results/half/run.json: is not the JSON of a run, and there is neither"));
    EXPECT_EQ(outcome.out, "");
  }
  folder.write("results/half/series.h5", "");
  const auto outcome = grit({"report", "--png", "results/half"});
  EXPECT_EQ(outcome.status, 5);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("grit: results/half: holds nothing that can be drawn\n"),
                                 HasSubstr("grit: omitted: results/half/run.json: is not the JSON of a run\n"),
                                 HasSubstr("grit: omitted: results/half/series.h5")));
}

TEST_F(Reports, DrawTheOtherPicturesWhereAFrameIsDamaged) {
  ASSERT_EQ(grit({"run", "two.json", "--no-report"}).status, 0);
  // Its attributes remain; they name the stage, from which the layers start.
  ASSERT_EQ(shell(folder.path(),
                  "/usr/bin/python3 -c 'import h5py; del h5py.File(\"results/two/frames/000000.h5\", "
                  "\"r+\")[\"bodies/radius\"]'")
                .status,
            0);
  const auto outcome = grit({"report", "--png", "results/two"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("grit: omitted: results/two/frames/000000.h5"));
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("grains.png"), HasSubstr("map-packing-stress.png"), Not(HasSubstr("layers.png"))));
}

// An unbounded plane, such as most floors, has no triangles of its own.
TEST_F(Reports, DrawPlanesWithoutAnExtent) {
  const auto drawn = [&](const std::string& wall) {
    EXPECT_EQ(grit({"run", "two.json", "--no-report", "--overwrite", "--set", "/walls/floor=" + wall}).status, 0);
    EXPECT_EQ(grit({"report", "--png", "results/two"}).status, 0);
    return text("results/two/grains.svg");
  };
  const std::string line = "class=\"wall\"";
  EXPECT_THAT(drawn(R"({"type": "plane", "point": [0, 0, "-1.5 mm"], "normal": [0, 0, 1], "material": "sand"})"),
              HasSubstr(line));
  EXPECT_THAT(drawn(R"({"type": "plane", "point": [0, 0, "-1.5 mm"], "normal": [0, 1, 1], "material": "sand"})"),
              Not(HasSubstr(line)))
      << "it is not normal to an axis";
}

// The drawn extent of such a plane depends on the bodies. They are read only once, as a pipe cannot be read again.
TEST_F(Reports, DrawPlanesAroundAPackingThatIsPiped) {
  const auto outcome =
      shell(folder.path(),
            "printf '0 0 0 0.001\\n0.002 0 0 0.001\\n' | \"" GRIT_BINARY
            "\" run two.json --no-report --set '/bodies/grains/source={\"type\": \"file\", \"path\": \"/dev/stdin\"}' "
            "--set '/walls/floor={\"type\": \"plane\", \"point\": [0, 0, -0.0015], \"normal\": [0, 0, 1], "
            "\"material\": \"sand\"}'");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(grit({"report", "--png", "results/two"}).status, 0);
  EXPECT_THAT(text("results/two/grains.svg"), HasSubstr("class=\"wall\""));
}

TEST_F(Reports, SayThatTheConverterIsMissing) {
  ASSERT_EQ(grit({"run", "two.json", "--no-report"}).status, 0);
  const auto outcome = shell(folder.path(), "PATH=/nowhere \"" GRIT_BINARY "\" report --png results/two");
  EXPECT_EQ(outcome.status, 5);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("rsvg-convert"), HasSubstr("librsvg2-bin")));
}

TEST_F(Reports, HaveWhatCurvesAreComparedWith) {
  folder.write("measured.csv", "u,ratio\n0,0\n0.1,0.5\n");
  const std::string curve =
      R"({"of": "packing/mean_stress", "curve": {"file": "measured.csv", "x": "u", "y": "ratio"}})";
  ASSERT_EQ(grit({"run", "two.json", "--set", "/output/references/measured=" + curve}).status, 0);
  EXPECT_THAT(text("results/two/report.html"),
              HasSubstr(R"("references":[{"name":"measured","of":"packing/mean_stress")"));
  const auto json = nlohmann::json::parse(text("results/two/run.json"));
  EXPECT_EQ(json.at("references").at("measured").dump(), R"({"x":[0.0,0.1],"y":[0.0,0.5]})");
  std::filesystem::remove(folder / "measured.csv");
  EXPECT_EQ(grit({"report", "results/two"}).err, "") << "the run has kept the curve";

  const auto refused = [&](const std::string& reference) {
    return grit({"run", "two.json", "--out", "refused", "--set", "/output/references/it=" + reference});
  };
  auto outcome = refused(R"({"of": "packing/nothing", "value": 1})");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--set: /output/references/it/of: found \"packing/nothing\""));
  outcome = refused(R"({"of": "packing/mean_stress", "curve": {"file": "nothing.csv", "x": "u", "y": "ratio"}})");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("--set: /output/references/it/curve/file: "), HasSubstr("nothing.csv: cannot be read")));
  folder.write("measured.csv", "u,ratio\n0,0\n0.1,0.5\n");
  outcome = refused(R"({"of": "packing/mean_stress", "curve": {"file": "measured.csv", "x": "w", "y": "ratio"}})");
  EXPECT_THAT(outcome.err, HasSubstr("measured.csv:1: there is no column \"w\""));
}

}  // namespace
}  // namespace grit
