// Descriptions that cannot be run: exit status 2. Output of `check`, `expand` and `schema` for those that can.
#include <gmock/gmock.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "scenes.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using nlohmann::json;
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

TEST(Descriptions, AStudyIsDistinguishedFromADescription) {
  const OwnFolder folder;
  folder.write("study.json", R"({
  "scene": "two.json",
  "settings": {"density": {"pointers": ["/materials/sand/density"], "values": [1000, 2000], "usual": "1000"}}
}
)");
  for (const char* command : {"run", "check", "expand"}) {
    const auto outcome = grit_in(folder.path(), {command, "study.json"});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, HasSubstr("study.json:2: /scene: found a study; allowed is a description. "
                                       "'grit study study.json' runs a study; with --dry-run it lists the runs\n"));
  }
}

TEST(Descriptions, CheckReportsMotionsWithoutEffect) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto check = [&](const std::string& lid, const std::string& floor = "{}", const std::string& stages = "") {
    const std::string shape = R"({"type": "plane", "material": "sand", "point": [0, 0, "-5 mm"], "normal": [0, 0, 1]})";
    std::vector<std::string> words{"check", "two.json",
                                   "--set", "/walls={\"lid\": " + shape + ", \"floor\": " + shape + "}",
                                   "--set", "/walls/lid/motion=" + lid,
                                   "--set", "/walls/floor/motion=" + floor};
    if (!stages.empty()) words.insert(words.end(), {"--set", stages});
    const auto outcome = grit_in(folder.path(), words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  const std::string moves = R"({"velocity": [0, 0, "1 mm/s"]})",
                    follows = R"({"follow": {"wall": "lid", "axes": "z"}})";
  EXPECT_THAT(
      check(R"({"ramp_time": "1 ms"})"),
      HasSubstr(
          "  /walls/lid/motion/ramp_time: neither the wall nor its surface has a velocity, spin or oscillation\n"));
  EXPECT_THAT(check(R"({"surface_velocity": ["1 m/s", 0, 0], "ramp_time": "1 us"})"),
              testing::Not(HasSubstr("/motion/")));
  const std::string brief = R"(/stages/0/until={"type": "time", "value": "0.5 ms"})";
  EXPECT_THAT(check(R"({"velocity": [0, 0, "1 mm/s"], "ramp_time": "1 ms"})", "{}", brief),
              HasSubstr("  /walls/lid/motion/ramp_time: the wall never reaches its full speed: the ramp takes 0.001 s, "
                        "the stage \"part\" at most 0.0005 s"));
  EXPECT_THAT(check(R"({"ramp_time": "1 s"})", "{}",
                    R"(/stages/0={"name": "part", "until": {"type": "time", "value": "1 ms"}, "limit": "1 s", "change":
                       {"walls": {"lid": {"motion": {"velocity": [0, 0, "1 mm/s"], "ramp_time": "0.1 ms"}}}}})"),
              testing::Not(HasSubstr("ramp_time")))
      << "the stage has a shorter one";
  EXPECT_THAT(check(R"({"velocity": [0, 0, "1 mm/s"], "ramp_time": "0.4 ms"})", "{}", brief),
              testing::Not(HasSubstr("ramp_time")));
  EXPECT_THAT(
      check(R"({"oscillation": {"amplitude": [0, 0, "1 mm"], "angle": ["1 deg", 0, 0], "frequency": "10 Hz",
                                        "amplitude_phase": ["1 rad", 0, "1 rad"], "angle_phase": [0, "1 rad", 0]}})"),
      HasSubstr("  /walls/lid/motion/oscillation/amplitude_phase: it has a component along x, where amplitude is "
                "0\n  /walls/lid/motion/oscillation/angle_phase: it has a component along y, where angle is "
                "0\n"));
  EXPECT_THAT(
      check(R"({"free": {"axes": "z", "mass": 1, "load": [0, "1 N", "1 N"]}})"),
      HasSubstr("  /walls/lid/motion/free/load: it has a component along y, along which the wall is not free\n"));
  EXPECT_THAT(
      check(R"({"spin": [0, 0, "1 rad/s"]})", follows),
      HasSubstr("  /walls/floor/motion/follow: the wall \"lid\" does not move along z; rotation is not followed\n"));
  EXPECT_THAT(check(moves, follows), testing::Not(HasSubstr("/motion/")));
  EXPECT_THAT(check("{}", follows, R"(/stages/0/change={"walls": {"lid": {"motion": )" + moves + "}}}"),
              testing::Not(HasSubstr("/motion/")))
      << "it moves later";
}

TEST(Descriptions, CheckEstimatesFromTypicalTimesOfStages) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto check = [&](const std::string& set) {
    const auto outcome = grit_in(folder.path(), {"check", "two.json", "--threads", "1", "--set",
                                                 R"(/stages/0/until={"type": "unbalanced-force", "below": 0.01})",
                                                 "--set", "/stages/0/limit=36000 s", "--set", set});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  const auto found = [](const std::string& text, const std::string& pattern) {
    std::smatch match;
    EXPECT_TRUE(std::regex_search(text, match, std::regex(pattern))) << text;
    return match.empty() ? -1.0 : std::stod(match[1]);
  };
  const std::string usual = check("/stages/0/typical_time=3600 s"), unusual = check("/seed=2");
  EXPECT_THAT(usual, HasSubstr("part            usually 3600 s, "));
  EXPECT_THAT(usual, HasSubstr(" (ends by its condition, 36000 s at most)\n"));
  EXPECT_THAT(unusual, HasSubstr("part            at most 36000 s, "));
  const double hours = found(usual, "particle-steps/s: ([0-9.]+) h");
  EXPECT_GT(hours, 0);
  EXPECT_NEAR(found(usual, "at most ([0-9.]+) h "), 10 * hours, 0.06);
  EXPECT_NEAR(found(unusual, "at most ([0-9.]+) h "), 10 * hours, 0.06);
  EXPECT_EQ(found(unusual, "particle-steps/s: ([0-9.]+) h"), 0) << "nothing is known of it";
}

