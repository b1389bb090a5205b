#include "input/scene.hpp"

#include <algorithm>
#include <set>
#include <tuple>

#include "input/never_holds.hpp"
#include "input/places.hpp"
#include "input/reader.hpp"
#include "input/writer.hpp"
#include "scene/servo_face.hpp"

namespace grit {
namespace {

/// Reads a document whole. Null if it has problems, which are added unless they are known already.
std::shared_ptr<SceneDescription> read_whole(const Document& document, const Registry& registry,
                                             std::vector<Problem>& problems) {
  auto scene = std::make_shared<SceneDescription>(registry);
  Parameters parameters;
  scene->declare(parameters);
  std::vector<Problem> found;
  read(document, "", parameters, found);
  const auto same = [](const Problem& a, const Problem& b) {
    return std::tie(a.file, a.line, a.pointer, a.message) == std::tie(b.file, b.line, b.pointer, b.message);
  };
  for (auto& problem : found)
    if (std::ranges::none_of(problems, [&](const Problem& known) { return same(known, problem); }))
      problems.push_back(problem);
  if (!found.empty()) return nullptr;
  for (auto& [name, group] : scene->bodies) group.kind->prepare();
  for (auto& [name, wall] : scene->walls) wall.geometry->prepare();
  return scene;
}

/// Lets lists that are nowhere in the document, but in what it resolves to, stand in it, so that a pointer to one of
/// their entries finds them.
void write_out_lists(Document& document, const Description& resolved, const std::string& pointer) {
  for (auto slash = pointer.find('/', 1); slash != std::string::npos; slash = pointer.find('/', slash + 1)) {
    const std::string parent = pointer.substr(0, slash);
    const Description::json_pointer at(parent);
    if (document.json().contains(at) || !resolved.contains(at) || !resolved.at(at).is_array()) continue;
    document.set(parent, resolved.at(at), document.origin(parent));
  }
}

/// The typed scenes of the stages, one change after the other.
class Planner {
 public:
  Planner(const Document& document, const Registry& registry, std::vector<Problem>& problems)
      : written_(document), now_(document), registry_(registry), problems_(problems) {}

  StagePlan stage(std::size_t number) {
    StagePlan plan;
    const std::string at = "/stages/" + std::to_string(number);
    const auto& stage = written_.json().at("stages").at(number);
    if (const auto change = stage.find("change"); change != stage.end() && change->is_object())
      now_.merge(written_, at + "/change");
    same_walls(at + "/change/walls");
    plan.start = read_whole(now_, registry_, problems_);
    if (!plan.start) return plan;
    const auto& ramps = plan.start->stages.at(number).ramps;
    for (std::size_t i = 0; i < ramps.size(); ++i) {
      const auto& before = plan.ramp.empty() ? *plan.start : *plan.ramp.back();
      if (!ramp(ramps[i], at + "/ramps/" + std::to_string(i), before, plan.ramp)) return plan;
    }
    for (const auto& [pointer, message] : never_holds(plan, number))
      problems_.push_back(written_.problem(pointer, message));
    servos_press(*plan.start, number);
    note_turns(*plan.start);
    for (const auto& increment : plan.ramp) {
      note_turns(*increment);
      servos_press(*increment, number);
    }
    return plan;
  }

 private:
  /// Probes and what a wall remembers of its contacts go by the walls that a run begins with.
  void same_walls(const std::string& changed) {
    if (now_.json().contains("walls") && !now_.json().at("walls").is_object()) return;  // told as it is read
    const Description none = Description::object();
    const auto walls = [&](const Document& document) -> const Description& {
      const auto found = document.json().find("walls");
      return found != document.json().end() && found->is_object() ? *found : none;
    };
    const auto refuse_of = [&](const Document& these, const Document& others, const std::string& message) {
      for (const auto& [name, wall] : walls(these).items()) {
        if (walls(others).contains(name) || !refused_.insert(name).second) continue;
        const std::string at = changed + '/' + pointer_token(name);
        const bool is_written = written_.json().contains(Description::json_pointer(at));
        problems_.push_back(written_.problem(is_written ? at : changed, message));
      }
    };
    refuse_of(now_, written_,
              "found a wall that the run does not begin with; allowed are those of /walls: let it begin out of the "
              "bodies' way, and let the stage say where it stands then");
    refuse_of(written_, now_,
              "found null, which would take a wall away; allowed is what it is from then on: let the stage say where "
              "it stands, out of the bodies' way");
  }

  /// Which way a wall faces once it has turned, the run alone knows.
  void note_turns(const SceneDescription& scene) {
    for (const auto& [name, wall] : scene.walls)
      if (const MotionDescription& motion = wall.motion;
          !motion.spin.isZero(0.0) || (motion.oscillation && !motion.oscillation->angle.isZero(0.0)))
        turned_.insert(name);
  }

  /// What a servo lacks would else show when its stage begins.
  void servos_press(const SceneDescription& scene, std::size_t stage) {
    for (const auto& [name, wall] : scene.walls) {
      const MotionDescription& motion = wall.motion;
      if (!motion.servo || !motion.servo->pressure) continue;
      const Vec3 normal = turned_.contains(name) ? Vec3(Vec3::Ones()) : wall.geometry->normal();
      const std::string& axis = motion.servo->axis;
      const std::string why = presses_on_specimen(motion) && !specimen_ends_across(scene, axis)
                                  ? lacks_cross_section(axis)
                                  : presses_with_nothing(motion, *wall.geometry, normal);
      if (why.empty() || !faceless_.insert(name).second) continue;
      const std::string at = "/walls/" + pointer_token(name);
      std::vector<std::string> causes{at + "/motion/servo"};
      for (const auto& [key, value] : now_.json().at(Description::json_pointer(at)).items())
        if (key != "motion") causes.push_back(at + '/' + pointer_token(key));
      problems_.push_back(written_.problem(written_last(written_, causes, stage + 1), why));
    }
  }

