// An exception out of any function of a plugin: the message names plugin and function, and the exit status is 3.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <regex>
#include <set>
#include <typeinfo>

#include "grit/body_kind.hpp"
#include "grit/contact/contact_law.hpp"
#include "grit/contact/device_pairs.hpp"
#include "grit/engine.hpp"
#include "grit/error.hpp"
#include "grit/geometry.hpp"
#include "grit/probe.hpp"
#include "grit/scenario.hpp"
#include "grit/simulation.hpp"
#include "grit/testing/fake_world.hpp"
#include "grit/toolkit/limited_fields.hpp"
#include "plugins/component_archive.hpp"
#include "plugins/registry.hpp"
#include "support/own_folder.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// Has a function of the plugins throw, in this process and in those that it starts.
class Throwing {
 public:
  Throwing(const std::string& function, const std::string& what) {
    ::setenv("THROW_IN", function.c_str(), 1);
    ::setenv("THROW_WHAT", what.c_str(), 1);
  }
  ~Throwing() { ::unsetenv("THROW_IN"); }
  Throwing(const Throwing&) = delete;
  Throwing& operator=(const Throwing&) = delete;
};

struct Case {
  const Kind* kind;
  std::string function;
  /// Makes a component, calls `begin`, then a function.
  std::function<void(const Registry&, const std::function<void()>& begin)> run;
  bool may_refuse;
  std::string name() const {
    std::string all = kind->name + ("_" + function);
    std::erase_if(all, [](char c) { return c == '(' || c == ')'; });
    std::ranges::replace(all, ' ', '_');
    return all;
  }
  friend std::ostream& operator<<(std::ostream& out, const Case& one) { return out << one.name(); }
};

template <class Interface>
const Kind* kind_of_interface() {
  return std::ranges::find(kinds, std::string_view(kind_name<Interface>()), &Kind::name);
}

enum class Refusal { never, allowed };

/// The cases of one kind.
template <class Interface>
class Cases {
 public:
  Cases& call(const std::string& function, std::function<void(Interface&)> of, Refusal refusal = Refusal::never) {
    const auto run = [of = std::move(of)](const Registry& registry, const std::function<void()>& begin) {
      const auto made = registry.make<Interface>("throwing");
      begin();
      of(*made);
    };
    all.push_back({kind_of_interface<Interface>(), function, run, refusal == Refusal::allowed});
    return *this;
  }
  /// What every kind has.
  Cases& common() {
    for (const std::string function :
         {std::string("grit_plugin()"), std::string("make_") + kind_name<Interface>() + "()"})
      all.push_back({kind_of_interface<Interface>(), function,
                     [](const Registry& registry, const std::function<void()>& begin) {
                       begin();
                       registry.make<Interface>("throwing");
                     },
                     false});
    call("declare() of a nested object", [](Interface& made) {
      Parameters p, inner;
      made.declare(p);
      std::get<ListTarget>(p.entries()[1].target()).append(inner);
    });
    declares("declare()", [](Interface& made, Parameters& p) { made.declare(p); });
    call(
        "choose()",
        [](Interface& made) {
          Parameters p, inner;
          choice_of(made, p, inner).choose("way");
        },
        Refusal::allowed);
    call("declare() of a choice", [](Interface& made) {
      Parameters p, inner;
      Choice& choice = choice_of(made, p, inner);
      choice.choose("way");
      choice.declare(inner);
    });
    call("when_read()", [](Interface& made) {
      Parameters p;
      made.declare(p);
      p.calls_when_read().front()();
    });
    return call("check of parameters", [](Interface& made) {
      Parameters p;
      made.declare(p);
      p.checks().front().run({});
    });
  }
  Cases& declares(const std::string& function, void (*declare)(Interface&, Parameters&)) {
    return call(function, [declare](Interface& made) {
      Parameters p;
      declare(made, p);
    });
  }

  std::vector<Case> all;

 private:
  /// The choice that `made` offers.
  static Choice& choice_of(Interface& made, Parameters& p, Parameters& inner) {
    made.declare(p);
    std::get<OptionalTarget>(p.entries()[2].target()).create(inner);
    return *inner.choice();
  }
};

const std::string steel = "steel";
const PairSize size{1, 1, 1, 1, 0};

