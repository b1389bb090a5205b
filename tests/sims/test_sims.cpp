#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "bodies/clump_body.hpp"
#include "bodies/make_bodies.hpp"
#include "bodies/sphere_body.hpp"
#include "calibration/description.hpp"
#include "input/scene.hpp"
#include "input/schema.hpp"
#include "motion/builtin.hpp"
#include "schema_check.hpp"
#include "study/variants.hpp"
#include "support/packing.hpp"
#include "support/recorded.hpp"
#include "support/scene.hpp"

namespace grit {
namespace {

const std::filesystem::path sims_folder = GRIT_SOURCE_DIR "/sims";

const Registry& registry() {
  static const auto all = [] {
    auto made = std::make_unique<Registry>(std::vector<std::filesystem::path>{GRIT_PLUGIN_DIR});
    made->add(sphere_body());
    made->add(clump_body());
    for (const PluginInfo& engine : builtin_engines()) made->add(engine);
    return made;
  }();
  return *all;
}

const SchemaCheck& schema() {
  static const SchemaCheck check(scene_schema(registry()));
  return check;
}

class Sims : public testing::TestWithParam<std::filesystem::path> {
 protected:
  /// The file with one key changed, where it can still extend its neighbours.
  std::filesystem::path spoilt() const {
    std::ifstream stream(GetParam());
    auto json = nlohmann::json::parse(stream);
    json["titel"] = "no key of a description";
    if (json.contains("extends"))
      json["extends"] = (GetParam().parent_path() / json["extends"].get<std::string>()).string();
    const auto path = std::filesystem::path(testing::TempDir()) / ("grit-spoilt-" + name_of(GetParam()) + ".json");
    std::ofstream(path) << json;
    return path;
  }

