#include "description/conditions.hpp"

#include <utility>

#include "description/axes.hpp"
#include "description/domain.hpp"

namespace grit {
namespace {

void declare_parts(Parameters& p, std::vector<Condition>& of, const std::string& doc) {
  ListTarget target;
  target.size = [&of] { return of.size(); };
  target.clear = [&of] { of.clear(); };
  target.append = [&of](Parameters& inner) { of.emplace_back().declare(inner); };
  target.declare = [&of](std::size_t i, Parameters& inner) { of[i].declare(inner); };
  p.add_target("of", std::move(target)).required().entries(1).doc(doc);
}

}  // namespace

void TimeCondition::declare(Parameters& p) {
  p.add("value", value).unit("s").symbol("t").above(0).required().doc("simulated time since the stage began");
}
void StepsCondition::declare(Parameters& p) {
  p.add("value", value).at_least(1).required().doc("steps since the stage began");
}
void DisplacementCondition::declare(Parameters& p) {
  p.add("wall", wall).required().doc("name of the wall");
  p.add("axis", axis).one_of(one_axis).doc("axis of the displacement");
  p.add("value", value)
      .unit("m")
      .symbol("u")
      .required()
      .doc("displacement since the stage began, reached in the direction of its sign");
  p.check(
      [this](const Complain& complain) {
        if (value == 0) complain("value", "0 m", "a displacement with a direction");
      },
      {"value"});
}
void UnbalancedForceCondition::declare(Parameters& p) {
  p.add("below", below)
      .above(0)
      .doc(
          "mean net force of a body over the mean contact force; falling grains with few contacts may meet it: "
          "at-rest excludes them");
}
void AtRestCondition::declare(Parameters& p) {
  p.add("below", below)
      .above(0)
      .at_most(0.5)
      .doc(
          "sum of the net forces on bodies over the sum of their weights and all contact forces: 1 for bodies in "
          "flight; contacts must also carry at least half of the weight, or other load");
}
void KineticEnergyCondition::declare(Parameters& p) {
  p.add("below", below).above(0).doc("kinetic energy of all bodies over the amount of elastic energy of all contacts");
}
void VoidRatioCondition::declare(Parameters& p) {
  p.add("below", below).symbol("e").above(0).doc("void ratio of the specimen to fall below");
  p.add("above", above).symbol("e").above(0).doc("void ratio of the specimen to exceed");
  p.check([this](const Complain& complain) {
    if (!below && !above) complain("", "neither below nor above", "at least one of them");
  });
}
void MeanStressCondition::declare(Parameters& p) {
  p.add("below", below).unit("Pa").symbol("p").above(0).doc("mean stress of the specimen to fall below");
  p.add("above", above).unit("Pa").symbol("p").above(0).doc("mean stress of the specimen to exceed");
  p.check([this](const Complain& complain) {
    if (!below && !above) complain("", "neither below nor above", "at least one of them");
  });
}
void StressCondition::declare(Parameters& p) {
  p.add("component", component)
      .one_of({cell_components.begin(), cell_components.end()})
      .doc("component of the stress tensor");
  p.add("value", value).unit("Pa").symbol("sigma").required().doc("stress, compression positive");
  p.add("within", within).above(0).at_most(1).doc("relative tolerance");
}
void PressureCondition::declare(Parameters& p) {
  p.add("wall", wall).required().doc("name of the wall");
  p.add("value", value).unit("Pa").symbol("p").at_least(0).required().doc("pressure on the wall, compression positive");
  p.add("within", within).above(0).at_most(1).doc("relative tolerance");
}
void DischargedCondition::declare(Parameters& p) {
  p.add("fraction", fraction).above(0).at_most(1).doc("discharged mass over the mass of all bodies so far");
}
Conditions::Conditions() = default;
Conditions::Conditions(const Conditions&) = default;
Conditions::Conditions(Conditions&&) noexcept = default;
Conditions& Conditions::operator=(const Conditions&) = default;
Conditions& Conditions::operator=(Conditions&&) noexcept = default;
Conditions::~Conditions() = default;
void AllCondition::declare(Parameters& p) { declare_parts(p, of, "conditions that must all hold at the same time"); }
void AnyCondition::declare(Parameters& p) { declare_parts(p, of, "conditions of which at least one must hold"); }

}  // namespace grit