TEST(Descriptions, CheckReportsSettingsWithoutEffect) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto check = [&](std::vector<std::string> sets) {
    std::vector<std::string> words{"check", "two.json"};
    for (const auto& set : sets) words.insert(words.end(), {"--set", set});
    const auto outcome = grit_in(folder.path(), words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  EXPECT_THAT(check({}), testing::Not(HasSubstr("without effect")));
  const auto idle =
      check({R"(/engines/damping={"type": "local-damping", "coefficient": 0})", R"(/engines/hold={"type": "hold"})",
             "/seed=7", R"(/engines/scaling={"type": "density-scaling", "below": "2 mm"})",
             "/bodies/grains/overlap=0.02", "/time_step/value=1e-9", "/time_step/safety=0.5", "/materials/steel={}",
             "/materials/steel/density=7800", R"(/probes/idle={"type": "packing"})",
             R"(/output/picture={"x": "packing/time", "y": ["packing/kinetic_energy"]})"});
  EXPECT_THAT(
      idle,
      AllOf(HasSubstr("\nwithout effect\n"), HasSubstr("  /engines/damping: it has no effect with these values\n"),
            HasSubstr("  /output/picture/color: rotations are held"), HasSubstr("  /seed: nothing is random"),
            HasSubstr("  /engines/scaling/below: no body is smaller\n"),
            HasSubstr("  /bodies/grains/overlap: it applies to bodies inserted by a stage"),
            HasSubstr("  /time_step/safety: the step is given"), HasSubstr("  /materials/steel: no body"),
            HasSubstr("  /probes/idle: it never samples")));
  const std::string stream = R"(/bodies/poured={"type": "sphere", "material": "sand", "source": {"type": "stream",
      "number_rate": 100, "region": {"type": "disc", "centre": [0, 0, "5 cm"], "radius": "1 cm"},
      "sizes": {"type": "uniform", "smallest": "1 mm", "largest": "2 mm"}}})";
  EXPECT_THAT(check({"/seed=7", stream}), testing::Not(HasSubstr("nothing is random")));
  EXPECT_THAT(idle, testing::Not(HasSubstr("/engines/hold")));
  EXPECT_THAT(idle, testing::Not(HasSubstr("/materials/steel/"))) << "reported with the material";
  const std::string turning = R"(/probes/turns={"type": "rotations", "every_time": "3 s"})";
  const std::string smooth = "/materials/sand/friction_angle=0", law = "/contacts/type=linear-frictional";
  EXPECT_THAT(check({turning, smooth}),
              AllOf(HasSubstr("  /probes/turns: it samples rotations, but without friction spheres do not rotate"),
                    HasSubstr("  /probes/turns/every_time: 3 s is longer than its stages, 1 s at most")));
  EXPECT_THAT(check({turning, "/probes/turns/every_time=0.9 s"}), testing::Not(HasSubstr("without effect")));
  const std::string late = R"(/bodies/late={"type": "sphere", "material": "sand", "stage": "part", "source":
      {"type": "list", "bodies": [{"position": [0, "5 mm", 0], "radius": "1 mm"}]}})";
  const std::string spinning = "/bodies/late/source/bodies/0/spin=[0, 0, 1]";
  EXPECT_THAT(check({turning, smooth, late}), HasSubstr("spheres do not rotate"));
  EXPECT_THAT(check({turning, smooth, late, spinning}), testing::Not(HasSubstr("spheres do not rotate")))
      << "it comes with a spin";
  const std::string bottom = R"(/walls/bottom={"type": "plane", "point": [0, 0, "-2 mm"], "material": "sand"})";
  const auto moved = [](const std::string& motion) {
    return R"(/stages/0/change={"walls": {"bottom": {"motion": )" + motion + "}}}";
  };
  EXPECT_THAT(check({turning, smooth, bottom, moved(R"({"velocity": [0, 0, 1e-3]})")}),
              HasSubstr("spheres do not rotate"));
  EXPECT_THAT(check({turning, smooth, bottom, moved(R"({"spin": [0, 0, 1]})")}),
              testing::Not(HasSubstr("spheres do not rotate")));
  EXPECT_THAT(
      check({turning, smooth, R"(/materials/steel={"friction_angle": 0.5})", bottom, "/walls/bottom/material=steel"}),
      HasSubstr("spheres do not rotate"))
      << "the smaller friction counts";
  EXPECT_THAT(check({turning, smooth, R"(/stages/0/change={"materials": {"sand": {"friction_angle": 0.3}}})"}),
              testing::Not(HasSubstr("spheres do not rotate")));
  EXPECT_THAT(check({turning, "/materials/sand/shear_to_normal_stiffness=0"}), HasSubstr("spheres do not rotate"));
  EXPECT_THAT(check({smooth, "/materials/sand/rolling_stiffness=1", "/materials/sand/rolling_limit=0.3"}),
              AllOf(HasSubstr("  /materials/sand/rolling_stiffness: without friction spheres do not rotate, so that "
                              "the moment is 0\n"),
                    HasSubstr("  /materials/sand/rolling_limit: without friction spheres do not rotate")));
  EXPECT_THAT(check({law, smooth, "/contacts/shear_damping=true"}),
              HasSubstr("  /contacts/shear_damping: without friction there is no shear force"));
  EXPECT_THAT(check({law, "/contacts/shear_damping=true"}), testing::Not(HasSubstr("without effect")));
  EXPECT_THAT(check({"/materials/sand/rolling_stiffness=1", "/materials/sand/rolling_limit=0"}),
              HasSubstr("  /materials/sand/rolling_stiffness: rolling_limit is 0, so that the moment is 0"));
  EXPECT_THAT(check({"/materials/sand/rolling_limit=0"}), testing::Not(HasSubstr("without effect")));
  EXPECT_THAT(check({"/materials/sand/rolling_stiffness=0", "/materials/sand/rolling_limit=0.3"}),
              HasSubstr("  /materials/sand/rolling_limit: rolling_stiffness is 0, so that the moment is 0"));
  EXPECT_THAT(check({"/materials/sand/rolling_stiffness=0", R"(/materials/steel={"rolling_stiffness": 0})",
                     R"(/interfaces/sand+steel={"rolling_limit": 0.3})"}),
              AllOf(HasSubstr("  /interfaces/sand+steel/rolling_limit: rolling_stiffness is 0"),
                    HasSubstr("  /interfaces/sand+steel: sand and steel never come into contact\n")));
  const std::string floor = R"(/walls/floor={"type": "plane", "point": [0, 0, "-2 mm"], "material": "steel"})";
  const std::string own = R"(/interfaces/sand+sand={"friction_angle": 0.3})";
  EXPECT_THAT(check({"/materials/steel={}", floor, own, R"(/interfaces/sand+steel={"friction_angle": 0.3})"}),
              testing::Not(HasSubstr("without effect")));
  EXPECT_THAT(check({"/materials/steel={}", floor, R"(/interfaces/steel+steel={"friction_angle": 0.3})"}),
              HasSubstr("  /interfaces/steel+steel: no two bodies or walls of steel come into contact\n"));
  EXPECT_THAT(check({R"(/output/frames={"every_time": 1e-12})"}),
              HasSubstr("  /output/frames/every_time: 1e-12 s is shorter than the time step, "));
  EXPECT_THAT(check({R"(/output/frames={"every_time": 1e-3})"}), testing::Not(HasSubstr("without effect")));
  EXPECT_THAT(check({R"(/engines/damping={"type": "local-damping", "coefficient": 0})",
                     R"(/stages/0/change={"engines": {"damping": {"coefficient": 0.3}}})"}),
              testing::Not(HasSubstr("without effect")))
      << "a stage switches it on";
  const std::string held = R"(/engines/hold={"type": "hold"})",
                    damped = R"(/engines/damping={"type": "local-damping"})";
  const auto later = [](const std::string& engines) { return R"(/stages/0/change={"engines": )" + engines + '}'; };
  const auto turns_not =
      HasSubstr("  /probes/turns: it samples rotations, but rotations are held, so that they are all 0\n");
  EXPECT_THAT(check({turning, held, damped, later(R"({"damping": {"coefficient": 0.3}})")}), turns_not)
      << "a stage changes another engine";
  EXPECT_THAT(check({turning, held, later(R"({"hold": {"rotation": "none"}})")}), testing::Not(turns_not));
  EXPECT_THAT(
      check({"/time_step/value=1e-9", "/time_step/safety=0.5", R"(/stages/0/change={"time_step": {"value": null}})"}),
      testing::Not(HasSubstr("/time_step/safety")));
  EXPECT_THAT(check({"/materials/sand/rolling_stiffness=1", "/materials/sand/rolling_limit=0",
                     R"(/stages/0/change={"interfaces": {"sand+sand": {"rolling_limit": 0.3}}})"}),
              testing::Not(HasSubstr("the moment is 0")));
  EXPECT_THAT(check({"/time_step/allow_unstable=true"}), HasSubstr("  /time_step/allow_unstable: with this safety"));
  EXPECT_THAT(check({"/time_step/allow_unstable=true", "/time_step/safety=1.1"}),
              testing::Not(HasSubstr("without effect")));
  const std::string planar = R"(/engines/planar={"type": "planar", "normal": "z"})";
  const auto gravity = [](const std::string& g) {
    return R"(/engines/weight={"type": "gravity", "acceleration": )" + g + '}';
  };
  EXPECT_THAT(check({planar, gravity("[0, 0, -9.81]")}),
              HasSubstr("  /engines/weight: bodies are held along the axis on which it acts\n"));
  EXPECT_THAT(check({planar, gravity("[0, -1, -9.81]")}), testing::Not(HasSubstr("without effect")));
  EXPECT_THAT(check({planar, gravity("[0, 0, -9.81]"), later(R"({"planar": {"normal": "y"}})")}),
              testing::Not(HasSubstr("without effect")));

  const std::string rolling = "/contacts/type=linear-rolling", steel = "/materials/steel={}";
  constexpr auto idle_value = ": no contact depends on it";
  const auto told = [&](const std::string& pointer) { return HasSubstr("  " + pointer + idle_value); };
  EXPECT_THAT(check({rolling, "/materials/sand/friction_angle=0.3", "/materials/sand/shear_to_normal_stiffness=0"}),
              told("/materials/sand/friction_angle"));
  const std::string rough_steel = R"(/materials/steel={"friction_angle": 1})";
  EXPECT_THAT(check({rolling, rough_steel, floor, "/materials/sand/friction_angle=0.3"}),
              told("/materials/steel/friction_angle"));
  const auto smooth_and_rough = [&](const std::string& friction, const std::string& more) {
    return check({rolling, steel, floor, "/materials/sand/friction_angle=0.3",
                  "/materials/steel/friction_angle=" + friction, "/materials/steel/contact_modulus=1e9", more});
  };
  EXPECT_THAT(smooth_and_rough("1", "/seed=1"),
              AllOf(told("/materials/steel/friction_angle"), told("/materials/steel/contact_modulus"),
                    testing::Not(told("/materials/sand/friction_angle"))));
  EXPECT_THAT(smooth_and_rough("0.1", "/seed=1"), testing::Not(told("/materials/steel/friction_angle")));
  EXPECT_THAT(smooth_and_rough("1", R"(/stages/0/change={"materials": {"sand": {"friction_angle": 1.2}}})"),
              testing::Not(told("/materials/steel/friction_angle")))
      << "a stage makes sand rougher still";
}

TEST(Descriptions, AreRefusedForChannelsThatNoProbeHas) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  for (const std::string does : {"check", "run"}) {
    const auto outcome = grit_in(
        folder.path(), {does, "two.json", "--set", R"(/output/picture={"x": "packing/time", "y": ["packing/nope"]})",
                        "--set", R"(/output/references={"a": {"of": "test/x", "value": 1}})", "--set",
                        R"(/output/summary=["packing/kinetic_energy", "packing/none"])"});
    EXPECT_EQ(outcome.status, 2) << does;
    EXPECT_THAT(
        outcome.err,
        AllOf(HasSubstr("--set: /output/picture/y/0: found \"packing/nope\", which is not a scalar channel of any "
                        "probe; allowed is one of packing/time, "),
              HasSubstr("/output/references/a/of: found \"test/x\""),
              HasSubstr("/output/summary/1: found \"packing/none\""), HasSubstr("3 problems")))
        << does;
  }
}

TEST(Descriptions, AreRefusedForAveragesOverTooManyCells) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto done = [&](const std::string& does, const std::string& type, const std::vector<std::string>& more) {
    std::vector<std::string> words{does, "two.json", "--set",
                                   "/probes/cells={\"type\": \"" + type +
                                       R"(", "every_steps": 50, "region_low": [0, 0, 0], "region_high": [1, 1, 1]})"};
    for (const std::string& set : more) words.insert(words.end(), {"--set", set});
    return grit_in(folder.path(), words);
  };
  for (const std::string type : {"stress", "void-ratio"}) {
    for (const std::string does : {"check", "run"}) {
      const auto outcome = done(does, type, {});
      EXPECT_EQ(outcome.status, 2) << does << type;
      EXPECT_THAT(outcome.err,
                  AllOf(HasSubstr("--set: /probes/cells/cell_step: found averaging cells every 1 mean diameters of "
                                  "0.002 m in a region of 1 x 1 x 1 m, whose edges divide it into up to 973.242 "
                                  "million parts; allowed is up to 8 million: a cell_step of at least 5.1, a "
                                  "depth_axis, or a smaller region\n"),
                        HasSubstr("1 problem")))
          << does << type;
      EXPECT_FALSE(std::filesystem::exists(folder.path() / "results")) << does << type;
    }
    EXPECT_EQ(done("check", type, {"/probes/cells/cell_step=5.1"}).status, 0) << type;
  }
  EXPECT_EQ(done("check", "stress", {"/probes/cells/frames=false"}).status, 0) << "its channels need no cells";
  EXPECT_EQ(done("check", "stress", {"/output/frames=null"}).status, 0);
}

