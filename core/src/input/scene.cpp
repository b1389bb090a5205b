#include "input/scene.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "format/names.hpp"
#include "grit/toolkit/did_you_mean.hpp"
#include "input/file_kind.hpp"
#include "input/reader.hpp"
#include "plugins/component.hpp"
#include "plugins/parameter_values.hpp"

namespace grit {
namespace {

/// Adds new problems only: a fault in a part that several stages change is found for each of them.
void add_new(std::vector<Problem>& problems, const std::vector<Problem>& found) {
  const auto same = [](const Problem& a, const Problem& b) {
    return std::tie(a.file, a.line, a.pointer, a.message) == std::tie(b.file, b.line, b.pointer, b.message);
  };
  for (const Problem& problem : found)
    if (std::ranges::none_of(problems, [&](const Problem& known) { return same(known, problem); }))
      problems.push_back(problem);
}

/// A part that a stage can change: an entry of a section, or a section without named entries.
struct Unit {
  std::string section, name;
  std::string pointer() const { return '/' + section + (name.empty() ? "" : '/' + pointer_token(name)); }
};

/// Writes default lists above `pointer` into the document, so that a pointer to one of their entries finds them.
void write_out_lists(Document& document, const Description& resolved, const std::string& pointer) {
  for (auto slash = pointer.find('/', 1); slash != std::string::npos; slash = pointer.find('/', slash + 1)) {
    const std::string parent = pointer.substr(0, slash);
    const Description::json_pointer at(parent);
    if (document.json().contains(at) || !resolved.contains(at) || !resolved.at(at).is_array()) continue;
    document.set(parent, resolved.at(at), document.origin(parent));
  }
}

/// The changes of the stages, in order. Only parts that a change or a ramp modifies are read again, so that the cost of
/// a stage does not depend on the number of stages.
class Planner {
 public:
  /// `described` was read from the document, without problems if `is_clean`.
  Planner(const Document& document, const SceneDescription& described, bool is_clean, std::vector<Problem>& problems)
      : written_(document),
        merged_(document),
        described_(described),
        now_(described),
        is_clean_(is_clean),
        problems_(problems) {
    merged_.erase("/stages");
    if (!described.contacts.type().empty()) law_ = described.contacts.make();
  }

  StagePlan stage(std::size_t number) {
    StagePlan plan;
    const std::string at = "/stages/" + std::to_string(number);
    const Description& stage = written_.json().at("stages")[number];
    if (const auto change = stage.find("change"); change != stage.end() && change->is_object()) {
      merged_.merge(written_, at + "/change");
      if (change->contains("walls")) same_walls(at + "/change/walls");
      read_changed(*change, plan.change);
      use(plan.change);
    }
    if (!is_clean_) return plan;
    const auto& ramps = described_.stages.at(number).ramps;
    for (std::size_t i = 0; i < ramps.size(); ++i)
      if (auto ramp = plan_of(ramps[i], at + "/ramps/" + std::to_string(i))) plan.ramps.push_back(*std::move(ramp));
    return plan;
  }

 private:
  /// The set of walls is fixed: probes and the history of wall contacts refer to the walls at the start of the run.
  void same_walls(const std::string& changed) {
    if (merged_.json().contains("walls") && !merged_.json().at("walls").is_object())
      return;  // reported when it is read
    const Description none = Description::object();
    const auto walls = [&](const Document& document) -> const Description& {
      const auto found = document.json().find("walls");
      return found != document.json().end() && found->is_object() ? *found : none;
    };
    const auto refuse_of = [&](const Document& these, const Document& others, const auto& message) {
      for (const auto& [name, wall] : walls(these).items()) {
        if (walls(others).contains(name) || !refused_.insert(name).second) continue;
        const std::string at = changed + '/' + pointer_token(name);
        const bool is_written = written_.json().contains(Description::json_pointer(at));
        problems_.push_back(written_.problem(is_written ? at : changed, message(name)));
      }
    };
    refuse_of(merged_, written_, [&](const std::string& name) {
      std::vector<std::string> known;
      for (const auto& [wall, _] : walls(written_).items()) known.push_back(wall);
      return "found a wall that does not exist at the start of the run" +
             did_you_mean(name, known,
                          "allowed are the walls of /walls: " + listed(known) +
                              ". Define it there, away from the bodies, and let the stage change its position");
    });
    refuse_of(written_, merged_, [](const std::string&) {
      return "found null, which would remove a wall; allowed are new values. Change its position to one away from the "
             "bodies";
    });
  }