 public:
  static std::string name_of(const std::filesystem::path& file) {
    std::string name = std::filesystem::relative(file, sims_folder).replace_extension().string();
    std::ranges::replace_if(
        name, [](unsigned char c) { return !std::isalnum(c); }, '_');
    return name;
  }
};

TEST_P(Sims, AreTakenByTheKernel) { EXPECT_EQ(kernel_refusal(GetParam(), registry()), ""); }

TEST_P(Sims, AreTakenByTheSchema) { EXPECT_EQ(schema().refusal(GetParam()), ""); }

TEST_P(Sims, AreRefusedByBothWithAWrongKey) {
  const auto file = spoilt();
  EXPECT_THAT(kernel_refusal(file, registry()), testing::HasSubstr("titel"));
  EXPECT_NE(schema().refusal(file), "");
  std::filesystem::remove(file);
}

/// Files of the folder "studies" or "calibrations", or the descriptions, which are in all others.
std::vector<std::filesystem::path> files(const std::string& kind = "") {
  std::vector<std::filesystem::path> all;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(sims_folder)) {
    const std::string folder = entry.path().parent_path().filename();
    const bool is_special = folder == "studies" || folder == "calibrations";
    if (entry.path().extension() == ".json" && (kind.empty() ? !is_special : folder == kind))
      all.push_back(entry.path());
  }
  std::ranges::sort(all);
  return all;
}

INSTANTIATE_TEST_SUITE_P(All, Sims, testing::ValuesIn(files()),
                         [](const auto& info) { return Sims::name_of(info.param); });

/// Nobody listens.
struct Silent final : Recorder {
  RunSummary summary;
  void begin(const World&, std::span<const ProbeGroup>) override {}
  void sample(std::size_t, const World&, std::span<const std::span<const double>>) override {}
  void frame(const World&, std::span<const FieldGroup>) override {}
  void stage_ended(const World&, const std::string&) override {}
  void finish(const World&, const RunSummary& how) override { summary = how; }
};

class QuickSims : public Sims {};

// Every stage for a while, with all that it changes and measures; what is reached is for longer runs to tell.
TEST_P(QuickSims, RunAWhile) {
  Document document = load_document(GetParam(), {}, registry());
  const std::size_t stages = document.json().at("stages").size();
  for (std::size_t i = 0; i < stages; ++i) {
    const std::string stage = "/stages/" + std::to_string(i);
    document.set(stage + R"(/until={"type": "steps", "value": 50})");
    if (document.json().at("stages")[i].contains("expect")) document.erase(stage + "/expect");
  }
  Silent recorder;
  Simulation simulation = test::recorded(read_scene(document, registry()), recorder, 2);
  run_recorded(simulation);
  EXPECT_EQ(recorder.summary.status, "done") << recorder.summary.message;
  EXPECT_EQ(recorder.summary.steps, 50 * stages);
  const auto& probes = simulation.parts().opened->scene.description->probes;
  ASSERT_EQ(recorder.summary.probes.size(), probes.size());
  for (const auto& [name, samples, seconds] : recorder.summary.probes) {
    EXPECT_EQ(probes.count(name), 1u);
    EXPECT_GE(samples, 1u) << name << " looks at the end of a stage at least";
    EXPECT_GT(seconds, 0) << name;
  }
}

std::vector<std::filesystem::path> quick_files() {
  auto all = files();
  std::erase_if(all, [](const auto& file) { return !file.stem().string().starts_with("quick"); });
  return all;
}

INSTANTIATE_TEST_SUITE_P(All, QuickSims, testing::ValuesIn(quick_files()),
                         [](const auto& info) { return Sims::name_of(info.param); });

// Scenarios reckon with the volume of a clump of their own shape over that of the sphere that encloses it.
TEST(Clumps, FillASpecimenToTheVoidRatioThatIsAskedFor) {
  const Document document = load_document(
      sims_folder / "triaxial/quick-clumps.json",
      {"/scenario/smallest_diameter=6e-3", "/scenario/largest_diameter=6e-3", "/scenario/void_ratio=0.6"}, registry());
  const Scene scene = read_scene(document, registry());
  const LiveScene live(scene);
  const Bodies bodies = make_bodies(live.now(), live.components(), requested_state(live.components()));
  const auto& clumps = bodies.clumps.clump;
  ASSERT_GT(clumps.size(), 500u);
  double solids = 0;
  for (const Clump& one : clumps) solids += one.volume;
  EXPECT_NEAR(solids * 1.6 / std::pow(60e-3, 3), 1, 2e-3);
}

/// What a description has its curves compared with.
Description references(const std::string& name) {
  const Document document = load_document(sims_folder / (name + ".json"), {}, registry());
  const Description::json_pointer place("/output/references");
  return document.json().contains(place) ? document.json().at(place) : Description::object();
}

/// Those that scenarios work out themselves are named for whom they are by.
bool is_closed_form(const std::string& reference) {
  constexpr std::array names{"Janssen", "Drescher", "EN_1991-4", "Beverloo", "Rankine"};
  return std::ranges::any_of(names, [&](const char* name) { return reference.starts_with(name); });
}

/// The others.
Description published(const std::string& name) {
  Description all = references(name), others = Description::object();
  for (const auto& [words, reference] : all.items())
    if (!is_closed_form(words)) others[words] = reference;
  return others;
}

// What a curve is held against in docs/evidence/reproduction.json stands beside it in its description, and nothing else
// of the curves that are held against something.
TEST(References, AreThoseOfTheReproduction) {
  std::ifstream stream(GRIT_SOURCE_DIR "/docs/evidence/reproduction.json");
  const auto rows = nlohmann::json::parse(stream).at("figures");
  ASSERT_GT(rows.size(), 100u);
  const auto short_of = [](double value) {
    std::ostringstream digits;
    digits << std::setprecision(4) << value;
    return digits.str();
  };
  std::map<std::string, std::multiset<std::pair<std::string, std::string>>> wanted;
  for (const auto& row : rows) {
    auto& of_description = wanted[row.at("description")];
    // Where a curve is largest is no value of it, and the balance of forces is not of the reference.
    if (row.at("how") == "where largest" || row.at("of") == "test/balance") continue;
    of_description.emplace(
        row.at("of"), short_of((row.at("reference").get<double>() - row.value("plus", 0.0)) / row.value("scale", 1.0)));
  }
  for (const auto& [name, values] : wanted) {
    std::multiset<std::pair<std::string, std::string>> named;
    const Description all = published(name);
    for (const auto& [words, reference] : all.items()) {
      EXPECT_THAT(words, testing::HasSubstr("Grabowski_2024")) << name;
      const std::string of = reference.at("of");
      named.emplace(of, short_of(reference.at("value").get<double>()));
    }
    EXPECT_EQ(named, values) << name;
  }
}

TEST(References, AreNotTakenOverByOtherPackings) {
  EXPECT_EQ(references("direct-shear/quick").size(), 3u);
  EXPECT_EQ(references("direct-shear/quick-every-probe").size(), 3u);
  EXPECT_TRUE(references("direct-shear/quick-loose").empty());
  EXPECT_FALSE(published("silo-quasistatic/full-very-rough").empty());
  const Description loose = published("silo-quasistatic/full-very-rough-loose");
  EXPECT_EQ(loose.size(), 1u) << loose;
  EXPECT_TRUE(loose.contains("wall_friction_angle_in_the_end_Grabowski_2024"));
}

// Of silos 0.2 x 0.5 x 0.6 m: Grabowski (2024), table 5.3.
TEST(References, HaveTheForcesOfTheReferencesFormulas) {
  struct Row {
    const char* name;
    double drescher, en_1991_4;
  };
  for (const auto& [name, drescher, en_1991_4] :
       {Row{"full-smooth", 533, 655}, Row{"full-rough", 490, 508}, Row{"full-very-rough", 537, 446}}) {
    const Description all = references(std::string("silo-quasistatic/") + name);
    const auto force = [&](const char* form) { return all.at(form).at("value").get<double>() * 0.6 / 7.5e-3; };
    EXPECT_NEAR(force("Drescher"), drescher, 0.01 * drescher) << name;
    EXPECT_NEAR(force("EN_1991-4"), en_1991_4, 0.01 * en_1991_4) << name;
  }
}

TEST(References, OfADescriptionStandBesideClosedForms) {
  const Description all = references("silo-quasistatic/full-very-rough");
  EXPECT_EQ(all.at("P_over_G_after_filling_Grabowski_2024").at("value"), 0.5);
  EXPECT_TRUE(all.contains("Janssen_P_over_G"));
  Document own = load_document(sims_folder / "silo-quasistatic/full-very-rough.json",
                               {"/output/references/Janssen_K/value=0.7"}, registry());
  EXPECT_EQ(own.json().at("output").at("references").at("Janssen_K").at("value"), 0.7) << "a description's own wins";
}

/// A small direct shear test with these probes as it is sheared; frames ask them for their fields too.
Simulation sheared(const std::map<std::string, std::string>& probes) {
  Document document = load_document(
      sims_folder / "direct-shear/quick.json",
      {"/scenario/width=6e-3", "/scenario/height=4e-3", "/scenario/preparation_inertial_number=0.03"}, registry());
  document.set("/probes={}");
  for (const auto& [type, settings] : probes)
    document.set("/probes/" + type + "={\"type\": \"" + type + R"(", "every_steps": 20, "stages": ["shear"])" +
                 (settings.empty() ? "" : ", " + settings) + "}");
  document.set(R"(/output={"frames": {"every_steps": 10000}})");
  const std::size_t last = document.json().at("stages").size() - 1;
  document.set("/stages/" + std::to_string(last) + R"(/until={"type": "steps", "value": 200})");
  Silent recorder;
  Simulation simulation = test::recorded(read_scene(document, registry()), recorder, 2);
  run_recorded(simulation);
  EXPECT_EQ(recorder.summary.status, "done") << recorder.summary.message;
  EXPECT_EQ(simulation.world().stage(), "shear");
  return simulation;
}