TEST(Descriptions, AreRefusedForFieldsThatNoProbeHas) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const std::string moved = R"(/probes/moved={"type": "displacements", "every_steps": 10})";
  const auto picture = [](const std::string& color) {
    return R"(/output/picture={"x": "packing/time", "y": ["packing/kinetic_energy"], "color": ")" + color + "\"}";
  };
  const auto refused = [&](const std::string& does, const std::vector<std::string>& sets) {
    std::vector<std::string> words{does, "two.json"};
    for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
    const auto outcome = grit_in(folder.path(), words);
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    return outcome.err;
  };
  for (const std::string does : {"check", "run"})
    EXPECT_THAT(
        refused(
            does,
            {moved, picture("moved/fluctuatoin"),
             R"(/output/color_scales=[{"of": "packing/void_ratoi", "high": 1}, {"of": "packing/stress/xx", "low": 0}])"}),
        AllOf(HasSubstr(
                  "--set: /output/picture/color: found \"moved/fluctuatoin\", which is not a field of bodies of any "
                  "probe; did you mean \"moved/fluctuation\"? Allowed is one of moved/fluctuation, "
                  "moved/fluctuation/x, moved/fluctuation/y, moved/fluctuation/z"),
              HasSubstr("/output/color_scales/0/of: found \"packing/void_ratoi\", which is not a field of any probe on "
                        "maps or bodies; did you mean \"packing/void_ratio\"? Allowed is one of "),
              HasSubstr("2 problems")))
        << does;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "results"));
  EXPECT_THAT(refused("check", {picture("packing/void_ratio")}),
              HasSubstr("found \"packing/void_ratio\", which is not a field of bodies of any probe; allowed is none "
                        "without probes that have such fields"));
  const std::string color = picture("moved/fluctuation");
  EXPECT_THAT(refused("check", {moved, color, "/probes/moved/frames=false"}),
              HasSubstr("found \"moved/fluctuation\" of a probe that is not in frames; allowed is a field of "
                        "a probe in frames: set /probes/moved/frames to true"));
  EXPECT_THAT(refused("check", {moved, color, "/output/frames=null"}),
              HasSubstr("found \"moved/fluctuation\" without frames, from which it is taken; allowed is a field "
                        "if /output/frames has an interval, e.g. every_time"));
  const std::string more =
      R"(/stages=[{"name": "part", "until": {"type": "steps", "value": 2}, "limit": 1}, {"name": "rest", "until": {"type": "steps", "value": 2}, "limit": 1}])";
  EXPECT_THAT(
      refused("check", {moved, color, more, R"(/probes/moved/stages=["part"])"}),
      HasSubstr("of a probe that does not sample in the last stage, after which the picture is drawn; allowed is "
                "a field of a probe that does: add \"rest\" to /probes/moved/stages"));
  EXPECT_THAT(refused("check", {picture("sped")}),
              HasSubstr("/output/picture/color: found \"sped\"; did you mean \"speed\"? Allowed is one of rotation, "
                        "displacement, speed, radius, group, or probe/field"));
  EXPECT_THAT(
      refused("check", {R"(/output/color_scales=[{"of": "speed"}, {"of": "speed", "low": 2, "high": 1}])"}),
      AllOf(HasSubstr("/output/color_scales/0/high: found neither low nor high; allowed is one of them, or both"),
            HasSubstr("/output/color_scales/1/high: found a value that is not above low; allowed is above low")));
  const auto fine = grit_in(folder.path(), {"run", "two.json", "--quiet", "--set", moved, "--set", color});
  EXPECT_EQ(fine.status, 0) << fine.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "results/two/picture.svg"));
}

/// Faults that show only at the first step are located, too, and leave no folder behind.
TEST(Descriptions, AreRefusedForFaultsOfTheFirstInstant) {
  const std::string start = R"({
  "contacts": {"type": "linear-frictional"},
  "materials": {"sand": {"density": 2600}},
  "bodies": {
    "sand": {"type": "sphere", "material": "sand", "source": {"type": "list", "bodies": [
      {"position": [0, 0, 0.02], "radius": 0.005})";
  const std::string middle = R"(
    ]}}
  },
  "walls": {
    "floor": {"type": "plane", "material": "sand", "normal": [0, 0, )";
  const std::string end = R"(]}
  },
  "stages": [{"name": "fall", "until": {"type": "time", "value": 0.01}, "limit": 1}])";
  const auto expect = [&](const std::string& text, const std::string& problem) {
    const OwnFolder folder;
    folder.write("box.json", text);
    for (const std::string does : {"check", "run"}) {
      const auto outcome = grit_in(folder.path(), {does, "box.json"});
      EXPECT_EQ(outcome.status, 2) << does;
      EXPECT_THAT(outcome.err, AllOf(HasSubstr(problem), HasSubstr("1 problem"))) << does;
      EXPECT_FALSE(std::filesystem::exists(folder.path() / "results")) << does;
    }
  };
  expect(start + middle + "-1" + end + "}",
         "box.json:10: /walls/floor: wall \"floor\" faces away from the bodies: 1 of 1 have their centres behind it");
  expect(start + R"(, {"position": [0, 0, 0.021], "radius": 0.005})" + middle + "1" + end + "}",
         "box.json:5: /bodies/sand: body 0 at (0, 0, 0.02) m overlaps body 1 by 1.8 of its radius");
  expect(start + middle + "1" + end + ",\n  \"time_step\": {\"value\": 1}}",
         "box.json:13: /time_step/value: the time step 1 s is above the critical one, ");
  expect(start + middle + "1" + end + ",\n  \"domain\": {\"low\": [-1, -1, 0], \"high\": [1, 1, 0.01]}}",
         "box.json:5: /bodies/sand: a body at (0, 0, 0.02) m is outside the domain");
  expect(start + R"(, {"position": [0, 0, 0.05], "radius": 0.005})" + middle + "1" + end +
             ",\n  \"domain\": {\"low\": [-1, -1, 0], \"high\": [1, 1, 0.01]}}",
         "box.json:5: /bodies/sand: 2 bodies, the first at (0, 0, 0.02) m, are outside the domain; enlarge /domain or "
         "move the bodies");
  expect(start + middle + "1" + end + ",\n  \"output\": {\"summary\": [\"packing/none\"]}}",
         "box.json:13: /output/summary/0: found \"packing/none\", which is not a scalar channel of any probe");
}

TEST(Descriptions, AreRefusedForTooManyMaterials) {
  std::string materials;
  for (int i = 0; i < 256; ++i) materials += (i > 0 ? ", " : "") + ("\"m" + std::to_string(i) + "\": {}");
  const OwnFolder folder;
  folder.write("many.json", R"({
  "contacts": {"type": "linear-frictional"},
  "materials": {)" + materials + R"(},
  "bodies": {"sand": {"type": "sphere", "material": "m0", "source": {"type": "list", "bodies": [
    {"position": [0, 0, 0], "radius": 0.005}]}}},
  "stages": [{"name": "fall", "until": {"type": "time", "value": 0.01}, "limit": 1}]
})");
  const auto outcome = grit_in(folder.path(), {"check", "many.json"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("many.json:3: /materials: found 256 materials; allowed is 255 or fewer"));
}

/// Before memory is taken or anything is written, by `check` too.
TEST(Descriptions, AreRefusedForMoreThanMemoryOrDiskHold) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto refused = [&](const std::vector<std::string>& sets, const std::string& problem) {
    for (const std::string does : {"check", "run"}) {
      std::vector<std::string> words{does, "two.json"};
      for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
      const auto outcome = grit_in(folder.path(), words);
      EXPECT_EQ(outcome.status, 2) << does << ' ' << sets.front();
      EXPECT_THAT(outcome.err, AllOf(HasSubstr(problem),
                                     HasSubstr(" available: use fewer bodies, or a machine with "
                                               "more memory"),
                                     HasSubstr("1 problem")))
          << does << ' ' << sets.front();
      EXPECT_FALSE(std::filesystem::exists(folder.path() / "results")) << does << ' ' << sets.front();
    }
  };
  const std::string cloud = R"(/bodies/grains/source={"type": "cloud", "low": [0, 0, 0], "high": [9, 9, 9], "count":
      4000000000, "sizes": {"type": "uniform", "smallest": "1 mm", "largest": "2 mm"}})";
  const std::string many =
      "--set: /bodies/grains/source: found 4000000000 bodies, which need about 2.8 TB of memory "
      "with their contacts; allowed is up to ";
  refused({cloud}, many);
  refused({cloud, "/time_step/value=1e-7"}, many);
  refused({R"(/bodies/grains/source={"type": "lattice", "kind": "fcc", "low": [0, 0, 0], "high": [1000, 1000, 1000],
               "diameter": "1 mm"})"},
          "found 1000000000000000 bodies, which need about 700 PB of memory");
  refused({cloud, "/bodies/grains/type=clump", R"(/bodies/grains/shape={"type": "rod", "count": 3, "spacing": 0.5})"},
          "found 12000000000 bodies, which need about 8.4 TB of memory");
  refused({cloud, "/bodies/grains/stage=part"}, many);

  for (const std::string until : {R"({"type": "steps", "value": 10000000000000})", R"({"type": "time", "value": 1e9})"})
    for (const std::string does : {"check", "run"}) {
      const auto outcome =
          grit_in(folder.path(), {does, "two.json", "--set", R"(/output/frames={"every_steps": 1})", "--set",
                                  "/stages/0/until=" + until, "--set", "/stages/0/limit=1e10"});
      EXPECT_EQ(outcome.status, 2) << does << until;
      EXPECT_THAT(outcome.err,
                  AllOf(HasSubstr("--set: /output/frames: found at least "), HasSubstr(" frames of 8.18 kB each, "),
                        HasSubstr("; allowed is as many as fit on the disk of the results, which has "),
                        HasSubstr("1 problem")))
          << does << until;
      EXPECT_FALSE(std::filesystem::exists(folder.path() / "results")) << does << until;
    }
}

