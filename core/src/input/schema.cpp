#include "input/schema.hpp"

#include <cmath>
#include <map>
#include <set>

#include "description/description.hpp"
#include "input/reader.hpp"
#include "input/units.hpp"
#include "plugins/parameter_values.hpp"

namespace grit {
namespace {

Description type(const char* name) { return {{"type", name}}; }
Description any_of(Description one, Description other) {
  return {{"anyOf", Description::array({std::move(one), std::move(other)})}};
}
Description reference(const std::string& definition) { return {{"$ref", "#/definitions/" + definition}}; }

/// Schemas of declarations. A *patch* is merged onto a description: nothing in it is required, and null removes.
/// Modifies the declarations: lists get an entry, choices are made.
class Generator {
 public:
  enum class Form { whole, patch };

  Description object(Parameters& parameters, Form form) {
    Choice* const choice = parameters.choice();
    if (choice == nullptr) return plain(properties(parameters, form), parameters, form);
    const std::string name = definition(choice->what(), form);
    if (open_.contains(name)) {
      recursive_.insert(name);
      return reference(name);
    }
    open_.insert(name);
    Description schema = chosen(parameters, *choice, form);
    open_.erase(name);
    if (!recursive_.contains(name)) return schema;
    definitions[name] = std::move(schema);
    return reference(name);
  }

  Description properties(const Parameters& parameters, Form form) {
    auto all = Description::object();
    for (const auto& parameter : parameters.entries()) all[parameter.name()] = property(parameter, form);
    return all;
  }

  /// An object with these properties and, unless it is open, no others.
  static Description plain(Description properties, const Parameters& parameters, Form form) {
    properties["//"] = Description::object();
    Description schema = type("object");
    schema["properties"] = std::move(properties);
    schema["additionalProperties"] = parameters.is_open();
    auto required = Description::array();
    if (form == Form::whole)
      for (const auto& parameter : parameters.entries())
        if (parameter.is_required()) required.push_back(parameter.name());
    if (!required.empty()) schema["required"] = std::move(required);
    return schema;
  }

  Description definitions = Description::object();

 private:
  static std::string definition(const std::string& what, Form form) {
    std::string name = what + (form == Form::patch ? "-patch" : "");
    for (char& c : name)
      if (c == ' ') c = '-';
    return name;
  }

  Description chosen(Parameters& parameters, Choice& choice, Form form) {
    const auto types = choice.types();
    const Description own = properties(parameters, form);
    auto cases = Description::array();
    for (const auto& name : types) {
      const auto twin = choice.twin();
      twin->choose(name);
      Parameters inner;
      twin->declare(inner);
      Description all = {{"type", {{"const", name}}}};
      all.update(own);
      all.update(properties(inner, form));
      Description closed = plain(std::move(all), inner, form);
      if (const std::string doc = choice.type_doc(name); !doc.empty()) closed["description"] = doc;
      for (const auto& parameter : parameters.entries())
        if (form == Form::whole && parameter.is_required()) closed["required"].push_back(parameter.name());
      cases.push_back({{"if", {{"properties", {{"type", {{"const", name}}}}}, {"required", {"type"}}}},
                       {"then", std::move(closed)}});
    }
    Description schema = type("object");
    schema["properties"] = own;
    schema["properties"]["type"] = {{"enum", types}, {"description", choice.what()}};
    if (form == Form::whole) schema["required"] = {"type"};
    if (!cases.empty()) schema["allOf"] = std::move(cases);
    return schema;
  }

  Description property(const Parameter& parameter, Form form) {
    // The default, before the target is modified.
    const auto present = parameter.is_required() ? std::nullopt : write(parameter);
    const bool simple = present && !present->is_object() && !(present->is_array() && present->empty());
    Description schema =
        std::visit([&](const auto& target) { return of(parameter, target, form); }, parameter.target());
    if (form == Form::patch) schema = any_of(std::move(schema), type("null"));
    // Nothing may stand beside $ref in draft-07.
    if (schema.contains("$ref")) schema = {{"allOf", Description::array({std::move(schema)})}};
    const std::string unit = parameter.unit() == "1" ? "" : " [" + parameter.unit() + ']';
    if (const std::string text = parameter.doc() + unit; !text.empty()) schema["description"] = text;
    if (simple) schema["default"] = *present;
    return schema;
  }

