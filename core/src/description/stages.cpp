#include "description/stages.hpp"

#include <algorithm>
#include <utility>

#include "description/description.hpp"
#include "format/names.hpp"
#include "grit/toolkit/did_you_mean.hpp"

namespace grit {
namespace {

bool is_changeable(const std::string& section) {
  const auto& all = SceneDescription::changeable();
  return std::ranges::find(all, section) != all.end();
}

}  // namespace

void RampDescription::declare(Parameters& p) {
  p.add("pointer", pointer).required().doc("JSON pointer of the number, e.g. /walls/top/motion/servo/pressure");
  p.add("from", from).required().doc("value at the start, as in the description");
  p.add("to", to).required().doc("value at the end, kept in later stages");
  p.add("duration", duration).unit("s").above(0).required().doc("simulated time from start to end");
  p.add("increments", increments).at_least(1).at_most(100000).doc("number of equal increments");
  p.check(
      [this](const Complain& complain) {
        const auto second = pointer.find('/', 1);
        const std::string section = pointer.empty() ? "" : pointer.substr(1, second - 1);
        if (pointer.empty() || pointer.front() != '/' || second == std::string::npos || !is_changeable(section))
          complain("pointer", in_quotes(pointer) + did_you_mean(section, SceneDescription::changeable()),
                   "a JSON pointer below one of " + listed(SceneDescription::changeable()));
        else if (const auto& of_domain = DomainDescription::changeable();
                 section == "domain" && std::ranges::none_of(of_domain, [&](const std::string& key) {
                   return (pointer + '/').starts_with("/domain/" + key + '/');
                 }))
          complain("pointer", in_quotes(pointer), "in the domain one of " + listed(of_domain));
        for (const auto& [key, value] : {std::pair("from", &from), std::pair("to", &to)})
          if (!value->is_number() && !value->is_string())
            complain(key, "neither a number nor a text", "a number or a quantity");
      },
      {"pointer", "from", "to"});
}
void GrowthDescription::declare(Parameters& p) {
  p.add("rate", rate)
      .unit("1/s")
      .above(0)
      .required()
      .doc("growth rate of all radii R: dR/dt = rate R; masses and moments of inertia follow at constant density");
}
void ExpectDescription::declare(Parameters& p) {
  p.add("void_ratio", void_ratio).symbol("e").above(0).doc("void ratio of the specimen at the end of the stage");
  p.add("within", within).above(0).doc("accepted difference");
}
void StageDescription::declare(Parameters& p) {
  p.add("name", name).required().doc("unique name");
  p.add("until", until).required().doc("condition that ends the stage");
  p.add("limit", limit).unit("s").above(0).required().doc("simulated time after which the stage fails");
  p.add("typical_time", typical_time)
      .unit("s")
      .above(0)
      .doc("typical simulated duration of a stage that a condition ends; grit check uses it for estimates");
  p.add("change", change)
      .doc("merge patch (RFC 7396) of the description from this stage on; allowed sections: " +
           listed(SceneDescription::changeable()) +
           "; in domain only strain_rate, shear_rate and servo; the geometry of a wall is that before its motion, "
           "which is added "
           "to it");
  p.add("ramps", ramps).doc("numbers that change during the stage, one after the other");
  p.add("growth", growth).doc("growth of all bodies during the stage; default: none");
  p.add("expect", expect).doc("state required at the end of the stage");
  p.check(
      [this](const Complain& complain) {
        if (!change.is_object()) return complain("change", "no object", "an object (a merge patch)");
        for (const auto& [section, patch] : change.items()) {
          if (!is_changeable(section))
            complain("change/" + section,
                     "a change of " + in_quotes(section) + did_you_mean(section, SceneDescription::changeable()),
                     "one of " + listed(SceneDescription::changeable()));
          if (section != "domain" || !patch.is_object()) continue;
          const auto& of_domain = DomainDescription::changeable();
          for (const auto& [key, _] : patch.items())
            if (std::ranges::find(of_domain, key) == of_domain.end())
              complain("change/domain/" + key, "a change of " + in_quotes(key) + did_you_mean(key, of_domain),
                       "one of " + listed(of_domain));
        }
      },
      {"change"});
  p.check(
      [this](const Complain& complain) {
        if (typical_time && *typical_time > limit)
          complain("typical_time", "a time above the limit of the stage", "at most the limit");
      },
      {"typical_time", "limit"});
  p.check(
      [this](const Complain& complain) {
        if (name.empty()) complain("name", "an empty text", "a name");
      },
      {"name"});
}

}  // namespace grit