TEST(Descriptions, AreRefusedForBodiesThatTheArithmeticCannotHold) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  folder.write("tiny.txt", "0 0 0 1\n3 0 0 1e-320\n");
  const auto refused = [&](const std::vector<std::string>& sets, const std::string& problem) {
    for (const std::string does : {"check", "run"}) {
      std::vector<std::string> words{does, "two.json"};
      for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
      const auto outcome = grit_in(folder.path(), words);
      EXPECT_EQ(outcome.status, 2) << does << ' ' << sets.front();
      EXPECT_THAT(outcome.err, AllOf(HasSubstr(problem), HasSubstr("1 problem"))) << does << ' ' << sets.front();
      EXPECT_FALSE(std::filesystem::exists(folder.path() / "results")) << does << ' ' << sets.front();
    }
  };
  const std::string first = "/bodies/grains/source/bodies/0/";
  refused({first + "radius=1e-320"},
          "/bodies/grains: found a radius of 1e-320 m; allowed is from 1e-15 to 1e+12 m; is the unit right?");
  refused({first + "radius=1e200"}, "/bodies/grains: found a radius of 1e+200 m; allowed is from 1e-15 to 1e+12 m");
  refused({first + "position=[1e308, 0, 0]"},
          "/bodies/grains: found a body at (1e+308, 0, 0) m; allowed are positions up to 1e+15 m from the origin along "
          "each axis; is the unit right?");
  refused({first + "position=[0, 0, -1e16]"}, "found a body at (0, 0, -1e+16) m");
  refused({"/materials/sand/density=1e-300"}, "/bodies/grains: found a body with a mass of 4.189e-309 kg");
  refused({R"(/bodies/grains/source={"type": "file", "path": "tiny.txt"})"},
          "/bodies/grains: found a radius of 1e-320 m");
  const auto cloud = [](const std::string& smallest) {
    return R"(/bodies/grains/source={"type": "cloud", "low": [0, 0, 0], "high": [1, 1, 1], "count": 9, "sizes":
              {"type": "list", "diameters": [0.001, )" +
           smallest + "]}}";
  };
  refused({cloud("1e-320")},
          "/bodies/grains: cloud: found diameters from 1e-320 to 0.001 m; allowed are 2e-15 to 2e+12 m");
  refused({R"(/bodies/poured={"type": "sphere", "material": "sand", "source": {"type": "stream", "number_rate": 100,
              "region": {"type": "disc", "centre": [0, 0, 1], "radius": "1 cm"},
              "sizes": {"type": "list", "diameters": [0.001, 1e-320]}}})"},
          "/bodies/poured: found a radius of ");
}

TEST(Descriptions, ProbesAndWallsThatDoNotFitTheSceneAreLocated) {
  const OwnFolder folder;
  folder.write("base.json", two_grains);
  folder.write("two.json", R"({
  "extends": "base.json",
  "walls": {"plate": {"type": "plane", "point": [0, 0, "-1 cm"], "normal": [0, 0, 1], "material": "sand"}},
  "probes": {
    "force": {
      "type": "walls",
      "every_steps": 10,
      "walls": ["plat"]
    },
    "curve": {"type": "formula", "every_steps": 10, "curves": {"speed": {
      "formula": "2 * plate_sped"
    }}}
  },
  "stages": [
    {"name": "part", "until": {"type": "steps", "value": 200}, "limit": "1 s"},
    {"name": "shake", "until": {"type": "steps", "value": 20}, "limit": "1 s", "change": {"walls": {"plate": {"motion": {
      "oscillation": {"amplitude": [0, 0, "1 um"], "frequency": "1e9 Hz"}
    }}}}}
  ]
})");
  const std::string curve = R"(/probes/curve/curves/speed/formula="plate_force_x")",
                    plate = R"(/probes/force/walls=[])";
  const auto refusal = [&](const std::string& does, const std::vector<std::string>& sets) {
    std::vector<std::string> words{does, "two.json"};
    if (does == "run") words.insert(words.end(), {"--out", "out", "--overwrite"});
    for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
    const auto outcome = grit_in(folder.path(), words);
    EXPECT_EQ(outcome.status, 2) << does;
    return outcome.err;
  };
  for (const std::string does : {"check", "run"}) {
    EXPECT_THAT(refusal(does, {curve}), HasSubstr("two.json:8: /probes/force/walls: found \"plat\", which is not a "
                                                  "wall; did you mean \"plate\"? Allowed is one of the walls plate\n"));
    EXPECT_THAT(
        refusal(does, {plate}),
        HasSubstr("two.json:11: /probes/curve/curves/speed/formula: found \"2 * plate_sped\": the unknown name"));
    EXPECT_THAT(refusal(does, {plate, R"(/probes/curve/curves/speed/formula="nothing")"}),
                HasSubstr("--set: /probes/curve/curves/speed/formula: found \"nothing\": the unknown name"));
    EXPECT_THAT(
        refusal(does, {plate, curve}),
        HasSubstr(
            "two.json:17: /stages/1/change/walls/plate/motion/oscillation: wall \"plate\": oscillates at 1e+09 Hz"));
    const auto ramped = refusal(
        does, {plate, curve, R"(/walls/plate/motion/oscillation={"amplitude": [0, 0, "1 um"], "frequency": 1})",
               R"(/stages/0/change={"walls": {"plate": {"motion": {"ramp_time": "1 us"}}}})",
               R"(/stages/0/ramps=[{"pointer": "/walls/plate/motion/oscillation/frequency", "from": 1, "to": 1e9,)"
               R"( "duration": 1e-4, "increments": 2}])"});
    EXPECT_THAT(ramped, HasSubstr("--set: /stages/0/ramps/0: wall \"plate\": oscillates at 5e+08 Hz"));
  }
  EXPECT_EQ(json::parse(text_of(folder / "out/run.json")).at("status"), "failed");
}

TEST(Descriptions, LetALaterServoPressOnTheSpecimenWhereItsPlaneHasNoArea) {
  const OwnFolder folder;
  folder.write("base.json", two_grains);
  folder.write("two.json", R"({
  "extends": "base.json",
  "domain": {"low": ["-1 cm", "-1 cm", "-1 cm"], "high": ["1 cm", "1 cm", "1 cm"], "periodic": [true, true, false]},
  "walls": {"lid": {"type": "plane", "point": [0, 0, "1 cm"], "normal": [0, 0, -1], "material": "sand"}},
  "stages": [
    {"name": "part", "until": {"type": "steps", "value": 20}, "limit": "1 s"},
    {"name": "press", "until": {"type": "steps", "value": 20}, "limit": "1 s", "change": {"walls": {"lid": {"motion": {
      "servo": {"axis": "z", "pressure": "1 kPa", "max_velocity": "1 mm/s"}
    }}}}}
  ]
})");
  const auto bare = grit_in(folder.path(), {"check", "two.json"});
  EXPECT_EQ(bare.status, 2);
  EXPECT_THAT(bare.err, HasSubstr("two.json:8: /stages/1/change/walls/lid/motion/servo: found a servo pressure on a "
                                  "geometry without an area"));
  const std::string area = R"(/stages/1/change/walls/lid/motion/servo/area="specimen")";
  const auto open = grit_in(folder.path(), {"check", "two.json", "--set", area, "--set", "/domain={}"});
  EXPECT_EQ(open.status, 2);
  EXPECT_THAT(open.err, HasSubstr("two.json:8: /stages/1/change/walls/lid/motion/servo: found a servo on the "
                                  "cross-section of the specimen, which is open"));
  for (const std::string does : {"check", "run"}) {
    const auto outcome = grit_in(folder.path(), {does, "two.json", "--set", area});
    EXPECT_EQ(outcome.status, 0) << does << ": " << outcome.err;
  }
}

TEST(Descriptions, MayNameTheTimeOfSamplesWhereverChannelsAreNamed) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  for (const std::string does : {"check", "run"}) {
    const auto outcome =
        grit_in(folder.path(),
                {does, "two.json", "--set", R"(/output/picture={"x": "packing/mean_stress", "y": ["packing/time"]})",
                 "--set", R"(/output/references={"a": {"of": "packing/time", "value": 1}})", "--set",
                 R"(/output/summary=["packing/time"])"});
    EXPECT_EQ(outcome.status, 0) << does << outcome.err;
    if (does == "run") EXPECT_THAT(outcome.out, StartsWith("packing/time: peak "));
  }
}

TEST(Descriptions, CheckReportsWallsOutOfReach) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto check = [&](std::vector<std::string> sets) {
    std::vector<std::string> words{"check", "two.json"};
    for (const auto& set : sets) words.insert(words.end(), {"--set", set});
    const auto outcome = grit_in(folder.path(), words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  const std::string domain = R"(/domain={"low": ["-5 mm", "-5 mm", "-5 mm"], "high": ["5 mm", "5 mm", "5 mm"]})";
  const auto lid = [](const std::string& height) {
    return R"(/walls/lid={"type": "plane", "point": [0, 0, ")" + height +
           R"("], "normal": [0, 0, -1], "material": "sand"})";
  };
  const auto told = HasSubstr("  /walls/lid: it is at rest outside the domain");
  EXPECT_THAT(check({domain, lid("20 mm")}), told);
  EXPECT_THAT(check({domain, lid("20 mm"), R"(/specimen={"high": ["", "", "lid"]})"}), testing::Not(told))
      << "it bounds the specimen";
  EXPECT_THAT(check({domain, lid("7 mm")}), testing::Not(told)) << "a grain that just leaves would touch it";
  EXPECT_THAT(check({lid("20 mm")}), testing::Not(told)) << "nothing keeps grains below";
  EXPECT_THAT(check({domain, lid("20 mm"), "/walls/lid/motion/velocity=[0, 0, -1]"}), testing::Not(told)) << "it comes";
  EXPECT_THAT(
      check({domain, lid("20 mm"), R"(/stages/0/change={"walls": {"lid": {"motion": {"velocity": [0, 0, -1]}}}})"}),
      testing::Not(told))
      << "it comes in a stage";
}