  // ---- numbers

  static Description bounded(Description schema, const Parameter& parameter) {
    if (std::isfinite(parameter.low()))
      schema[parameter.low_is_open() ? "exclusiveMinimum" : "minimum"] = parameter.low();
    if (std::isfinite(parameter.high()))
      schema[parameter.high_is_open() ? "exclusiveMaximum" : "maximum"] = parameter.high();
    return schema;
  }
  static Description quantity(const Parameter& parameter) {
    return any_of(bounded(type("number"), parameter),
                  {{"type", "string"}, {"pattern", quantity_pattern(parameter.unit())}, {"maxLength", 100}});
  }
  static Description three(Description entry) {
    return {{"type", "array"}, {"items", std::move(entry)}, {"minItems", 3}, {"maxItems", 3}};
  }
  static Description list(Description entry, const Parameter& parameter) {
    Description schema = {{"type", "array"}, {"items", std::move(entry)}};
    if (parameter.least_entries() > 0) schema["minItems"] = parameter.least_entries();
    return schema;
  }
  static Description text(const Parameter& parameter) {
    if (parameter.choices().empty()) return type("string");
    return {{"enum", parameter.choices()}};
  }

  static Description of(const Parameter& p, const double*, Form) { return quantity(p); }
  static Description of(const Parameter& p, const std::optional<double>*, Form) { return quantity(p); }
  static Description of(const Parameter& p, const std::int64_t*, Form) { return bounded(type("integer"), p); }
  static Description of(const Parameter& p, const Vec3*, Form) { return three(quantity(p)); }
  static Description of(const Parameter& p, const std::optional<Vec3>*, Form) { return three(quantity(p)); }
  static Description of(const Parameter& p, const std::vector<double>*, Form) { return list(quantity(p), p); }
  static Description of(const Parameter&, const bool*, Form) { return type("boolean"); }
  static Description of(const Parameter&, const std::array<bool, 3>*, Form) { return three(type("boolean")); }
  static Description of(const Parameter& p, const std::string*, Form) { return text(p); }
  static Description of(const Parameter& p, const std::vector<std::string>*, Form) { return list(text(p), p); }
  static Description of(const Parameter&, const Description*, Form) { return Description::object(); }

  // ---- objects

  Description of(const Parameter&, const ObjectTarget& target, Form form) {
    Parameters inner;
    target.declare(inner);
    return object(inner, form);
  }
  Description of(const Parameter&, const OptionalTarget& target, Form form) {
    Parameters inner;
    target.create(inner);
    return object(inner, form);
  }
  /// A patch replaces the whole list.
  Description of(const Parameter& parameter, const ListTarget& target, Form) {
    Parameters inner;
    target.append(inner);
    return list(object(inner, Form::whole), parameter);
  }
  Description of(const Parameter& parameter, const MapTarget& target, Form form) {
    Parameters inner;
    target.insert("a+b", inner);  // a name that is valid for interfaces too
    Description entry = object(inner, form);
    if (form == Form::patch) entry = any_of(std::move(entry), type("null"));
    Description schema = type("object");
    schema["propertyNames"] = {{"anyOf", {{{"const", "//"}}, {{"pattern", name_pattern}, {"maxLength", 100}}}}};
    schema["properties"] = {{"//", Description::object()}};
    schema["additionalProperties"] = std::move(entry);
    if (form == Form::whole && parameter.least_entries() > 0) schema["minProperties"] = parameter.least_entries();
    return schema;
  }