std::vector<Case> all_cases() {
  Cases<BodyKind> body;
  body.common()
      .call(
          "prepare()", [](BodyKind& kind) { kind.prepare(); }, Refusal::allowed)
      .call("clump()", [](BodyKind& kind) { kind.clump(); })
      .call("volume()", [](BodyKind& kind) { kind.volume(1); })
      .call("inertia()", [](BodyKind& kind) { kind.inertia(1, 1); });

  Cases<ContactLaw> contact;
  contact.common()
      .declares("declare_material()", [](ContactLaw& law, Parameters& p) { law.declare_material(steel, p); })
      .declares("declare_interface()", [](ContactLaw& law, Parameters& p) { law.declare_interface(steel, steel, p); })
      .call("clear_materials()", [](ContactLaw& law) { law.clear_materials(); })
      .call("mix()",
            [](ContactLaw& law) {
              law.mix({&steel, 1}, 1);
            })
      .call("state()", [](ContactLaw& law) { law.state(); })
      .call("loop()", [](ContactLaw& law) { law.loop(); })
      .call("evaluate_pairs()",
            [](ContactLaw& law) {
              PairBatch batch{};
              law.evaluate_pairs(batch);
            })
      .call("evaluate_pairs_reference()",
            [](ContactLaw& law) {
              PairBatch batch{};
              law.evaluate_pairs_reference(batch);
            })
      .call("evaluate_walls()",
            [](ContactLaw& law) {
              WallBatch batch{};
              law.evaluate_walls(batch);
            })
      .call("device()", [](ContactLaw& law) { law.device(); })
      .call("evaluate_device_pairs()", [](ContactLaw& law) { law.evaluate_device_pairs(DevicePairs{}, nullptr, 0, 0); })
      .call("stiffness()", [](ContactLaw& law) { law.stiffness(size, 0, 0); })
      .call("has_reach()", [](ContactLaw& law) { law.has_reach(); })
      .call("reach()", [](ContactLaw& law) { law.reach(size, 0, 0); })
      .call("reaches()", [](ContactLaw& law) { law.reaches(1); })
      .call("mixed()", [](ContactLaw& law) { law.mixed(0, 0, false); })
      .call("energy()", [](ContactLaw& law) { law.energy(size, 0, 0, {}); });

  Cases<Engine> engine;
  engine.common()
      .call("phase()", [](Engine& one) { one.phase(); })
      .call("needs()", [](Engine& one) { one.needs(); })
      .call("settings()",
            [](Engine& one) {
              MotionSettings motion;
              one.settings(motion);
            })
      .call("forces()", [](Engine& one) { one.forces(FakeWorld(), {}, {}); })
      .call("removes()", [](Engine& one) { one.removes(FakeWorld(), Vec3::Zero()); })
      .call("rates()", [](Engine& one) { one.rates(FakeWorld()); })
      .call("serialize()", [](Engine& one) { saved_state(one); });

  Cases<Geometry> geometry;
  geometry.common()
      .call(
          "prepare()", [](Geometry& shape) { shape.prepare(); }, Refusal::allowed)
      .call("bounds()", [](Geometry& shape) { shape.bounds(); })
      .call("hollow()", [](Geometry& shape) { shape.hollow(); })
      .call("area()", [](Geometry& shape) { shape.area(); })
      .call("normal()", [](Geometry& shape) { shape.normal(); })
      .call("flat()", [](Geometry& shape) { shape.flat(); })
      .call("find_contacts()",
            [](Geometry& shape) {
              std::vector<SurfaceContact> contacts;
              shape.find_contacts({}, {}, contacts);
            })
      .call("near()", [](Geometry& shape) { shape.near({}, Vec3::Zero(), 1); })
      .call("triangles()", [](Geometry& shape) { shape.triangles(); })
      .call("triangle_of()", [](Geometry& shape) { shape.triangle_of(0); });

  Cases<Probe> probe;
  probe.common()
      .call("needs()", [](Probe& one) { one.needs(); })
      .call(
          "prepare()", [](Probe& one) { one.prepare(FakeWorld()); }, Refusal::allowed)
      .call("channels()", [](Probe& one) { one.channels(); })
      .call("sample()",
            [](Probe& one) {
              ChannelValues values("a probe", {});
              one.sample(FakeWorld(), values);
            })
      .call("fields()", [](Probe& one) { one.fields(FakeWorld()); })
      .call(
          "check_fields()", [](Probe& one) { dynamic_cast<LimitedFields&>(one).check_fields(FakeWorld()); },
          Refusal::allowed)
      .call("serialize()", [](Probe& one) { saved_state(one); });

  Cases<Scenario> scenario;
  scenario.common().call(
      "expand()", [](Scenario& one) { one.expand(); }, Refusal::allowed);

  std::vector<Case> all;
  for (const auto* part : {&body.all, &contact.all, &engine.all, &geometry.all, &probe.all, &scenario.all})
    all.insert(all.end(), part->begin(), part->end());
  return all;
}

