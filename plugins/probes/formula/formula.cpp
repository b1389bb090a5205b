// Curves through muParser. See README.md.
#include "formula.hpp"

#include <muParser.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <deque>
#include <functional>
#include <string_view>
#include <tuple>

#include "grit/plugin.hpp"
#include "grit/toolkit/formula_text.hpp"
#include "grit/toolkit/grain_masses.hpp"
#include "grit/toolkit/specimen.hpp"
#include "grit/toolkit/wall_names.hpp"

namespace grit {

namespace {

struct WallVector {
  const char* suffix;
  Vec3 WallView::*member;
};
constexpr WallVector wall_vectors[] = {{"_force", &WallView::force},
                                       {"_travel", &WallView::position},
                                       {"_stage_travel", &WallView::stage_position},
                                       {"_velocity", &WallView::velocity}};

struct WallScalar {
  const char* suffix;
  double WallView::*member;
};
constexpr WallScalar wall_scalars[] = {{"_pressure", &WallView::pressure}, {"_area", &WallView::area}};

/// Something that a formula may name.
struct Variable {
  std::string name;
  std::function<double(const World&)> read;
  bool used = false;
  double value = 0;
};

/// Lengths, strains and stresses of a periodic cell.
template <class Add>
void add_cell(const Add& add) {
  for (int k = 0; k < 3; ++k) {
    const char axis = "xyz"[k];
    add(std::string("cell_length_") + axis, [k](const World& w) { return w.cell().high[k] - w.cell().low[k]; });
    add(std::string("cell_stage_length_") + axis, [k](const World& w) { return w.cell().stage_lengths[k]; });
    add(std::string("cell_shear_strain_") + std::array{"xy", "xz", "yz"}[static_cast<std::size_t>(k)],
        [k](const World& w) { return w.cell().stage_shear_strain[k]; });
  }
  for (const auto& [name, row, column] : {std::tuple("xx", 0, 0), std::tuple("yy", 1, 1), std::tuple("zz", 2, 2),
                                          std::tuple("xy", 0, 1), std::tuple("xz", 0, 2), std::tuple("yz", 1, 2)})
    add(std::string("stress_") + name, [row = row, column = column](const World& w) {
      return mean_stress(w, {w.cell().low, w.cell().high})(row, column);
    });
}

std::deque<Variable> variables_of(const World& world) {
  std::deque<Variable> variables;
  const auto add = [&](std::string name, std::function<double(const World&)> read) {
    const auto same = [&](const Variable& other) { return other.name == name; };
    if (std::any_of(variables.begin(), variables.end(), same))
      throw ParameterError({{"", "two walls that both define the variable \"" + name + '"',
                             "a variable of one wall; rename one of the walls " + listed(wall_names(world))}});
    variables.push_back({std::move(name), std::move(read)});
  };
  add("time", [](const World& w) { return w.time(); });
  add("step", [](const World& w) { return static_cast<double>(w.step()); });
  add("mean_diameter", [](const World& w) { return w.mean_diameter(); });
  add("void_ratio", [](const World& w) { return void_ratio(w, interior_box(w)); });
  add("mass", mass_of);
  add("departed_mass", departed_mass_of);
  for (int k = 0; k < 3; ++k)
    add(std::string("centre_") + "xyz"[k],
        [k](const World& w) { return over_masses(w, [k](const Vec3& centre) { return centre[k]; }) / mass_of(w); });
  for (int k = 0; k < 3; ++k)
    add(std::string("spread_") + "xyz"[k], [k](const World& w) {
      const double mass = mass_of(w), mean = over_masses(w, [k](const Vec3&centre) { return centre[k]; }) / mass;
      return std::sqrt(over_masses(w, [=](const Vec3& centre) { return std::pow(centre[k] - mean, 2); }) / mass);
    });
  if (world.cell().periodic_everywhere()) add_cell(add);
  for (std::size_t i = 0; i < world.walls().size(); ++i) {
    const std::string stem = wall_stem(world.walls()[i].name);
    for (const auto& [suffix, member] : wall_vectors)
      for (int k = 0; k < 3; ++k)
        add(stem + suffix + '_' + "xyz"[k],
            [i, k, member = member](const World& w) { return (w.walls()[i].*member)[k]; });
    for (const auto& [suffix, member] : wall_scalars)
      add(stem + suffix, [i, member = member](const World& w) { return w.walls()[i].*member; });
  }
  return variables;
}

/// What a formula may name, without repeating the same for each wall.
std::string known_names(const World& world, const std::map<std::string, FormulaProbe::Constant>& constants) {
  std::string known = "time, step, mean_diameter, void_ratio, mass, departed_mass, centre_x/_y/_z, spread_x/_y/_z";
  for (const auto& constant : constants) known += ", " + constant.first;
  if (world.cell().periodic_everywhere())
    known +=
        "; of the periodic cell: cell_length_x/_y/_z, cell_stage_length_x/_y/_z, cell_shear_strain_xy/_xz/_yz, "
        "stress_xx/_yy/_zz/_xy/_xz/_yz";
  if (world.walls().empty()) return known;
  std::vector<std::string> stems;
  for (const auto& name : wall_names(world)) stems.push_back(wall_stem(name));
  known += "; of each wall (" + listed(stems) + "): ";
  for (const auto& vector : wall_vectors) known += std::string("<wall>") + vector.suffix + "_x/_y/_z, ";
  return known + "<wall>_pressure, <wall>_area";
}

/// muParser's message without its count of characters, which begins at 0.
std::string plain_message(const mu::ParserError& error) {
  std::string message = error.GetMsg();
  for (const std::string_view phrase :
       {" found at expression position ", " found at position ", " at expression position ", " at position "}) {
    const std::size_t begin = message.find(phrase);
    if (begin == std::string::npos) continue;
    const std::size_t end = message.find_first_not_of("-0123456789", begin + phrase.size());
    message.erase(begin, end == std::string::npos ? end : end - begin);
  }
  while (!message.empty() && (message.back() == '.' || message.back() == ' ')) message.pop_back();
  if (!message.empty()) message.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(message.front())));
  return message;
}

}  // namespace

