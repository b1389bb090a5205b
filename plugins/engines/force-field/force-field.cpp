// Formulas through muParser. See README.md.
#include "force-field.hpp"

#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <deque>

#include "grit/plugin.hpp"
#include "grit/toolkit/formula_text.hpp"

namespace grit {
namespace {

constexpr const char* names = "x, y, z, vx, vy, vz, radius, mass, time, and those of constants";
const std::vector<std::string> variables{"x", "y", "z", "vx", "vy", "vz", "radius", "mass", "time"};

/// A sphere or clump: what a formula may name.
struct Grain {
  Vec3 position, velocity;
  double radius, mass;
};

/// Calls use(Grain, indices of its bodies) for each single sphere and each clump.
template <class Use>
void each_grain(const World& world, Use use) {
  const auto positions = world.positions(), velocities = world.velocities();
  const auto clump_of = world.clump_of();
  const auto clumps = world.clumps();
  std::vector<std::vector<std::size_t>> spheres(clumps.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!clump_of.empty() && clump_of[i] != no_clump) {
      spheres[clump_of[i]].push_back(i);
      continue;
    }
    const std::size_t alone[] = {i};
    use(Grain{xyz(positions[i]), xyz(velocities[i]), positions[i].w, 1 / velocities[i].w},
        std::span<const std::size_t>(alone));
  }
  for (std::size_t c = 0; c < clumps.size(); ++c)
    use(Grain{clumps[c].centre, clumps[c].velocity, clumps[c].radius, clumps[c].mass},
        std::span<const std::size_t>(spheres[c]));
}

}  // namespace

struct ForceField::Evaluation {
  Evaluation(const std::array<std::string, 3>& of, const std::map<std::string, Constant>& constants) : formulas(of) {
    for (const auto& [name, constant] : constants) values[name] = constant.value;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        parsers[k].DefineVar(std::string(1, "xyz"[axis]), &grain.position[static_cast<Eigen::Index>(axis)]);
        parsers[k].DefineVar(std::string("v") + "xyz"[axis], &grain.velocity[static_cast<Eigen::Index>(axis)]);
      }
      parsers[k].DefineVar("radius", &grain.radius), parsers[k].DefineVar("mass", &grain.mass);
      parsers[k].DefineVar("time", &time);
      for (auto& [name, value] : values) parsers[k].DefineVar(name, &value);
      parsers[k].SetExpr(of[k]);
    }
  }
  Evaluation(const Evaluation&) = delete;

  Vec3 at(const Grain& where) {
    grain = where;
    return {parsers[0].Eval(), parsers[1].Eval(), parsers[2].Eval()};
  }
  /// Largest change of a force over that of a component of `member`, by central differences over `step`.
  double slope(const Grain& where, Vec3 Grain::*member, double step) {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      Grain more = where, less = where;
      (more.*member)[k] += step, (less.*member)[k] -= step;
      sum += ((at(more) - at(less)) / (2 * step)).squaredNorm();
    }
    return std::sqrt(sum);
  }

  std::array<std::string, 3> formulas;
  std::map<std::string, double> values;
  Grain grain{Vec3::Zero(), Vec3::Zero(), 0, 0};
  double time = 0;
  std::array<mu::Parser, 3> parsers;
};

ForceField::ForceField() = default;
ForceField::~ForceField() = default;

void ForceField::Constant::declare(Parameters& p) {
  p.add("value", value).required().doc("value in SI units");
  p.add("doc", doc).doc("meaning and unit");
}