  void read_changed(const Description& patch, SettingsChange& change) {
    for (const auto& [section, part] : patch.items()) {
      const auto& all = SceneDescription::changeable();
      if (std::ranges::find(all, section) == all.end()) continue;  // refused when the stage was read
      const bool removes =
          !part.is_object() || std::any_of(part.begin(), part.end(), [](const auto& one) { return one.is_null(); });
      if (!SceneDescription::has_names(section)) read_unit({section, ""}, change);
      else if (removes) read_section(section, change);
      else
        for (const auto& [name, one] : part.items())
          if (section != "walls" || !refused_.contains(name)) read_unit({section, name}, change);
    }
  }

  void read_unit(const Unit& unit, SettingsChange& change) {
    SceneDescription fresh(described_.registry());
    if (read_unit(merged_, unit, fresh)) change.add(fresh, unit.section, unit.name);
    else faulty_.insert(unit.pointer());
  }

  /// Reads a unit of a document into a description that does not contain it. False if it has problems.
  bool read_unit(const Document& document, const Unit& unit, SceneDescription& fresh) {
    if (law_) law_->clear_materials();  // defaults, not what was read before
    Parameters parameters;
    fresh.declare_unit(unit.section, unit.name, law_.get(), parameters);
    std::vector<Problem> found;
    if (!unit.name.empty()) read_entry(document, unit.section, unit.name, parameters, found);
    else if (document.json().contains(unit.section)) read(document, unit.pointer(), parameters, found);
    add_new(problems_, found);
    return found.empty();
  }

  /// Reads a section from which entries were removed.
  void read_section(const std::string& section, SettingsChange& change) {
    SceneDescription fresh(described_.registry());
    fresh.contacts = described_.contacts;
    Parameters parameters;
    fresh.declare_section(section, parameters);
    parameters.leave_open();
    std::vector<Problem> found;
    read(merged_, "", parameters, found);
    if (!found.empty()) faulty_.insert('/' + section);
    add_new(problems_, found);
    if (!found.empty()) return;
    for (const SceneDescription* scene : {&std::as_const(now_), &std::as_const(fresh)})
      for (const std::string& name : scene->units_of(section))
        if (scene == &fresh || !fresh.has_unit(section, name)) change.add(fresh, section, name);
  }

  /// Applies new values, and checks that they are consistent with the others if all are known.
  void use(const SettingsChange& change) {
    if (!is_clean_) return;
    change.apply_to(now_);
    if (!faulty_.empty()) return;
    std::vector<Problem> found;
    now_.check_together([&](std::string_view key, std::string_view what, std::string_view allowed) {
      found.push_back(merged_.problem('/' + std::string(key), fault_text(std::string(what), std::string(allowed))));
    });
    add_new(problems_, found);
  }

  /// One end of a ramp.
  struct RampEnd {
    double value = 0;
    bool is_integer = false;
    SettingsChange change;  ///< the unit, with the number at this value
  };