  std::set<std::string> open_, recursive_;
};

using Form = Generator::Form;

/// The properties of a scene with the contact law `law`; "" if unknown.
Description scene_properties(Generator& generator, const Registry& registry, const std::string& law, Form form) {
  const auto declared = [&](Form wanted) {
    SceneDescription scene(registry);
    if (!law.empty()) scene.contacts.choose(law);
    Parameters parameters;
    scene.declare(parameters);
    return generator.properties(parameters, wanted);
  };
  Description all = declared(form);

  // A stage may change a part of the scene.
  const Description parts = declared(Form::patch);
  Description change = type("object");
  change["additionalProperties"] = false;
  change["properties"]["//"] = Description::object();
  for (const auto& section : SceneDescription::changeable()) change["properties"][section] = parts.at(section);
  Description& domain = change["properties"]["domain"];
  Description of_domain = {{"//", Description::object()}};
  for (const auto& key : DomainDescription::changeable())
    of_domain[key] = domain.at("anyOf").at(0).at("properties").at(key);
  domain = any_of({{"type", "object"}, {"properties", of_domain}, {"additionalProperties", false}}, type("null"));
  Description& stages = form == Form::patch ? all.at("stages").at("anyOf").at(0) : all.at("stages");
  const std::string name = "change" + (law.empty() ? "" : "-" + law);
  const Description doc = stages.at("items").at("properties").at("change").at("description");
  stages.at("items").at("properties").at("change") = {{"allOf", {reference(name)}}, {"description", doc}};
  generator.definitions[name] = std::move(change);
  return all;
}

/// A scene; properties that depend on the contact law are in conditional cases.
Description scene(Generator& generator, const Registry& registry, Form form) {
  SceneDescription example(registry);
  Parameters declared;
  example.declare(declared);
  Description common = scene_properties(generator, registry, "", form);
  std::map<std::string, Description> by_law;
  for (const auto& law : example.contacts.types()) by_law[law] = scene_properties(generator, registry, law, form);

  auto cases = Description::array();
  for (const auto& [law, all] : by_law) {
    auto own = Description::object();
    for (const auto& [key, value] : all.items())
      if (value != common.at(key)) own[key] = value;
    cases.push_back(
        {{"if",
          {{"properties", {{"contacts", {{"properties", {{"type", {{"const", law}}}}}, {"required", {"type"}}}}}},
           {"required", {"contacts"}}}},
         {"then", {{"properties", own}}}});
  }
  Description schema = Generator::plain(std::move(common), declared, form);
  if (!cases.empty()) schema["allOf"] = std::move(cases);
  return schema;
}

Description scenario(Generator& generator, const Registry& registry, Form form) {
  Component<Scenario> choice(registry);
  Parameters parameters;
  parameters.choose(choice);
  return generator.object(parameters, form);
}

}  // namespace

Description scene_schema(const Registry& registry) {
  Generator generator;
  Description whole = scene(generator, registry, Form::whole), patch = scene(generator, registry, Form::patch);
  patch["properties"]["scenario"] = Description::object();
  patch["properties"]["extends"] = {{"type", "string"},
                                    {"description", "path of the description that this one is merged onto"}};
  const Description complete = scenario(generator, registry, Form::whole),
                    part = scenario(generator, registry, Form::patch);
  generator.definitions["scene"] = std::move(whole);
  generator.definitions["scene-patch"] = std::move(patch);

  const auto with_scenario = [](const Description& schema) {
    return Description{{"allOf", {reference("scene-patch"), {{"properties", {{"scenario", schema}}}}}}};
  };
  const auto has = [](const char* key) { return Description{{"required", {key}}}; };
  return {{"$schema", "http://json-schema.org/draft-07/schema#"},
          {"title", "description of a simulation for grit"},
          {"type", "object"},
          {"if", has("extends")},
          {"then", with_scenario(any_of(part, type("null")))},
          {"else", {{"if", has("scenario")}, {"then", with_scenario(complete)}, {"else", reference("scene")}}},
          {"definitions", std::move(generator.definitions)}};
}

}  // namespace grit