class Boundary : public testing::TestWithParam<Case> {
 protected:
  /// Runs the case with an exception.
  static void run(const std::string& what) {
    const Registry registry({THROWING});
    std::optional<Throwing> throwing;
    GetParam().run(registry, [&] { throwing.emplace(GetParam().function, what); });
  }
  static std::string text(const std::string& what) {
    const auto& [kind, function, call, may_refuse] = GetParam();
    return std::string(kind->name) + " plugin \"throwing\" (" THROWING "/" + kind->folder + "/throwing.so): its " +
           function + " threw: " + what + "\n  fix the plugin, or choose another one";
  }
  static void expect_named(const std::string& what, const std::string& cause) {
    EXPECT_THAT([&] { run(what); }, testing::ThrowsMessage<PluginError>(text(cause))) << what;
  }
};

TEST_P(Boundary, NamesThePluginAndTheFunction) {
  expect_named("std::exception", "lost my way");
  expect_named("grit::PluginError", "lost my way");
  expect_named("42", "something that is not a std::exception");
  if (!GetParam().may_refuse) {
    expect_named("grit::Error", "lost my way");
    expect_named("grit::FileError", "lost my way");
    expect_named("grit::ParameterError", "way: found none; allowed is one");
  }
}

TEST_P(Boundary, LetsRefusalsPassWhereTheyAreFoundInTheDescription) {
  if (!GetParam().may_refuse) return;
  EXPECT_THAT([] { run("grit::ParameterError"); },
              testing::ThrowsMessage<ParameterError>("way: found none; allowed is one"));
  EXPECT_THAT([] { run("grit::FileError"); }, testing::ThrowsMessage<FileError>("lost my way"));
  try {
    run("grit::Error");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "lost my way");
    EXPECT_EQ(typeid(error), typeid(Error));
  }
}

TEST_P(Boundary, LetsExhaustionOfMemoryPass) { EXPECT_THROW(run("std::bad_alloc"), std::bad_alloc); }

INSTANTIATE_TEST_SUITE_P(Each, Boundary, testing::ValuesIn(all_cases()),
                         [](const auto& info) { return info.param.name(); });

/// The names of the virtual functions that a header declares, without destructors.
std::set<std::string> virtual_functions(const std::string& header) {
  const std::string text = text_of(std::string(GRIT_SOURCE_DIR "/core/include/grit/") + header);
  std::set<std::string> names;
  const std::regex declaration(R"(\bvirtual [^(;~]*?(\w+)\()");
  for (std::sregex_iterator one(text.begin(), text.end(), declaration), end; one != end; ++one)
    names.insert((*one)[1].str() + "()");
  return names;
}

TEST(BoundaryOfParameters, IsThatOfTheChecksOfAChoiceAndOfItsTwin) {
  const Registry registry({THROWING});
  const auto made = registry.make<BodyKind>("throwing");
  Parameters p, inner, of_twin;
  made->declare(p);
  std::get<OptionalTarget>(p.entries()[2].target()).create(inner);
  inner.choice()->choose("way");
  inner.choice()->declare(inner);
  const auto twin = inner.choice()->twin();
  twin->choose("way");
  twin->declare(of_twin);
  const Throwing throwing("check of parameters", "42");
  for (Parameters* one : {&inner, &of_twin})
    EXPECT_THAT([&] { one->checks().front().run({}); },
                testing::ThrowsMessage<PluginError>(HasSubstr("its check of parameters threw")));
}

TEST(BoundaryOfParameters, IsThatOfChecksOfNestedObjects) {
  const Registry registry({THROWING});
  const auto made = registry.make<BodyKind>("throwing");
  Parameters p, inner;
  made->declare(p);
  std::get<ObjectTarget>(p.entries()[0].target()).declare(inner);
  const Throwing throwing("check of parameters", "42");
  EXPECT_THAT([&] { inner.checks().front().run({}); },
              testing::ThrowsMessage<PluginError>(HasSubstr("its check of parameters threw: something")));
}