TEST(Descriptions, CheckReportsAGeometryThatAStageRepeats) {
  const OwnFolder folder;
  const auto check = [&](const std::string& change, const std::string& second = "{}") {
    auto scene = json::parse(two_grains);
    scene["walls"]["lid"] = {
        {"type", "plane"}, {"material", "sand"}, {"point", {0, 0, -0.01}}, {"motion", {{"velocity", {0, 0, -0.1}}}}};
    auto next = scene["stages"][0];
    scene["stages"][0]["change"] = {{"walls", {{"lid", json::parse(change)}}}};
    next["name"] = "next", next["change"] = {{"walls", {{"lid", json::parse(second)}}}};
    scene["stages"].push_back(next);
    folder.write("lid.json", scene.dump());
    const auto outcome = grit_in(folder.path(), {"check", "lid.json"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  const std::string why =
      "/point: the wall has this value already; its motion so far is added, so that this does not put it back\n";
  EXPECT_THAT(check(R"({"point": [0, 0, "-10 mm"], "motion": null})"),
              HasSubstr("\nwithout effect\n  /stages/0/change/walls/lid" + why));
  EXPECT_THAT(check(R"({"point": [0, 0, "-11 mm"]})"), testing::Not(HasSubstr("/change/walls/lid")));
  EXPECT_THAT(check(R"({"point": [0, 0, "-11 mm"]})", R"({"point": [0, 0, -0.011], "material": "sand"})"),
              AllOf(HasSubstr("  /stages/1/change/walls/lid" + why), testing::Not(HasSubstr("/stages/0/change"))));
  EXPECT_THAT(check(R"({"point": [0, 0, "-11 mm"]})", R"({"point": [0, 0, -0.01]})"),
              testing::Not(HasSubstr("/change/walls/lid")));
}

TEST(Descriptions, CheckWarnsWhereNothingMovesTheBodies) {
  const OwnFolder folder;
  auto cloud = json::parse(two_grains);
  cloud["bodies"]["grains"]["source"] = {{"type", "cloud"},
                                         {"low", {0, 0, 0}},
                                         {"high", {0.02, 0.02, 0.02}},
                                         {"count", 20},
                                         {"sizes", {{"type", "uniform"}, {"smallest", 1e-3}, {"largest", 2e-3}}}};
  cloud["walls"]["floor"] = {{"type", "plane"}, {"material", "sand"}, {"point", {0, 0, -0.01}}};
  folder.write("cloud.json", cloud.dump());
  folder.write("two.json", two_grains);
  const auto check = [&](std::vector<std::string> sets, const std::string& file = "cloud.json") {
    std::vector<std::string> words{"check", file};
    for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
    const auto outcome = grit_in(folder.path(), words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  const std::string warning =
      "\nwarning\n  /engines: nothing moves the bodies: they are at rest without contacts that push "
      "them, no wall moves, and there is neither gravity nor another force; add \"gravity\": ";
  EXPECT_THAT(check({}), HasSubstr(warning));
  EXPECT_THAT(check({R"(/engines={"damping": {"type": "local-damping"}})"}), HasSubstr(warning));
  EXPECT_THAT(check({R"(/engines={"gravity": {"type": "gravity", "acceleration": [0, 0, 0]}})"}), HasSubstr(warning));
  const auto none = testing::Not(HasSubstr("nothing moves the bodies"));
  EXPECT_THAT(check({}, "two.json"), none) << "they push each other apart";
  EXPECT_THAT(check({R"(/engines={"gravity": {"type": "gravity"}})"}), none);
  EXPECT_THAT(check({R"(/stages/0/change={"engines": {"gravity": {"type": "gravity"}}})"}), none) << "in a stage";
  EXPECT_THAT(check({R"(/bodies/grains/velocity=[0, 0, "-1 m/s"])"}), none);
  EXPECT_THAT(check({R"(/walls/floor/motion={"velocity": [0, 0, "1 mm/s"]})"}), none);
  EXPECT_THAT(check({R"(/walls/floor/motion={"servo": {"force": 1, "max_velocity": 1}})"}), none);
  EXPECT_THAT(check({R"(/stages/0/change={"walls": {"floor": {"point": [0, 0, 0.001]}}})"}), none);
  EXPECT_THAT(check({R"(/stages/0/growth={"rate": 1})"}), none);
  // Glued grains that touch each other do not move the others.
  const std::string glued = R"(/bodies/glued={"type": "sphere", "material": "sand", "source": {"type": "lattice",
      "kind": "simple-cubic", "low": [0, 0, -0.008], "high": [0.02, 0.02, -0.004], "diameter": 0.002}})";
  const std::string held = R"(/engines/glue={"type": "prescribed-motion", "groups": ["glued"]})";
  EXPECT_THAT(check({glued, held}), HasSubstr(warning));
  EXPECT_THAT(check({glued}), none) << "they may push each other apart";
  EXPECT_THAT(check({glued, held, R"(/engines/gravity={"type": "gravity"})"}), none);
  EXPECT_THAT(check({glued, held, R"(/stages/0/change={"engines": {"glue": null}})"}), none) << "released in a stage";
}

TEST(Descriptions, CheckWarnsWhereGravityIsForgotten) {
  const OwnFolder folder;
  auto scene = json::parse(two_grains);
  scene["bodies"]["grains"]["source"]["bodies"][1]["position"] = {0.003, 0, 0};
  scene["bodies"]["grains"]["velocity"] = {0, 0, -0.5};
  scene["walls"]["floor"] = {{"type", "plane"}, {"material", "sand"}, {"point", {0, 0, -0.01}}};
  folder.write("moving.json", scene.dump());
  scene["stages"][0]["until"] = {{"type", "at-rest"}};
  folder.write("settling.json", scene.dump());
  scene = json::parse(two_grains);
  scene["bodies"]["poured"] = {{"type", "sphere"}, {"material", "sand"}, {"velocity", {0, 0, -0.5}}};
  scene["bodies"]["poured"]["source"] = {{"type", "stream"},
                                         {"number_rate", 100},
                                         {"region", {{"type", "disc"}, {"centre", {0, 0, 0.05}}, {"radius", 0.01}}},
                                         {"sizes", {{"type", "list"}, {"diameters", {0.001}}}}};
  folder.write("poured.json", scene.dump());
  const auto check = [&](const std::string& file, const std::string& set = "/seed=1") {
    const auto outcome = grit_in(folder.path(), {"check", file, "--set", set});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  const std::string gravity = R"(/engines/gravity={"type": "gravity"})";
  const std::string warning =
      "\nwarning\n  /engines: no force acts on the bodies: there is neither gravity nor another force, and no wall "
      "moves; ";
  EXPECT_THAT(check("settling.json"), HasSubstr(warning + "a stage waits for contacts that carry them; if they should "
                                                          "fall, add \"gravity\": {\"type\": \"gravity\"}\n"));
  EXPECT_THAT(check("poured.json"), HasSubstr(warning + "those of a stream keep their velocity until they hit "));
  const auto none = testing::Not(HasSubstr("no force acts"));
  EXPECT_THAT(check("moving.json"), none) << "a collision needs none";
  EXPECT_THAT(check("settling.json", R"(/stages/0/until={"type": "any", "of": [{"type": "at-rest"}, {"type": "time",
                                        "value": 1}]})"),
              none)
      << "time ends it";
  for (const char* file : {"settling.json", "poured.json"}) {
    EXPECT_THAT(check(file, gravity), none);
    EXPECT_THAT(check(file, R"(/engines/drag={"type": "drag", "viscosity": 1e-3})"), none);
    EXPECT_THAT(check(file, R"(/stages/0/change={"engines": {"gravity": {"type": "gravity"}}})"), none);
    EXPECT_THAT(check(file, R"(/stages/0/growth={"rate": 1})"), none);
  }
  EXPECT_THAT(check("settling.json", R"(/walls/floor/motion={"velocity": [0, 0, "1 mm/s"]})"), none);
}

TEST(Descriptions, CheckWarnsOfDensitiesThatNoSolidHas) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto check = [&](const std::string& density) {
    const auto outcome = grit_in(folder.path(), {"check", "two.json", "--set", R"(/materials/glass={"density": 1})",
                                                 "--set", "/materials/sand/density=" + density});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  const std::string warning = "\nwarning\n  /materials/sand/density: ";
  EXPECT_THAT(check("2.65"),
              HasSubstr(warning + "2.65 kg/m^3 is far from any solid; did you mean 2.65 g/cm^3? A density that "));
  EXPECT_THAT(check("2.65e6"), HasSubstr(warning + "2.65e+06 kg/m^3 is far from any solid; is the unit right? "));
  for (const char* density : {"2.65 g/cm^3", "50", "25000"})
    EXPECT_THAT(check(density), testing::Not(HasSubstr("far from any solid"))) << "no body is of glass";
}