  /// Empty if there was a problem.
  std::optional<RampPlan> plan_of(const RampDescription& ramp, const std::string& at) {
    const auto place = NumberPointer::of(ramp.pointer);
    if (!place) return refuse_pointer(ramp, at), std::nullopt;
    const Unit unit{place->section, place->name};
    if (faulty_.contains(unit.pointer()) || faulty_.contains('/' + unit.section)) return std::nullopt;
    if (!unit.name.empty() && unit.section != "interfaces" && !now_.has_unit(unit.section, unit.name))
      return refuse_unit(unit, at + "/pointer"), std::nullopt;
    Description resolved = Description::object();
    if (now_.has_unit(unit.section, unit.name)) {
      Parameters parameters;
      now_.declare_unit(unit.section, unit.name, nullptr, parameters);
      Description& part = unit.name.empty() ? resolved[unit.section] : resolved[unit.section][unit.name];
      part = write(parameters);
    }
    auto from = end_of(ramp, *place, unit, resolved, at, "/from", ramp.from);
    auto to = end_of(ramp, *place, unit, resolved, at, "/to", ramp.to);
    if (!from || !to) return std::nullopt;
    RampPlan plan{.pointer = ramp.pointer,
                  .begin = std::move(from->change),
                  .from = from->value,
                  .to = to->value,
                  .duration = ramp.duration,
                  .increments = ramp.increments};
    if (from->is_integer && !is_whole(plan, at)) return std::nullopt;
    use(plan.begin);
    use(to->change);
    write_out_lists(merged_, resolved, ramp.pointer);
    merged_.set(ramp.pointer, to->value, written_.origin(at + "/to"));
    return plan;
  }

  /// A number as in the description, read at the ramp's pointer.
  std::optional<RampEnd> end_of(const RampDescription& ramp, const NumberPointer& place, const Unit& unit,
                                const Description& resolved, const std::string& at, const std::string& key,
                                const Description& value) {
    Document trial = merged_.excerpt(unit.pointer());
    write_out_lists(trial, resolved, ramp.pointer);
    if (const auto problem = trial.set(ramp.pointer, value, written_.origin(at + key)); !problem.empty()) {
      add_new(problems_, {written_.problem(at + "/pointer", problem)});
      return std::nullopt;
    }
    SceneDescription fresh(described_.registry());
    if (!read_unit(trial, unit, fresh)) return std::nullopt;
    RampEnd end;
    end.change.add(fresh, unit.section, unit.name);
    Parameters parameters;
    fresh.declare_unit(unit.section, unit.name, nullptr, parameters);
    const auto number = find_number(parameters, place.keys);
    if (!number) return refuse_pointer(ramp, at), std::nullopt;
    end.value = number->get(), end.is_integer = number->is_integer();
    return end;
  }

  void refuse_unit(const Unit& unit, const std::string& at) {
    const auto known = now_.units_of(unit.section);
    add_new(problems_,
            {written_.problem(at, fault_text("\"" + unit.name + "\", which is not defined in /" + unit.section +
                                                 did_you_mean(unit.name, known),
                                             known.empty() ? "none, as there are none" : "one of " + listed(known)))});
  }

  void refuse_pointer(const RampDescription& ramp, const std::string& at) {
    add_new(problems_,
            {written_.problem(at + "/pointer", "found \"" + ramp.pointer + "\"; allowed is the pointer of a number")});
  }

  /// Whether all increments of a ramp of an integer are integers.
  bool is_whole(const RampPlan& plan, const std::string& at) {
    for (std::int64_t k = 1; k <= plan.increments; ++k) {
      const double value = plan.value(k);
      if (value == std::floor(value)) continue;
      add_new(problems_,
              {written_.problem(at + "/to", "found the number " + Description(value).dump() + " in increment " +
                                                std::to_string(k) + "; allowed is an integer")});
      return false;
    }
    return true;
  }