struct FormulaProbe::Evaluation {
  std::deque<Variable> variables;
  std::deque<mu::Parser> parsers;  ///< in the order of the curves
};

FormulaProbe::FormulaProbe() = default;
FormulaProbe::~FormulaProbe() = default;

void FormulaProbe::Curve::declare(Parameters& parameters) {
  parameters.add("formula", formula)
      .required()
      .doc("expression in the syntax of muParser, in SI units; names: see the README");
  parameters.add("unit", unit)
      .doc(
          "unit in which the formula gives its result, UDUNITS spelling; it is only written beside the numbers: "
          "\"kPa\" needs a formula "
          "that divides by 1000. \"1\" is dimensionless");
  parameters.add("doc", doc).doc("one line that describes the curve, with its sign convention; default: the formula");
}

void FormulaProbe::Constant::declare(Parameters& parameters) {
  parameters.add("value", value).required().doc("value in SI units");
  parameters.add("doc", doc).doc("meaning and unit");
}

void FormulaProbe::declare(Parameters& parameters) {
  parameters.add("curves", curves).required().doc("curves by name (snake_case); each becomes a channel");
  parameters.add("constants", constants).doc("constants for use in formulas");
  parameters.check([this](const Complain& complain) {
    if (curves.empty()) complain("curves", "no curve", "at least one");
    for (const auto& curve : curves)
      if (!is_snake_case(curve.first))
        complain("curves", "the name \"" + curve.first + "\"",
                 "lower-case letters, digits and _, starting with a letter");
      else if (curve.first == "time" || curve.first == "step")
        complain("curves", "the name \"" + curve.first + "\"", "another name: every probe has a series of this one");
    for (const auto& constant : constants)
      if (!is_formula_name(constant.first))
        complain("constants", "the name \"" + constant.first + "\"",
                 "letters, digits and _, not starting with a digit");
  });
}

void FormulaProbe::prepare(const World& world) {
  auto evaluation = std::make_unique<Evaluation>();
  auto& variables = evaluation->variables = variables_of(world);
  std::vector<std::string> names;
  for (const auto& variable : variables) names.push_back(variable.name);
  for (const auto& constant : constants) {
    if (std::find(names.begin(), names.end(), constant.first) != names.end())
      throw ParameterError(
          {{"constants/" + constant.first, "the name of a variable", "a name that is not a variable"}});
    names.push_back(constant.first);
  }

  for (const auto& [name, curve] : curves) {
    const auto fail = [&, &name = name, &curve = curve](std::size_t position, const std::string& why,
                                                        const std::string& allowed, const std::string& meant = "") {
      throw ParameterError(
          {{"curves/" + name + "/formula",
            '"' + curve.formula + "\": " + why + " at character " + std::to_string(position + 1) + meant, allowed}});
    };
    if (const auto at = assignment_in(curve.formula); at != std::string::npos) fail(at, "\"=\"", no_assignment);
    auto& parser = evaluation->parsers.emplace_back();
    try {
      for (auto& variable : variables) parser.DefineVar(variable.name, &variable.value);
      for (const auto& constant : constants) parser.DefineConst(constant.first, constant.second.value);
      parser.SetExpr(curve.formula);
      parser.Eval();
      for (const auto& used : parser.GetUsedVar())
        for (auto& variable : variables) variable.used |= variable.name == used.first;
    } catch (const mu::ParserError& error) {
      // muParser reads one blank past the end.
      const auto position = std::min(static_cast<std::size_t>(std::max(error.GetPos(), 0)), curve.formula.size());
      if (error.GetCode() == mu::ecUNASSIGNABLE_TOKEN && is_formula_name(error.GetToken()))
        fail(position, "the unknown name \"" + error.GetToken() + '"',
             "one of the names " + known_names(world, constants), did_you_mean(error.GetToken(), names));
      fail(position, plain_message(error), "an expression in muParser's syntax");
    }
    if (parser.GetNumResults() != 1) fail(curve.formula.rfind(','), "\",\"", "an expression with one result");
  }
  evaluation_ = std::move(evaluation);
}

std::vector<Channel> FormulaProbe::channels() const {
  std::vector<Channel> channels;
  for (const auto& [name, curve] : curves)
    channels.push_back({name, curve.unit, curve.doc.empty() ? curve.formula : curve.doc, {}});
  return channels;
}

void FormulaProbe::sample(const World& world, ChannelValues& values) {
  for (auto& variable : evaluation_->variables)
    if (variable.used) variable.value = variable.read(world);
  auto parser = evaluation_->parsers.begin();
  for (const auto& curve : curves) values[curve.first] = (parser++)->Eval();
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{
      .kind = "probe",
      .name = "formula",
      .version = "1.0.0",
      .doc = "curves given as formulas of wall forces, displacements, void ratio and time",
      .make_probe = []() -> grit::Probe* { return new grit::FormulaProbe; }};
  return &info;
}