TEST(Descriptions, CheckReportsBodiesThatFallForEver) {
  const OwnFolder folder;
  auto cell = json::parse(two_grains);
  cell["walls"] = json::object();
  cell["domain"] = {{"low", {-0.1, -0.1, -0.1}}, {"high", {0.1, 0.1, 0.1}}, {"periodic", {true, true, true}}};
  cell["engines"]["gravity"] = {{"type", "gravity"}};
  folder.write("cell.json", cell.dump());
  const auto check = [&](const std::string& set) {
    const auto outcome = grit_in(folder.path(), {"check", "cell.json", "--set", set});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  const std::string warning = "\nwarning\n  /engines: gravity acts in a domain that is periodic along all axes";
  EXPECT_THAT(check("/seed=2"), HasSubstr(warning));
  EXPECT_THAT(check("/domain/periodic=[true, true, false]"), testing::Not(HasSubstr(warning)));
  EXPECT_THAT(check(R"(/engines/gravity/acceleration=[0, 0, 0])"), testing::Not(HasSubstr(warning)));
  EXPECT_THAT(check(R"(/engines/hold={"type": "hold", "translation": "z"})"), testing::Not(HasSubstr(warning)));
}

struct CheckedServos : testing::Test {
  CheckedServos() {
    auto cell = json::parse(two_grains);
    cell["materials"]["sand"]["contact_modulus"] = 1e8;
    cell["domain"] = {{"low", {-0.1, -0.1, -0.1}}, {"high", {0.1, 0.1, 0.1}}, {"periodic", {true, true, true}}};
    cell["domain"]["servo"] = {{"stress", {{"xx", 1e5}, {"yy", 1e5}, {"zz", 2.5e5}}}, {"max_strain_rate", 1}};
    folder.write("cell.json", cell.dump());
    auto box = json::parse(two_grains);
    box["materials"]["sand"]["contact_modulus"] = 1e8;
    box["walls"]["lid"] = {
        {"type", "plane"}, {"point", {0, 0, 0.01}}, {"normal", {0, 0, -1}}, {"area", 1e-4}, {"material", "sand"}};
    box["walls"]["lid"]["motion"]["servo"] = {{"pressure", 1e4}, {"max_velocity", 1}};
    folder.write("box.json", box.dump());
  }
  /// What `check` warns of.
  std::string warnings(const std::string& file, const std::vector<std::string>& sets) const {
    std::vector<std::string> words{"check", file};
    for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
    const auto outcome = grit_in(folder.path(), words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    std::string all;
    const std::string begin = "\nwarning\n  ";
    for (auto at = outcome.out.find(begin); at != std::string::npos; at = outcome.out.find(begin, at + 1))
      all +=
          outcome.out.substr(at + begin.size(), outcome.out.find('\n', at + begin.size()) - at - begin.size()) + '\n';
    return all;
  }
  static std::string until(const std::string& condition) { return "/stages/0/until=" + condition; }
  OwnFolder folder;
};

TEST_F(CheckedServos, MustNotPullBodiesWithoutAttraction) {
  EXPECT_EQ(warnings("cell.json", {}), "");
  const std::string pull = "/domain/servo/stress/xx=\"-100 kPa\"";
  EXPECT_EQ(warnings("cell.json", {pull}),
            "/domain/servo/stress/xx: the servo pulls with -1e+05 Pa, which bodies without attraction cannot bear; "
            "compression is positive: set a target above 0, or use a contact law with cohesion\n");
  EXPECT_THAT(warnings("cell.json", {R"(/stages/0/change={"domain": {"servo": {"stress": {"yy": -10}}}})"}),
              StartsWith("/domain/servo/stress/yy: the servo pulls with -10 Pa, "));
  EXPECT_EQ(warnings("cell.json", {pull, "/contacts/type=linear-cohesive", "/materials/sand/tensile_strength=1e7"}),
            "");
  EXPECT_EQ(warnings("cell.json", {"/domain/servo/stress/xy=-1000"}), "") << "a shear stress has either sign";

  const auto with_force = [&](const std::string& force) {
    return warnings("box.json", {R"(/walls/lid/motion/servo={"max_velocity": 1, "force": )" + force + '}'});
  };
  EXPECT_EQ(with_force("-3"), "");
  EXPECT_THAT(with_force("3"), AllOf(StartsWith("/walls/lid/motion/servo/force: the servo pulls with 3 N, "),
                                     HasSubstr("acts along its normal: set a force below 0, or")));
}

TEST_F(CheckedServos, MustReachWhatAStageWaitsFor) {
  const auto pressure = [](double value) {
    return R"({"type": "pressure", "wall": "lid", "within": 0.01, "value": )" + std::to_string(value) + '}';
  };
  EXPECT_EQ(warnings("box.json", {until(pressure(1e4))}), "");
  EXPECT_EQ(warnings("box.json", {until(pressure(1.009e4))}), "") << "within the tolerance";
  EXPECT_EQ(warnings("box.json", {until(pressure(5e3))}), "") << "passed on the way";
  const std::string missed =
      "waits for a pressure on wall \"lid\" of 2e+04 Pa within 200 Pa; its servo keeps at most 1e+04 Pa in this stage: "
      "set its target to the value of the condition, or wait for a value that it reaches\n";
  EXPECT_EQ(warnings("box.json", {until(pressure(2e4))}), "/stages/0/until: " + missed);
  const std::string steps = R"({"type": "steps", "value": 9})";
  EXPECT_EQ(warnings("box.json", {until(R"({"type": "all", "of": [)" + steps + ", " + pressure(2e4) + "]}")}),
            "/stages/0/until/of/1: " + missed);
  EXPECT_EQ(warnings("box.json", {until(R"({"type": "any", "of": [)" + steps + ", " + pressure(2e4) + "]}")}), "");
  EXPECT_EQ(warnings("box.json", {until(pressure(2e4)),
                                  R"(/stages/0/change={"walls": {"lid": {"motion": {"servo": {"pressure": 2e4}}}}})"}),
            "")
      << "a target of the stage";
  const std::string unload = R"(/stages/-={"name": "unload", "limit": 1,
      "change": {"walls": {"lid": {"motion": {"servo": {"pressure": 1e3}}}}}, "until": )";
  EXPECT_EQ(warnings("box.json", {unload + pressure(5e3) + '}'}), "") << "passed on the way down";
  EXPECT_EQ(warnings("box.json", {unload + pressure(2e4) + '}'}), "/stages/1/until: " + missed);

  const auto stress = [](const char* component, double value) {
    return R"({"type": "stress", "component": ")" + std::string(component) + R"(", "value": )" + std::to_string(value) +
           '}';
  };
  EXPECT_EQ(warnings("cell.json", {until(stress("zz", 2.5e5))}), "");
  EXPECT_THAT(
      warnings("cell.json", {until(stress("xx", 2.5e5))}),
      StartsWith("/stages/0/until: waits for a stress xx of 2.5e+05 Pa within 2500 Pa; the servo of the cell keeps "
                 "at most 1e+05 Pa"));
  EXPECT_EQ(warnings("cell.json", {until(stress("xz", 2.5e5))}), "") << "without a target";
  EXPECT_EQ(warnings("cell.json", {until(R"({"type": "mean-stress", "above": 1.4e5})")}), "") << "1.5e5 Pa";
  EXPECT_THAT(warnings("cell.json", {until(R"({"type": "mean-stress", "above": 2e5})")}),
              StartsWith("/stages/0/until: waits for a mean stress above 2e+05 Pa; the servo of the cell keeps at most "
                         "1.5e+05 Pa"));
}

TEST_F(CheckedServos, MustNotCrushSoftBodies) {
  // F = E_c R δ for equal bodies carries 4 p R², so that δ/R is 4 p / E_c: 1 % at a modulus of 1e8 Pa.
  EXPECT_EQ(warnings("cell.json", {"/materials/sand/contact_modulus=\"12 MPa\""}), "") << "8.3 %";
  EXPECT_EQ(
      warnings("cell.json", {"/materials/sand/contact_modulus=\"5 MPa\""}),
      "/materials/sand: too soft: under the servo of the cell, 2.5e+05 Pa, bodies would overlap by about 20 % of "
      "their radius; those of stiff grains do by less than 1 %: raise the modulus of the material about 20 times\n");
  EXPECT_THAT(warnings("cell.json", {"/materials/sand/contact_modulus=2"}),
              AllOf(StartsWith("/materials/sand: too soft: "), HasSubstr("overlap by more than their radius; ")));
  EXPECT_THAT(warnings("box.json", {"/materials/sand/contact_modulus=\"100 kPa\""}),
              StartsWith("/materials/sand: too soft: under the servo of wall \"lid\", 1e+04 Pa, "));
  EXPECT_THAT(warnings("box.json", {"/materials/sand/contact_modulus=100", "/walls/lid/motion={}",
                                    R"(/engines={"gravity": {"type": "gravity"}})"}),
              StartsWith("/materials/sand: too soft: under the weight of the bodies, "));
}

TEST(Descriptions, CheckWarnsOfWallsThatAreTooFastForThePrescribedStep) {
  const OwnFolder folder;
  auto scene = json::parse(two_grains);
  scene["time_step"]["value"] = 1e-6;
  scene["walls"]["lid"] = {{"type", "plane"}, {"material", "sand"}, {"point", {0, 0, 1}}, {"normal", {0, 0, -1}}};
  scene["walls"]["gate"] = {{"type", "rectangle"},
                            {"material", "sand"},
                            {"corner", {0.5, 0, 0}},
                            {"edge_a", {0, 0.1, 0}},
                            {"edge_b", {0, 0, 0.1}}};
  scene["stages"][1] = {
      {"name", "press"}, {"until", {{"type", "steps"}, {"value", 2}}}, {"limit", 1}, {"change", json::object()}};
  folder.write("scene.json", scene.dump());
  const auto check = [&](const std::vector<std::string>& sets) {
    std::vector<std::string> words{"check", "scene.json"};
    for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
    const auto outcome = grit_in(folder.path(), words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  const auto motion = [](const std::string& wall, const std::string& motion) {
    return R"(/stages/1/change={"walls": {")" + wall + R"(": {"motion": )" + motion + "}}}";
  };
  const auto none = testing::Not(HasSubstr("/motion: in stage"));
  EXPECT_THAT(
      check({motion("lid", R"({"velocity": [0, 0, -400]})")}),
      HasSubstr("\nwarning\n  /walls/lid/motion: in stage \"press\" the wall moves by 0.0004 m in a time step of "
                "1e-06 s, 0.4 of the smallest radius and more than /guards/travel 0.05: the run stops where "
                "it meets bodies; reduce its speed or /time_step/value\n"));
  EXPECT_THAT(check({motion("lid", R"({"oscillation": {"amplitude": [0, 0, 0.01], "frequency": 1e4}})")}),
              HasSubstr("0.6283 of the smallest radius"));
  EXPECT_THAT(check({motion("gate", R"({"spin": [0, 0, 1e4]})")}), HasSubstr("/walls/gate/motion: in stage"));
  EXPECT_THAT(check({motion("gate", R"({"spin": [1e4, 0, 0]})")}), none) << "in its own plane";
  EXPECT_THAT(check({motion("lid", R"({"velocity": [400, 0, 0]})")}), none) << "along itself";
  EXPECT_THAT(check({motion("lid", R"({"velocity": [0, 0, 400]})")}), none) << "away from bodies";
  EXPECT_THAT(check({motion("lid", R"({"velocity": [0, 0, -40]})")}), none) << "slow enough";
  EXPECT_THAT(check({motion("lid", R"({"velocity": [0, 0, -400]})"), "/time_step=null"}), none)
      << "the step follows it";
}

TEST(Descriptions, CheckWarnsOfWallsThatFaceAway) {
  const OwnFolder folder;
  auto scene = json::parse(two_grains);
  scene["engines"]["gravity"] = {{"type", "gravity"}};
  folder.write("scene.json", scene.dump());
  const auto check = [&](const std::vector<std::string>& walls) {
    std::vector<std::string> words{"check", "scene.json"};
    for (std::size_t i = 0; i < walls.size(); ++i)
      words.insert(words.end(), {"--set", "/walls/w" + std::to_string(i) + "=" + walls[i]});
    const auto outcome = grit_in(folder.path(), words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  const auto floor = [](double height, const std::string& edges, const std::string& more = "") {
    return R"({"type": "rectangle", "material": "sand", "corner": [-0.01, -0.01, )" + std::to_string(height) + "], " +
           edges + more + "}";
  };
  const std::string up = R"("edge_a": [0.02, 0, 0], "edge_b": [0, 0.02, 0])",
                    down = R"("edge_a": [0, 0.02, 0], "edge_b": [0.02, 0, 0])",
                    warning =
                        "\nwarning\n  /walls/w0: 2 of 2 bodies are behind it, none is in front: it holds only bodies "
                        "in front of it; ";
  const auto none = testing::Not(HasSubstr("are behind it"));
  EXPECT_THAT(check({floor(-0.005, up)}), none);
  EXPECT_THAT(check({floor(-0.005, down)}), HasSubstr(warning + "exchange edge_a and edge_b"));
  EXPECT_THAT(check({floor(-0.005, down, R"(, "two_sided": true)")}), none);
  EXPECT_THAT(check({floor(-0.005, down, R"(, "motion": {"spin": [1, 0, 0]})")}), none) << "it turns towards them";
  EXPECT_THAT(check({floor(-0.005, down), floor(-0.004, up)}), none) << "the back of a plate";
  const auto tube = [](const std::string& inside, double radius) {
    return R"({"type": "cylinder", "material": "sand", "start": [-0.02, 0, -0.03], "end": [0.02, 0, -0.03], "inside": )" +
           inside + R"(, "radius": )" + std::to_string(radius) + "}";
  };
  EXPECT_THAT(check({tube("true", 0.1)}), none);
  EXPECT_THAT(check({tube("false", 0.1)}), HasSubstr(warning + "set its \"inside\" to the side of the bodies"));
  EXPECT_THAT(check({tube("true", 0.01)}), HasSubstr(warning));
  EXPECT_THAT(check({tube("false", 0.01)}), none);
  EXPECT_THAT(check({floor(-0.005, down), R"({"type": "plane", "material": "sand", "point": [0, 0, -0.1]})"}),
              HasSubstr(warning))
      << "a wall beyond it does not hide it";
}

TEST(Descriptions, CheckWarnsWhereGravityPointsToNoWall) {
  const OwnFolder folder;
  auto scene = json::parse(two_grains);
  scene["engines"]["gravity"] = {{"type", "gravity"}};
  scene["walls"]["pit"] = {{"type", "box"},
                           {"material", "sand"},
                           {"low", {-0.01, -0.01, -0.01}},
                           {"high", {0.01, 0.01, 0.01}},
                           {"open", {"z_high"}}};
  scene["stages"][0]["until"] = {{"type", "at-rest"}, {"below", 0.01}};
  folder.write("scene.json", scene.dump());
  const auto check = [&](const std::vector<std::string>& sets) {
    std::vector<std::string> words{"check", "scene.json"};
    for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
    const auto outcome = grit_in(folder.path(), words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  const std::string upwards = "/engines/gravity/acceleration=[0, 0, 9.81]";
  const auto none = testing::Not(HasSubstr("no wall is on the way"));
  EXPECT_THAT(check({}), none);
  EXPECT_THAT(check({upwards}), HasSubstr("\nwarning\n  /engines: gravity is (0, 0, 9.81) m/s^2, and no wall is on the "
                                          "way of the bodies that fall so, but a stage waits for them to rest; "));
  EXPECT_THAT(check({upwards, R"(/stages/0/until={"type": "time", "value": 1e-3})"}), none) << "they may fly";
  EXPECT_THAT(check({upwards, "/walls/pit/open=[\"x_high\"]"}), none) << "a lid";
  EXPECT_THAT(check({"/engines/gravity/acceleration=[9.81, 0, -9.81]"}), none);
  EXPECT_THAT(check({"/walls/pit=null"}), testing::Not(none)) << "no wall at all";
  EXPECT_THAT(check({upwards, R"(/walls/lid={"type": "plane", "point": [0, 0, 1], "normal": [0, 0, -1],
      "material": "sand"})"}),
              none);
  EXPECT_THAT(check({upwards, R"(/walls/side={"type": "plane", "point": [-1, 0, 0], "normal": [1, 0, 0],
      "material": "sand"})"}),
              testing::Not(none));
}

TEST(Descriptions, CheckReportsADepthWithMoreContactsThanScatterJustifies) {
  const OwnFolder folder;
  auto many = json::parse(two_grains);
  many["domain"] = {{"low", {0, 0, 0}}, {"high", {0.1, 0.1, 0.1}}, {"periodic", {false, true, false}}};
  many["bodies"]["grains"]["source"] = {{"type", "cloud"},
                                        {"low", {0, 0, 0}},
                                        {"high", {0.1, 0.1, 0.1}},
                                        {"count", 40000},
                                        {"sizes", {{"type", "uniform"}, {"smallest", "0.9 mm"}, {"largest", "1 mm"}}}};
  folder.write("many.json", many.dump());
  const auto check = [&](const std::string& set) {
    return grit_in(folder.path(), {"check", "many.json", "--set", set}).out;
  };
  // 2.5 contacts a grain; 1/√40 000 is 0.5 %.
  EXPECT_THAT(check("/seed=2"), HasSubstr("  /domain/high/1: the cell is periodic along y; a depth of 0.1 m has about "
                                          "100000 contacts, so that means scatter between samples by about 1/√contacts "
                                          "= 0.32 %; 0.04 m would give 0.5 % at 0.4 of the cost"));
  EXPECT_THAT(check("/bodies/grains/source/count=30000"), testing::Not(HasSubstr("1/√contacts")));
  EXPECT_THAT(check("/domain/periodic=[true, true, false]"), testing::Not(HasSubstr("1/√contacts")))
      << "which of the two is its depth?";
  EXPECT_THAT(check("/bodies/grains/source/high/1=0.05"), testing::Not(HasSubstr("1/√contacts"))) << "a heap";
  EXPECT_THAT(check(R"(/engines/weight={"type": "gravity", "acceleration": [0, -9.81, 0]})"),
              testing::Not(HasSubstr("1/√contacts")));
  EXPECT_THAT(check(R"(/walls/floor={"type": "plane", "point": [0, 0, 0], "material": "sand"})"),
              HasSubstr("1/√contacts"));
  EXPECT_THAT(check(R"(/walls/floor={"type": "rectangle", "corner": [0, 0, 0], "edge_a": [0.1, 0, 0],
      "edge_b": [0, 0.04, 0], "material": "sand"})"),
              testing::Not(HasSubstr("1/√contacts")))
      << "a floor that ends";
}

TEST(Descriptions, CheckWarnsOfAttractionWithinAStep) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto check = [&](std::vector<std::string> sets) {
    std::vector<std::string> words{
        "check", "two.json", "--set", "/contacts/type=linear-cohesive", "--set", "/materials/sand/contact_modulus=1e8"};
    for (const auto& set : sets) words.insert(words.end(), {"--set", set});
    return grit_in(folder.path(), words).out;
  };
  // The reach is π R times strength over modulus.
  EXPECT_THAT(
      check({"/materials/sand/tensile_strength=1e4"}),
      AllOf(HasSubstr("\nwarning\n  /time_step: bodies attract each other up to 3.1e-07 m apart, but may move by "
                      "4e-05 m in a step"),
            HasSubstr("/time_step/max_displacement\n")));
  const auto quiet = testing::Not(HasSubstr("attract each other"));
  EXPECT_THAT(check({"/materials/sand/tensile_strength=0"}), quiet);
  EXPECT_THAT(check({"/materials/sand/tensile_strength=1e4", "/time_step/max_displacement=3e-4"}), quiet);
  EXPECT_THAT(check({"/materials/sand/tensile_strength=2e6"}), quiet);
  EXPECT_THAT(check({"/materials/sand/tensile_strength=1e4", "/time_step/value=1e-9"}),
              HasSubstr("/time_step/value\n"));
}

TEST(Descriptions, CheckReportsAnExcessDepthBetweenPanesOfAScenario) {
  const std::string file = GRIT_SOURCE_DIR "/sims/direct-shear/quick.json";
  const OwnFolder folder;
  const auto check = [&](std::vector<std::string> sets) {
    std::vector<std::string> words{"check", file};
    for (const auto& set : sets) words.insert(words.end(), {"--set", set});
    return grit_in(folder.path(), words).out;
  };
  EXPECT_THAT(check({"/scenario/depth=60 mm"}),
              HasSubstr("  /scenario/depth: its walls \"front\" and \"back\" along y are at rest and frictionless; a "
                        "depth of 0.06 m has about "));
  EXPECT_THAT(check({"/scenario/depth=10 mm"}), testing::Not(HasSubstr("1/√contacts")));
  EXPECT_THAT(check({"/scenario/depth=60 mm", "/materials/sand/rolling_limit=0.4", "/walls/front/material=sand"}),
              testing::Not(HasSubstr("1/√contacts")))
      << "it drags grains";
  EXPECT_THAT(check({"/scenario/depth=60 mm", "/stages/0/change/materials/smooth={\"friction_angle\": 0.4}"}),
              testing::Not(HasSubstr("1/√contacts")))
      << "in a stage";
}

TEST(Descriptions, AreRefusedWhereAStageAddsOrTakesAwayAWall) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const std::string bottom = R"(/walls/bottom={"type": "plane", "point": [0, 0, "-2 mm"], "material": "sand"})";
  const auto outcome = [&](const std::string& walls) {
    return grit_in(folder.path(),
                   {"check", "two.json", "--set", bottom, "--set", "/stages/0/change={\"walls\": " + walls + '}'});
  };
  const auto taken = outcome(R"({"bottom": null})"), all = outcome("null"),
             added = outcome(R"({"a": {"type": "plane", "point": [0, 0, "-3 mm"], "material": "sand"}})");
  EXPECT_EQ(taken.status, 2);
  EXPECT_THAT(taken.err, HasSubstr("/stages/0/change/walls/bottom: found null, which would remove a wall; allowed"));
  EXPECT_EQ(all.status, 2);
  EXPECT_THAT(all.err, HasSubstr("/stages/0/change/walls: found null, which would remove a wall"));
  EXPECT_EQ(added.status, 2);
  EXPECT_THAT(added.err,
              HasSubstr("/stages/0/change/walls/a: found a wall that does not exist at the start of the run"));
  EXPECT_EQ(outcome(R"({"bottom": {"point": [0, 0, "-3 mm"]}})").status, 0);
  const auto list = outcome("[]");
  EXPECT_EQ(list.status, 2);
  EXPECT_THAT(list.err, testing::Not(HasSubstr("remove a wall")));
}

TEST(Descriptions, CheckReportsScenarioParametersWithoutEffect) {
  const OwnFolder folder;
  const auto check = [&](const std::string& file, std::vector<std::string> sets) {
    std::vector<std::string> words{"check", GRIT_SOURCE_DIR "/sims/interface-shear/" + file};
    for (const auto& set : sets) words.insert(words.end(), {"--set", set});
    const auto outcome = grit_in(folder.path(), words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  EXPECT_THAT(check("quick-flat.json", {}), testing::Not(HasSubstr("without effect")));
  EXPECT_THAT(check("quick-flat.json", {"/scenario/roughness=0.5", "/scenario/wavelength=15 mm"}),
              AllOf(HasSubstr("\nwithout effect\n  /scenario/roughness: the scene does not depend on it\n  "
                              "/scenario/wavelength: "),
                    testing::Not(HasSubstr("/scenario/width"))));
  EXPECT_THAT(check("quick-flat.json", {"/scenario/roughness=0.5", "/scenario/surface=saw-tooth"}),
              testing::Not(HasSubstr("without effect")));
}

TEST(Descriptions, CheckCountsGrainsOfAllLayersInADepth) {
  const OwnFolder folder;
  const auto outcome = grit_in(
      folder.path(),
      {"check", GRIT_SOURCE_DIR "/sims/silo-quasistatic/quick-very-rough-layers.json", "--set", "/scenario/depth=0.2"});
  EXPECT_THAT(outcome.out, HasSubstr("about 2368")) << outcome.err;
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

TEST(Check, ReportsTheRun) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto outcome = grit_in(folder.path(), {"check", "two.json", "--threads", "1"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("two.json: two grains"), HasSubstr("linear-rolling"), HasSubstr("time step: "),
                    HasSubstr("critical"), HasSubstr("memory: "), HasSubstr("bodies: 2"),
                    HasSubstr("contacts of pairs at the start: 1"), HasSubstr("estimated time on 1 thread "),
                    HasSubstr("frames: about 3 of "), HasSubstr(" are free on this disk\n")));
  EXPECT_FALSE(std::filesystem::exists(folder / "results"));
}

TEST(Check, CountsTheStepsOfEachStageAndRefusesThoseThatNeverEnd) {
  const OwnFolder folder;
  auto scene = json::parse(two_grains);
  scene["stages"][1] = {{"name", "wait"}, {"limit", 1e300}, {"until", {{"type", "time"}, {"value", 0.01}}}};
  folder.write("two.json", scene.dump());
  const auto grit = [&](const char* command, const std::vector<std::string>& sets) {
    std::vector<std::string> words{command, "two.json"};
    for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
    return grit_in(folder.path(), words);
  };
  const auto finer = grit("check", {"/time_step/value=1e-6", R"(/stages/1/change={"time_step": {"value": 1e-9}})"});
  EXPECT_EQ(finer.status, 0) << finer.err;
  EXPECT_THAT(finer.out, AllOf(HasSubstr("0.0002 s, 200 steps"), HasSubstr("0.01 s, 10000000 steps")));
  for (const char* command : {"check", "run"}) {
    for (const char* set : {"/stages/1/until/value=1e15", "/materials/sand/contact_modulus=1e40"}) {
      const auto endless = grit(command, {set});
      EXPECT_EQ(endless.status, 2) << command << ' ' << set;
      EXPECT_THAT(endless.err, HasSubstr("/stages/1/until: time never reaches ")) << command << ' ' << set;
    }
    const auto stiff = grit(command, {"/materials/sand/contact_modulus=1e300"});
    EXPECT_EQ(stiff.status, 2) << command;
    EXPECT_THAT(stiff.err, HasSubstr("/time_step: time does not advance in steps of 0 s; check the units of "));
  }
}

TEST(Check, ReportsTheSpeedThatShortensTheTimeStep) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto speed = [&](const std::string& set) {
    const std::string out = grit_in(folder.path(), {"check", "two.json", "--set", set}).out;
    std::smatch found;
    return std::regex_search(out, found, std::regex("shorter where bodies or walls are faster than ([0-9.e+-]+) m/s"))
               ? std::stod(found[1])
               : 0;
  };
  const double usual = speed("/seed=1");
  EXPECT_GT(usual, 0);
  EXPECT_NEAR(speed("/time_step/max_displacement=4e-6") / usual, 1e-4, 1e-6) << "the default is 0.04";
  EXPECT_EQ(speed("/time_step/value=1e-6"), 0) << "it stays as prescribed";
}

TEST(Check, ReportsTheNumberAndSizeOfFrames) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto frames = [&](const std::string& set) {
    const std::string out = grit_in(folder.path(), {"check", "two.json", "--set", set}).out;
    const auto at = out.find("\nframes: ");
    return at == std::string::npos ? "" : out.substr(at + 1, out.find('\n', at + 1) - at - 1);
  };
  EXPECT_THAT(frames("/seed=1"),
              testing::MatchesRegex("frames: about 3 of [0-9.]+ kB each, [0-9.]+ kB in all; .*B are free on this disk"))
      << "at the steps 0, 100 and 200, as a run writes them";
  EXPECT_THAT(frames("/output/frames={\"every_steps\": 1}"), HasSubstr("about 201 of "));
  EXPECT_THAT(frames("/stages/0/until={\"type\": \"unbalanced-force\", \"below\": 1e-3}"),
              HasSubstr("frames: at most "));
  EXPECT_EQ(frames("/output/frames=null"), "");
  ASSERT_EQ(grit_in(folder.path(), {"run", "two.json"}).status, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "results/two/frames/000002.h5"));
  EXPECT_FALSE(std::filesystem::exists(folder / "results/two/frames/000003.h5"));
}

TEST(Check, ReportsBodiesInsertedLater) {
  const OwnFolder folder;
  json scene = json::parse(two_grains);
  scene["bodies"]["late"] = scene["bodies"]["grains"];
  scene["bodies"]["late"]["stage"] = "part";
  folder.write("later.json", scene.dump());
  const auto outcome = grit_in(folder.path(), {"check", "later.json"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("bodies: 2, contacts of pairs at the start: 1\n  2 more in the stage part\n"));
}

/// The output of `expand` for a file, run in this folder.
std::string expanded(const std::filesystem::path& folder, const std::string& file) {
  const auto outcome = grit_in(folder, {"expand", file});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return outcome.out;
}

class Sims : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(Sims, ExpandToPlainDescriptionsThatStayAsTheyAre) {
  const OwnFolder folder;
  const std::string plain = expanded(folder.path(), GetParam());
  EXPECT_FALSE(json::parse(plain).contains("scenario"));
  EXPECT_FALSE(json::parse(plain).contains("extends"));
  folder.write("plain.json", plain);
  EXPECT_EQ(expanded(folder.path(), "plain.json"), plain);
}

/// The small ones alone: the big ones differ from them in numbers, and hold tens of thousands of grains.
class SmallSims : public Sims {};

TEST_P(SmallSims, AreCheckedWhenPlainAsTheyWereBefore) {
  const OwnFolder folder;
  folder.write("plain.json", expanded(folder.path(), GetParam()));
  const auto rest = [&](const std::string& file) {
    const auto outcome = grit_in(folder.path(), {"check", file, "--threads", "1"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    // What is free changes meanwhile.
    const std::regex free("; [^;\n]* are (available|free on this disk)");
    return std::regex_replace(outcome.out.substr(outcome.out.find('\n')), free, "");
  };
  EXPECT_EQ(rest("plain.json"), rest(GetParam()));
}

/// The descriptions of sims/ whose names begin with this.
std::vector<std::filesystem::path> sims(const std::string& start) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(GRIT_SOURCE_DIR "/sims"))
    if (entry.path().extension() == ".json" && entry.path().filename().string().starts_with(start) &&
        entry.path().parent_path().filename() != "studies")
      files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

std::string name_of(const testing::TestParamInfo<std::filesystem::path>& info) {
  std::string name = info.param.parent_path().filename().string() + "_" + info.param.stem().string();
  std::ranges::replace_if(
      name, [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, Sims, testing::ValuesIn(sims("")), name_of);
INSTANTIATE_TEST_SUITE_P(All, SmallSims, testing::ValuesIn(sims("quick")), name_of);

TEST(Expand, NamesFilesSoThatTheyAreFoundFromAnywhere) {
  const OwnFolder folder;
  auto scene = json::parse(two_grains);
  scene["bodies"]["grains"]["source"] = {{"type", "file"}, {"path", "grains.txt"}};
  folder.write("inner/scene.json", scene.dump());
  folder.write("inner/grains.txt", "0 0 0 1e-3\n");
  folder.write("elsewhere/plain.json", expanded(folder.path(), "inner/scene.json"));
  const auto outcome = grit_in(folder.path(), {"check", "elsewhere/plain.json"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("bodies: 1,"));
}

TEST(Expand, AppliesSets) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto outcome = grit_in(folder.path(), {"expand", "two.json", "--set", "/seed=7", "--set", "/title=\"other\""});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out).at("seed"), 7);
  EXPECT_EQ(json::parse(outcome.out).at("title"), "other");
}

TEST(Expand, AnObjectThatIsSetReplacesThatOfAFileAndIsMergedOntoThatOfAScenario) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto expand = [&](const std::string& file, const std::string& set) {
    const auto outcome = grit_in(folder.path(), {"expand", file, "--set", set});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return json::parse(outcome.out);
  };
  EXPECT_EQ(expand("two.json", R"(/materials/sand={"friction_angle": 0.1})").at("materials").at("sand"),
            json({{"friction_angle", 0.1}}));
  const auto platen = expand(GRIT_SOURCE_DIR "/sims/direct-shear/quick.json", R"(/walls/platen={"material": "sand"})")
                          .at("walls")
                          .at("platen");
  EXPECT_EQ(platen.at("material"), "sand");
  EXPECT_TRUE(platen.contains("type"));
  for (const char* command : {"run", "check", "expand", "advise"}) {
    std::string help = grit_in(folder.path(), {command, "--help"}).out;
    help = std::regex_replace(help, std::regex("\\s+"), " ");
    EXPECT_THAT(help, HasSubstr("an object replaces that of the file and is merged onto that of a scenario"))
        << command;
  }
}

TEST(Schema, IsAJsonSchema) {
  const OwnFolder folder;
  const auto outcome = grit_in(folder.path(), {"schema"});
  EXPECT_EQ(outcome.status, 0);
  const auto schema = json::parse(outcome.out);
  EXPECT_EQ(schema.at("$schema"), "http://json-schema.org/draft-07/schema#");
  EXPECT_EQ(schema.at("type"), "object");
}

TEST(Output, AFullDiskBehindARedirectionIsNoticed) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"schema"}, {"expand", "two.json"}, {"check", "two.json"}, {"plugins"}, {"describe", "walls"}}) {
    const auto outcome = grit_in(folder.path(), words, "/dev/full");
    EXPECT_EQ(outcome.status, 5) << words[0];
    EXPECT_THAT(outcome.err, HasSubstr("standard output cannot be written"));
  }
}

}  // namespace
}  // namespace grit