TEST(BoundaryCases, HaveEveryVirtualFunction) {
  const std::pair<const char*, const char*> headers[] = {
      {"body", "body_kind.hpp"},   {"contact", "contact/contact_law.hpp"},
      {"engine", "engine.hpp"},    {"geometry", "geometry.hpp"},
      {"probe", "probe.hpp"},      {"probe", "toolkit/limited_fields.hpp"},
      {"scenario", "scenario.hpp"}};
  std::set<std::string> tried;
  for (const Case& one : all_cases()) tried.insert(std::string(one.kind->name) + ' ' + one.function);
  for (const auto& [kind, header] : headers) {
    const auto functions = virtual_functions(header);
    EXPECT_FALSE(functions.empty()) << header;
    for (const std::string& function : functions)
      EXPECT_TRUE(tried.contains(std::string(kind) + ' ' + function)) << header << ": " << function;
  }
}

// ---- checkpoints

TEST(BoundaryOfACheckpoint, NamesTheComponentThatCannotBeRestored) {
  const Registry registry({THROWING});
  const auto engine = registry.make<Engine>("throwing");
  Archive saving;
  serialize_component("engine \"wind\"", *engine, saving);
  const auto restore = [&] {
    Archive archive(saving.bytes());
    serialize_component("engine \"wind\"", *engine, archive);
  };
  {
    const Throwing refusing("serialize()", "grit::Error");
    EXPECT_THAT(restore, testing::ThrowsMessage<PluginError>(
                             "engine \"wind\" cannot be restored from a checkpoint: lost my way"));
  }
  const Throwing any("serialize()", "42");
  EXPECT_THAT(restore, testing::ThrowsMessage<PluginError>(
                           AllOf(StartsWith("engine \"wind\" cannot be restored from a checkpoint: engine plugin"),
                                 HasSubstr("its serialize() threw: something that is not a std::exception"))));
}

// ---- the program

constexpr auto scene = R"({
  "contacts": {"type": "springs"},
  "materials": {"sand": {"density": 2600}},
  "bodies": {"grains": {"type": "throwing", "material": "sand", "source": {"type": "list", "bodies": [
    {"position": [0, 0, "0.9999 mm"], "radius": "1 mm"},
    {"position": ["1.9999 mm", 0, "0.9999 mm"], "radius": "1 mm"}
  ]}}},
  "walls": {"floor": {"type": "throwing", "material": "sand"}},
  "engines": {
    "acts": {"type": "throwing"},
    "removes": {"type": "throwing", "acts_in": "removal"},
    "sets": {"type": "throwing", "acts_in": "settings"}
  },
  "probes": {"counter": {"type": "throwing", "every_steps": 10}},
  "stages": [{"name": "part", "until": {"type": "steps", "value": 20}, "limit": "1 s"}]
})";

Outcome run_scene(const std::vector<std::string>& more = {}) {
  const OwnFolder folder;
  folder.write("scene.json", scene);
  std::vector<std::string> words{"run",     "scene.json",  "--out",         "results",
                                 "--quiet", "--no-report", "--plugin-path", THROWING};
  words.insert(words.end(), more.begin(), more.end());
  return grit_in(folder.path(), words);
}

TEST(BoundaryOfTheProgram, LetsPluginsWork) {
  const Outcome outcome = run_scene();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
}

struct Called {
  std::string kind, file, function;
  std::string thrown_in = function;  ///< called by `function`
  std::string name() const {
    std::string all = kind + '_' + thrown_in;
    std::erase_if(all, [](char c) { return c == '(' || c == ')' || c == ':'; });
    return all;
  }
  friend std::ostream& operator<<(std::ostream& out, const Called& one) { return out << one.name(); }
};

class BoundaryOfARun : public testing::TestWithParam<Called> {};