  const Document& written_;
  Document merged_;                    // with the changes of the stages so far, without the key stages
  const SceneDescription& described_;  // before any stage
  SceneDescription now_;               // with the changes of the stages so far
  std::shared_ptr<ContactLaw> law_;    // to read parameters of materials; null if unknown
  const bool is_clean_;                // whether described_ is; if not, only written values are read
  std::set<std::string> faulty_;       // units and sections with problems
  std::vector<Problem>& problems_;
  std::set<std::string> refused_;  // names of walls that were reported
};

/// The outermost list that contains an existing value: a change replaces lists as a whole.
std::optional<Description::json_pointer> list_around(const Description& all, const Description::json_pointer& value) {
  std::optional<Description::json_pointer> list;
  if (!all.contains(value)) return list;
  for (auto around = value; !around.empty();) {
    around.pop_back();
    if (all.at(around).is_array()) list = around;
  }
  return list;
}

/// The plain description of a scenario, with the other keys of the document merged onto it.
Document expanded(const Document& document, const Registry& registry) {
  Component<Scenario> scenario(registry);
  Parameters parameters;
  parameters.choose(scenario);
  std::vector<Problem> problems;
  if (!read(document, "/scenario", parameters, problems)) throw DescriptionError(std::move(problems));
  const std::string name = "scenario \"" + scenario.type() + '"';
  Document plain;
  try {
    plain = Document(scenario.make()->expand(),
                     "expansion of " + name + " in " + document.origin("/scenario").source->name);
  } catch (const PluginError&) {
    throw;
  } catch (const ParameterError& error) {
    for (const ParameterError::Fault& fault : error.faults())
      problems.push_back(document.problem(fault.key.empty() ? "/scenario" : "/scenario/" + fault.key, fault.message()));
    throw DescriptionError(std::move(problems));
  } catch (const Error& error) {
    throw DescriptionError({document.problem("/scenario", name + ": " + error.what())});
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
                       const Registry& registry, const std::string& sets_by) {
  Document document = Document::load(path);
  refuse_other_kinds(document, path, FileKind::description);
  return expanded_document(std::move(document), sets, registry, sets_by);
}

Document expanded_document(Document document, const std::vector<std::string>& sets, const Registry& registry,
                           const std::string& sets_by) {
  for (const auto& assignment : sets) document.set(assignment, sets_by);
  return document.json().contains("scenario") ? expanded(document, registry) : document;
}

Scene load_scene(const std::filesystem::path& path, const std::vector<std::string>& sets, const Registry& registry) {
  return read_scene(load_document(path, sets, registry), registry);
}

Scene read_scene(Document document, const Registry& registry) {
  Scene scene;
  std::vector<Problem> problems;
  auto described = std::make_shared<SceneDescription>(registry);
  Parameters parameters;
  described->declare(parameters);
  const bool is_clean = read(document, "", parameters, problems);
  if (const auto stages = document.json().find("stages"); stages != document.json().end() && stages->is_array()) {
    Planner planner(document, *described, is_clean, problems);
    for (std::size_t i = 0; i < stages->size(); ++i) scene.stages.push_back(planner.stage(i));
  }
  if (!problems.empty()) throw DescriptionError(std::move(problems));
  scene.description = std::move(described);
  scene.document = std::move(document);
  return scene;
}

SettingsChange change_of(const SceneDescription& now, const std::string& pointer, const Description& value) {
  // Read as the change of a stage of the present values, without the sections that a stage cannot change.
  Description all = resolved(now);
  for (const char* section : {"probes", "output", "title"}) all.erase(section);
  for (auto& [name, group] : all.at("bodies").items()) group.erase("stage");
  Description patch = Description::object();
  try {
    const Description::json_pointer at(pointer);
    if (value.is_object() && value.empty() && all.contains(at))
      throw DescriptionError({{"set", 0, pointer,
                               "found an empty object, which changes nothing; allowed is one with the values to "
                               "change, or null for the default"}});
    patch[at] = value;
    if (const auto list = list_around(all, at)) {
      Description changed = all;
      changed[at] = value;
      patch = Description::object(), patch[*list] = changed.at(*list);
    }
  } catch (const Description::exception&) {
    throw DescriptionError({{"set", 0, pointer, "found \"" + pointer + "\"; allowed is a JSON pointer"}});
  }
  all["stages"] = {
      {{"name", "set"}, {"until", {{"type", "steps"}, {"value", 1}}}, {"limit", 1}, {"change", std::move(patch)}}};
  try {
    Scene scene = read_scene(Document(std::move(all), "set"), now.registry());
    return std::move(scene.stages.front().change);
  } catch (const DescriptionError& error) {
    constexpr std::string_view inside = "/stages/0/change";
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems)
      if (problem.pointer.starts_with(inside)) problem.pointer.erase(0, inside.size());
    throw DescriptionError(std::move(problems));
  }
}

Description resolved(const SceneDescription& scene) {
  // Declaring binds to members without changing them; writing only reads.
  Parameters parameters;
  const_cast<SceneDescription&>(scene).declare(parameters);
  return write(parameters);
}

}  // namespace grit