void ForceField::declare(Parameters& p) {
  for (std::size_t k = 0; k < 3; ++k)
    p.add(std::string(1, "xyz"[k]), formulas[k])
        .doc("component as an expression in the syntax of muParser, in SI units; names: " + std::string(names));
  p.add("per", per).one_of({"mass", "body"}).doc("mass: the components are accelerations [m/s^2]; body: forces [N]");
  p.add("constants", constants).doc("constants for use in formulas; ramps may change them");
  p.check([this](const Complain& complain) {
    bool named = true;
    for (const auto& [name, _] : constants) {
      const std::string key = "constants/" + name;
      if (!is_formula_name(name))
        complain(key, "the name \"" + name + '"', "letters, digits and _, not starting with a digit"), named = false;
      else if (std::ranges::find(variables, name) != variables.end())
        complain(key, "the name of a variable", "a name that is not a variable"), named = false;
    }
    if (!named) return;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string key(1, "xyz"[k]);
      if (const auto at = assignment_in(formulas[k]); at != std::string::npos) {
        complain(key, '"' + formulas[k] + "\": \"=\" at character " + std::to_string(at + 1), no_assignment);
        continue;
      }
      try {
        std::array<std::string, 3> alone{"0", "0", "0"};
        alone[k] = formulas[k];
        Evaluation one(alone, constants);
        one.parsers[k].Eval();
        if (one.parsers[k].GetNumResults() != 1)
          complain(key, '"' + formulas[k] + '"', "an expression with one result");
      } catch (const mu::ParserError& error) {
        const bool unknown = error.GetCode() == mu::ecUNASSIGNABLE_TOKEN;
        complain(
            key,
            '"' + formulas[k] + "\": " + (unknown ? "the unknown name \"" + error.GetToken() + '"' : error.GetMsg()),
            unknown ? "one of the names " + std::string(names) : "an expression in muParser's syntax");
      }
    }
  });
}

ForceField::Evaluation& ForceField::evaluation() const {
  const auto same_names = [this] {
    return std::ranges::equal(
        evaluation_->values, constants, {}, [](const auto& one) { return one.first; },
        [](const auto& one) { return one.first; });
  };
  if (!evaluation_ || evaluation_->formulas != formulas || !same_names())
    evaluation_ = std::make_unique<Evaluation>(formulas, constants);
  for (const auto& [name, constant] : constants) evaluation_->values.at(name) = constant.value;
  return *evaluation_;
}

void ForceField::forces(const World& world, std::span<Row> force, std::span<Row> moment) const {
  Evaluation& formula = evaluation();
  formula.time = world.time();
  const auto arms = world.arms();
  each_grain(world, [&](const Grain& grain, std::span<const std::size_t> bodies) {
    const Vec3 all = (per == "mass" ? grain.mass : 1) * formula.at(grain), f = all / static_cast<double>(bodies.size());
    Vec3 turning = Vec3::Zero();  // of the forces on the spheres of a clump about its centre
    for (const std::size_t i : bodies) {
      force[i] += Row{f.x(), f.y(), f.z(), 0};
      if (bodies.size() > 1) turning += arms[i].cross(f);
    }
    moment[bodies.front()] += Row{-turning.x(), -turning.y(), -turning.z(), 0};
  });
}

EngineRates ForceField::rates(const World& world) const {
  Evaluation& formula = evaluation();
  formula.time = world.time();
  EngineRates rates;
  each_grain(world, [&](const Grain& grain, std::span<const std::size_t>) {
    const double over_mass = per == "mass" ? 1 : 1 / grain.mass;
    constexpr double small = 1e-3, slow = 1e-3;  // of the radius; of the speed, or radii per second if it rests
    const double change = small * grain.radius, faster = slow * std::max(grain.velocity.norm(), grain.radius);
    rates.stiffness = std::max(rates.stiffness, over_mass * formula.slope(grain, &Grain::position, change));
    rates.damping = std::max(rates.damping, over_mass * formula.slope(grain, &Grain::velocity, faster));
  });
  return rates;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "engine",
                                     .name = "force-field",
                                     .version = "1.0.0",
                                     .doc = "a force on each body as formulas of its position, velocity and time",
                                     .make_engine = []() -> grit::Engine* { return new grit::ForceField; }};
  return &info;
}