TEST(Probes, AllAtOnceChangeNotOneBit) {
  // What a probe cannot do without, where the defaults are not enough.
  const std::map<std::string, std::string> asked = {
      {"flow", R"("outlets": {"all": {"low": "-1 m", "high": "1 m"}})"},
      {"formula", R"("curves": {"way": {"formula": "platen_travel_z", "unit": "m", "doc": "of the platen"}})"},
      {"interface", R"("wall": "platen", "driven_by": "bottom")"},
      {"slip", R"("wall": "platen", "driven_by": "bottom")"},
      {"spectrum", R"("wall": "platen", "interval": "1 us", "points": 16)"},
      {"wall-profile", R"("walls": ["platen"], "width": "9 mm", "along": "x")"}};
  std::map<std::string, std::string> all;
  for (const std::string& name : registry().names("probe")) all[name] = asked.contains(name) ? asked.at(name) : "";
  all.erase("facets");  // needs a mesh
  EXPECT_GE(all.size(), 16u);
  Simulation without = sheared({}), with = sheared(all);
  EXPECT_GT(test::kernel_of(with).state().pairs.touching_count(), 100u);
  EXPECT_TRUE(test::same_bits(test::kernel_of(without), test::kernel_of(with)));
}

class Studies : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(Studies, AskForRunsThatTheKernelTakes) {
  const StudyDescription study = load_study(GetParam());
  for (const Variant& variant : variants(study))
    EXPECT_NO_THROW(LiveScene(load_scene(study.scene, sets_of(study, variant, study.seeds.values.front()), registry())))
        << variant.name;
}

class Calibrations : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(Calibrations, BeginWithARunThatTheKernelTakes) {
  const CalibrationDescription calibration = load_calibration(GetParam());
  std::vector<double> first;
  for (const auto& [name, parameter] : calibration.parameters) first.push_back(parameter.first_value());
  auto sets = sets_of(calibration, first);
  sets.push_back(calibration.samples.pointer + "=1");
  EXPECT_NO_THROW(LiveScene(load_scene(calibration.base, sets, registry())));
}

INSTANTIATE_TEST_SUITE_P(All, Calibrations, testing::ValuesIn(files("calibrations")),
                         [](const auto& info) { return Sims::name_of(info.param); });

INSTANTIATE_TEST_SUITE_P(All, Studies, testing::ValuesIn(files("studies")),
                         [](const auto& info) { return Sims::name_of(info.param); });

}  // namespace
}  // namespace grit
