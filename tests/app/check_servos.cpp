// Servos whose targets cannot be met, and bodies too soft for them, of which `check` warns.
#include <gmock/gmock.h>

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
using testing::StartsWith;

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

}  // namespace
}  // namespace grit