TEST_P(BoundaryOfARun, EndsItWithStatus3) {
  const auto& [kind, file, function, thrown_in] = GetParam();
  for (const auto& [what, cause] :
       {std::pair("std::exception", "lost my way"), std::pair("42", "something that is not a std::exception")}) {
    const Throwing throwing(thrown_in, what);
    const Outcome outcome = run_scene();
    EXPECT_EQ(outcome.status, 3) << what;
    EXPECT_THAT(outcome.err,
                HasSubstr(kind + " plugin \"" + std::filesystem::path(file).stem().string() + "\" (" THROWING "/" +
                          file + "): its " + function + " threw: " + cause + "\n  fix the plugin"))
        << what;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Each, BoundaryOfARun,
    testing::Values(
        Called{"body", "bodies/throwing.so", "make_body()"}, Called{"body", "bodies/throwing.so", "clump()"},
        Called{"body", "bodies/throwing.so", "volume()"}, Called{"body", "bodies/throwing.so", "inertia()"},
        Called{"contact", "contacts/springs.so", "declare_material()", "Material::declare()"},
        Called{"contact", "contacts/springs.so", "mix()"}, Called{"contact", "contacts/springs.so", "stiffness()"},
        Called{"contact", "contacts/springs.so", "evaluate_pairs()", "evaluate()"},
        Called{"engine", "engines/throwing.so", "make_engine()"}, Called{"engine", "engines/throwing.so", "phase()"},
        Called{"engine", "engines/throwing.so", "settings()"}, Called{"engine", "engines/throwing.so", "forces()"},
        Called{"engine", "engines/throwing.so", "removes()"}, Called{"engine", "engines/throwing.so", "rates()"},
        Called{"geometry", "geometry/throwing.so", "make_geometry()"},
        Called{"geometry", "geometry/throwing.so", "bounds()"},
        Called{"geometry", "geometry/throwing.so", "find_contacts()"},
        Called{"probe", "probes/throwing.so", "make_probe()"}, Called{"probe", "probes/throwing.so", "channels()"},
        Called{"probe", "probes/throwing.so", "sample()"}),
    [](const auto& info) { return info.param.name(); });

/// The record of a run says so, too, wherever the exception comes from.
TEST(BoundaryOfTheProgram, RecordsThatARunHasFailed) {
  for (const std::string function : {"evaluate()", "forces()", "sample()", "find_contacts()"}) {
    const Throwing throwing(function, "std::exception");
    ::setenv("THROW_AFTER", function == "sample()" ? "1" : "10", 1);
    const OwnFolder folder;
    folder.write("scene.json", scene);
    const Outcome outcome = grit_in(folder.path(), {"run", "scene.json", "--out", "results", "--quiet", "--no-report",
                                                    "--threads", "1", "--plugin-path", THROWING});
    ::unsetenv("THROW_AFTER");
    EXPECT_EQ(outcome.status, 3) << function;
    const auto run = nlohmann::json::parse(text_of(folder / "results/run.json"));
    EXPECT_EQ(run.at("status"), "failed") << function;
    const std::string message = run.at("message");
    EXPECT_THAT(message, AllOf(HasSubstr(" threw: lost my way"), HasSubstr("plugin \""))) << function;
    EXPECT_THAT(outcome.err, HasSubstr(message));
  }
}

/// Bodies may have moved, and some probes have sampled while others have not.
TEST(BoundaryOfASimulation, EndsIt) {
  for (const std::string function : {"evaluate()", "forces()", "sample()"}) {
    Simulation simulation(Description::parse(scene), {.plugin_path = {THROWING}});
    std::string why;
    {
      const Throwing throwing(function, "std::exception");
      try {
        simulation.run();
      } catch (const PluginError& error) {
        why = error.what();
      }
    }
    EXPECT_THAT(why, HasSubstr("threw: lost my way"));
    const auto said = testing::ThrowsMessage<PluginError>(why);
    EXPECT_THAT([&] { simulation.run(); }, said) << function;
    EXPECT_THAT([&] { simulation.step(1); }, said) << function;
    EXPECT_THAT([&] { simulation.save(); }, said) << function;
  }
}

TEST(BoundaryOfTheProgram, RecordsThatALastSampleHasFailed) {
  const Throwing throwing("sample()", "std::exception");
  ::setenv("THROW_AFTER", "1", 1);
  const OwnFolder folder;
  folder.write("scene.json", scene);
  const Outcome outcome = grit_in(folder.path(), {"run", "scene.json", "--out", "results", "--quiet", "--no-report",
                                                  "--plugin-path", THROWING, "--set", "/stages/0/limit=1e-9", "--set",
                                                  "/stages/0/until={\"type\": \"mean-stress\", \"above\": 1e9}"});
  ::unsetenv("THROW_AFTER");
  EXPECT_EQ(outcome.status, 3) << outcome.err;
  EXPECT_EQ(nlohmann::json::parse(text_of(folder / "results/run.json")).at("status"), "failed");
}

TEST(BoundaryOfTheProgram, RecordsARunOfAStudyThatHasFailed) {
  const Throwing throwing("sample()", "std::exception");
  ::setenv("THROW_AFTER", "1", 1);
  const OwnFolder folder;
  folder.write("scene.json", scene);
  folder.write("study.json", R"({"scene": "scene.json", "purpose": "sweep",
    "settings": {"safety": {"pointers": ["/time_step/safety"], "values": [0.8, 0.4]}}, "seeds": {"values": [1]},
    "metrics": {"bodies": {"type": "last", "of": "counter/bodies"}}})");
  const Outcome outcome =
      grit_in(folder.path(), {"study", "study.json", "--out", "study", "--jobs", "1", "--plugin-path", THROWING});
  ::unsetenv("THROW_AFTER");
  EXPECT_EQ(outcome.status, 5) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("seed 1 ended with status 3"), HasSubstr("threw: lost my way")));
  const auto run = nlohmann::json::parse(text_of(folder / "study/runs/safety=0.8/seed-1/run.json"));
  EXPECT_EQ(run.at("status"), "failed");
}

