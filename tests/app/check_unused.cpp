// Settings without effect, which `check` reports.
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scenes.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

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

TEST(Descriptions, CheckAndRunWarnOfDensitiesWithWhichNoBodyIsMade) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto stages = [](const std::string& first, const std::string& second) {
    return R"(/stages=[{"name": "part", "until": {"type": "steps", "value": 5}, "limit": "1 s", )" + first +
           R"(}, {"name": "rest", "until": {"type": "steps", "value": 5}, "limit": "1 s", )" + second + "}]";
  };
  const std::string
      heavy = R"("change": {"materials": {"sand": {"density": 5200}}})",
      none = R"("change": {})",
      ramp = R"("ramps": [{"pointer": "/materials/sand/density", "from": 2600, "to": 5200, "duration": 1e-6}])";
  const auto later = [](const std::string& stage) {
    return R"(/bodies/later={"type": "sphere", "material": "sand", "stage": ")" + stage +
           R"(", "source": {"type": "list", "bodies": [{"position": ["10 mm", 0, 0], "radius": "1 mm"}]}})";
  };
  const std::string stream =
      R"(/bodies/later={"type": "sphere", "material": "sand", "stage": "rest", "source": {"type": "stream",
      "number_rate": 100, "region": {"type": "disc", "centre": [0, 0, "5 cm"], "radius": "1 cm"},
      "sizes": {"type": "uniform", "smallest": "1 mm", "largest": "2 mm"}}})";
  const std::string why =
      ": bodies keep the mass that they were made with, streams the density of the description, and no "
      "body of \"sand\" is made with this density; set /materials/sand/density, or let";
  const std::string first = "/stages/0/change/materials/sand/density",
                    second = "/stages/1/change/materials/sand/density";
  const auto expect = [&](const std::vector<std::string>& sets, const std::vector<std::string>& idle) {
    for (const std::string command : {"check", "run"}) {
      std::vector<std::string> words{command, "two.json"};
      if (command == "run") words.insert(words.end(), {"--overwrite", "--no-report"});
      for (const auto& set : sets) words.insert(words.end(), {"--set", set});
      const auto outcome = grit_in(folder.path(), words);
      EXPECT_EQ(outcome.status, 0) << outcome.err;
      const std::string& text = command == "run" ? outcome.err : outcome.out;
      const std::string before = command == "run" ? "warning: --set: " : "  ";
      for (const std::string& pointer : {first, second, std::string("/stages/0/ramps/0")})
        if (std::ranges::find(idle, pointer) == idle.end()) EXPECT_THAT(text, testing::Not(HasSubstr(pointer)));
        else EXPECT_THAT(text, HasSubstr(before + pointer + (command == "run" ? ": without effect" : "") + why));
    }
  };
  expect({stages(none, heavy)}, {second});
  expect({stages(heavy, none)}, {first});
  expect({stages(heavy, none), later("part")}, {});
  expect({stages(heavy, none), later("rest")}, {});
  expect({stages(none, heavy), later("rest")}, {});
  expect({stages(none, heavy), later("part")}, {second});
  expect({stages(none, heavy), stream}, {second});
  expect({stages(ramp, none)}, {"/stages/0/ramps/0"});
  expect({stages(ramp, none), later("part")}, {"/stages/0/ramps/0"});
  expect({stages(ramp, none), later("rest")}, {});
  expect({stages(heavy, R"("change": {"materials": {"sand": {"density": 7800}}})"), later("rest")}, {first});
  expect({stages(none, R"("change": {"materials": {"sand": {"density": 2600}}})")}, {});
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

}  // namespace
}  // namespace grit