  /// Appends the increments of a ramp. False if there was a problem.
  bool ramp(const RampDescription& ramp, const std::string& at, const SceneDescription& before,
            std::vector<std::shared_ptr<const SceneDescription>>& increments) {
    write_out_lists(now_, resolved(before), ramp.pointer);
    const auto from = number_at(ramp, at + "/from", ramp.from), to = number_at(ramp, at + "/to", ramp.to);
    if (!from || !to) return false;
    for (std::int64_t k = 1; k <= ramp.increments; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(ramp.increments);
      // Exact at the end, where (to − from) + from may not be.
      now_.set(ramp.pointer, k == ramp.increments ? *to : *from + (*to - *from) * share, written_.origin(at + "/to"));
      increments.push_back(read_whole(now_, registry_, problems_));
      if (!increments.back()) return false;
    }
    return true;
  }

  /// The SI value that `value` has where the ramp's pointer points: found by reading it there.
  std::optional<double> number_at(const RampDescription& ramp, const std::string& at, const Description& value) {
    const auto refuse = [&](const std::string& key, const std::string& message) -> std::optional<double> {
      problems_.push_back(written_.problem(key, message));
      return std::nullopt;
    };
    const std::string pointer_key = at.substr(0, at.rfind('/')) + "/pointer";
    Document trial = now_;
    if (const auto problem = trial.set(ramp.pointer, value, written_.origin(at)); !problem.empty())
      return refuse(pointer_key, problem);
    const auto scene = read_whole(trial, registry_, problems_);
    if (!scene) return std::nullopt;
    const Description all = resolved(*scene);
    const Description::json_pointer place(ramp.pointer);
    if (!all.contains(place) || !all.at(place).is_number())
      return refuse(pointer_key, "found \"" + ramp.pointer + "\"; allowed is the pointer of a number");
    return all.at(place).get<double>();
  }

  const Document& written_;
  Document now_;
  const Registry& registry_;
  std::vector<Problem>& problems_;
  std::set<std::string> refused_, faceless_;  ///< names of walls, each of which is told once
  std::set<std::string> turned_;              ///< names of walls that may face elsewhere by then
};

/// What a scenario says cannot be had: of the parameter that it names first, with a colon, or of all of it.
Problem of_scenario(const Document& document, const std::string& name, const std::string& text) {
  const std::size_t colon = text.find(": ");
  if (text.starts_with("/scenario/") && colon != std::string::npos)
    return document.problem(text.substr(0, colon), text.substr(colon + 2));
  return document.problem("/scenario", name + ": " + text);
}

/// The plain description behind a scenario, the document's other keys merged onto it.
Document expanded(const Document& document, const Registry& registry) {
  Component<Scenario> scenario(registry);
  Parameters parameters;
  parameters.choose(scenario);
  std::vector<Problem> problems;
  if (!read(document, "/scenario", parameters, problems)) throw DescriptionError(std::move(problems));
  const std::string name = "scenario \"" + scenario.type() + '"';
  Document plain;
  try {
    plain = Document(scenario->expand(), "expansion of " + name + " in " + document.origin("/scenario").source->name);
  } catch (const PluginError&) {
    throw;
  } catch (const Error& error) {
    throw DescriptionError({of_scenario(document, name, error.what())});
  } catch (const std::exception& error) {
    throw PluginError(name + " failed to expand: " + error.what());
  }
  Document others = document;
  others.erase("/scenario");
  others.extend(std::move(plain));
  return others;
}

}  // namespace

std::string scenario_type(const Document& document) {
  const auto scenario = document.json().find("scenario");
  if (scenario == document.json().end() || !scenario->is_object()) return "";
  const auto type = scenario->find("type");
  return type != scenario->end() && type->is_string() ? type->get<std::string>() : "";
}

Document load_document(const std::filesystem::path& path, const std::vector<std::string>& sets,
                       const Registry& registry) {
  Document document = Document::load(path);
  if (document.json().contains("scene") && document.json().contains("settings"))
    throw DescriptionError({document.problem(
        "/scene", "found a study, of which this is the scene; allowed is a description. 'grit chart " + path.string() +
                      "' runs a study, with --dry it says what would be run")});
  for (const auto& assignment : sets) document.set(assignment);
  return document.json().contains("scenario") ? expanded(document, registry) : document;
}

Scene load_scene(const std::filesystem::path& path, const std::vector<std::string>& sets, const Registry& registry) {
  return read_scene(load_document(path, sets, registry), registry);
}

Scene read_scene(Document document, const Registry& registry) {
  Scene scene;
  std::vector<Problem> problems;
  scene.description = read_whole(document, registry, problems);
  if (const auto stages = document.json().find("stages"); stages != document.json().end() && stages->is_array()) {
    Planner planner(document, registry, problems);
    for (std::size_t i = 0; i < stages->size(); ++i) scene.stages.push_back(planner.stage(i));
  }
  if (!problems.empty()) throw DescriptionError(std::move(problems));
  scene.document = std::move(document);
  return scene;
}

Description resolved(const SceneDescription& scene) {
  // Declaring binds to members without changing them, and writing only reads.
  Parameters parameters;
  const_cast<SceneDescription&>(scene).declare(parameters);
  return write(parameters);
}

}  // namespace grit