TEST(BoundaryOfTheProgram, NamesAFunctionThatThrowsInAThread) {
  const Throwing throwing("near()", "42");
  // Several chunks of bodies, which threads share.
  const Outcome outcome =
      run_scene({"--threads", "2", "--set",
                 R"(/bodies/grains/source={"type": "cloud", "low": [0, 0, 0], "high": [0.05, 0.05, 0.05], "count": 600,
                                 "sizes": {"type": "uniform", "smallest": 0.001, "largest": 0.001}})"});
  EXPECT_EQ(outcome.status, 3) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("its near() threw: something that is not a std::exception"));
}

TEST(BoundaryOfTheProgram, RefusesChannelsThatCannotBeWritten) {
  for (const std::string name : {"", "a/b", "time"}) {
    ::setenv("CHANNEL", name.c_str(), 1);
    const Outcome outcome = run_scene();
    ::unsetenv("CHANNEL");
    EXPECT_EQ(outcome.status, 3) << name;
    EXPECT_THAT(outcome.err, HasSubstr("probe plugin \"throwing\" (" THROWING "/probes/throwing.so): its channels() "
                                       "returned a channel of the name \"" +
                                       name + '"'));
  }
}

TEST(BoundaryOfTheProgram, TakesTheFirstListOfChannels) {
  ::setenv("MORE_CHANNELS", "", 1);
  const Outcome outcome = run_scene();
  ::unsetenv("MORE_CHANNELS");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
}

TEST(BoundaryOfTheProgram, IsNotLeftByExit) {
  const Throwing leaving("sample()", "exit(0)");
  const Outcome outcome = run_scene();
  EXPECT_EQ(outcome.status, 70);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr(THROWING "/probes/throwing.so called exit() before grit was done"),
                                 HasSubstr("fix the plugin"), HasSubstr("grit run --resume")));
}

/// No fault of the plugin: the message says how the run goes on.
TEST(BoundaryOfTheProgram, LeavesWantOfMemoryToTheRun) {
  const Throwing throwing("sample()", "std::bad_alloc");
  const Outcome outcome = run_scene();
  EXPECT_EQ(outcome.status, 5);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("out of memory: "),
                                 HasSubstr("or a machine with more memory\n  then run it "
                                           "again, as there is no checkpoint yet: 'grit "
                                           "run --overwrite scene.json'"),
                                 Not(HasSubstr("fix the plugin"))));
}

TEST(BoundaryOfTheProgram, ReportsARefusalAtItsPlace) {
  const Throwing throwing("prepare()", "grit::ParameterError");
  const Outcome outcome = run_scene();
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("scene.json:"), HasSubstr("found none; allowed is one"),
                                 Not(HasSubstr("fix the plugin"))));
}

TEST(BoundaryOfAScenario, EndsItsExpansionWithStatus3) {
  const OwnFolder folder;
  folder.write("scene.json", R"({"scenario": {"type": "throwing"}})");
  for (const std::string function : {"declare()", "check of parameters", "expand()"}) {
    const Throwing throwing(function, "42");
    const Outcome outcome = grit_in(folder.path(), {"expand", "scene.json", "--plugin-path", THROWING});
    EXPECT_EQ(outcome.status, 3) << function;
    EXPECT_THAT(outcome.err, HasSubstr("scenario plugin \"throwing\" (" THROWING "/scenarios/throwing.so): its " +
                                       function + " threw: something that is not a std::exception"));
  }
}

}  // namespace
}  // namespace grit
