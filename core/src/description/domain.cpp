#include "description/domain.hpp"

#include <algorithm>
#include <utility>

#include "description/regions.hpp"
#include "format/names.hpp"
#include "grit/toolkit/did_you_mean.hpp"

namespace grit {
namespace {

const std::vector<std::string> all_sides{"-x", "+x", "-y", "+y", "-z", "+z"};

}  // namespace

void CellStressDescription::declare(Parameters& p) {
  for (const auto& [name, value] : {std::pair("xx", &xx), std::pair("yy", &yy), std::pair("zz", &zz)})
    p.add(name, *value).unit("Pa").symbol(std::string("sigma_") + name).doc("target, compression positive");
  for (const auto& [name, value] : {std::pair("xy", &xy), std::pair("xz", &xz), std::pair("yz", &yz)})
    p.add(name, *value)
        .unit("Pa")
        .symbol(std::string("sigma_") + name)
        .doc("target; a positive shear rate makes it negative, as extension does with normal stresses");
}
void ShearRateDescription::declare(Parameters& p) {
  p.add("xy", xy).unit("1/s").symbol("gamma_dot_xy").doc("gradient of the velocity along x in the direction y");
  p.add("xz", xz).unit("1/s").symbol("gamma_dot_xz").doc("gradient of the velocity along x in the direction z");
  p.add("yz", yz).unit("1/s").symbol("gamma_dot_yz").doc("gradient of the velocity along y in the direction z");
}
void CellServoDescription::declare(Parameters& p) {
  p.add("stress", stress)
      .required()
      .doc("stresses of the whole cell to keep; the strain rate of other components is prescribed");
  p.add("max_strain_rate", max_strain_rate)
      .unit("1/s")
      .above(0)
      .required()
      .doc("maximum strain rate of each component; without contacts the cell contracts at this rate");
  p.add("gain", gain)
      .above(0)
      .at_most(1)
      .doc("fraction of the error in stress that is corrected in an interval if bodies move with the mean flow");
  p.add("interval", interval).at_least(1).at_most(1000).doc("steps between evaluations of the stress");
}
const std::vector<std::string>& DomainDescription::changeable() {
  static const std::vector<std::string> keys{"strain_rate", "shear_rate", "servo"};
  return keys;
}
void DomainDescription::declare(Parameters& p) {
  p.add("low", low).unit("m").doc("lower corner; default: unbounded");
  p.add("high", high).unit("m").doc("upper corner; default: unbounded");
  p.add("periodic", periodic).doc("axes along which the domain is periodic");
  p.add("strain_rate", strain_rate)
      .unit("1/s")
      .symbol("eps_dot")
      .doc("strain rate along periodic axes, positive in extension");
  p.add("shear_rate", shear_rate).doc("simple shear of a domain that is periodic along all axes, without walls");
  p.add("servo", servo).doc("strain rates that keep stresses of a cell that is periodic along all axes");
  p.add("open_sides", open_sides)
      .doc("sides through which bodies may leave; they are removed: -x, +x, -y, +y, -z, +z; elsewhere it is an error");
  p.check(
      [this](const Complain& complain) {
        if (low && high) check_box(*low, *high, complain);
        for (std::size_t k = 0; k < 3; ++k) {
          const std::string axis = '/' + std::to_string(k);
          if (periodic[k] && !(low && high))
            complain("periodic" + axis, "a periodic axis without bounds", "a periodic axis with low and high");
          if (!periodic[k] && strain_rate[static_cast<int>(k)] != 0)
            complain("strain_rate" + axis, "a strain rate along an axis that is not periodic",
                     "0; or set domain/periodic for this axis");
        }
      },
      {"low", "high", "periodic", "strain_rate"});
  p.check(
      [this](const Complain& complain) {
        const bool periodic_everywhere = periodic[0] && periodic[1] && periodic[2];
        const Vec3 shear = shear_rate.vector();
        if (!shear.isZero(0.0) && !periodic_everywhere)
          complain("shear_rate", "shear of a domain that is not periodic along all axes",
                   "one with domain/periodic along x, y and z");
        if (!servo) return;
        if (!periodic_everywhere)
          complain("servo", "a servo of a domain that is not periodic along all axes",
                   "one with domain/periodic along x, y and z");
        const auto targets = servo->targets();
        if (std::ranges::none_of(targets, [](const auto& one) { return one.has_value(); }))
          complain("servo/stress", "no target stress", "at least one, or no servo");
        for (std::size_t k = 0; k < 3; ++k) {
          if (targets[k] && strain_rate[static_cast<int>(k)] != 0)
            complain("servo/stress/" + cell_components[k], "a target along an axis that has a strain rate",
                     "one of them");
          if (targets[k + 3] && shear[static_cast<int>(k)] != 0)
            complain("servo/stress/" + cell_components[k + 3], "a target together with a shear rate", "one of them");
        }
      },
      {"servo", "periodic", "strain_rate", "shear_rate"});
  p.check(
      [this](const Complain& complain) {
        for (std::size_t i = 0; i < open_sides.size(); ++i) {
          const std::string& side = open_sides[i];
          const std::string at = "open_sides/" + std::to_string(i);
          const bool known = side.size() == 2 && (side[0] == '-' || side[0] == '+') && side[1] >= 'x' && side[1] <= 'z';
          if (!known) complain(at, in_quotes(side) + did_you_mean(side, all_sides), "one of " + listed(all_sides));
          else if (periodic[static_cast<std::size_t>(side[1] - 'x')])
            complain(at, "a side of a periodic axis", "a side of an axis that is not periodic");
          else if (!(side[0] == '-' ? low : high))
            complain(at, "an open side without a bound",
                     side[0] == '-' ? "an open side with domain/low" : "an open side with domain/high");
        }
      },
      {"low", "high", "periodic", "open_sides"});
}

void SpecimenDescription::declare(Parameters& p) {
  p.add("low", low).doc("names of the walls at its lower x, y and z sides; \"\": bound of the domain");
  p.add("high", high).doc("names of the walls at its upper x, y and z sides; \"\": bound of the domain");
  p.check([this](const Complain& complain) {
    for (const auto& [key, walls] : {std::pair("low", &low), std::pair("high", &high)})
      if (!walls->empty() && walls->size() != 3)
        complain(key, "a list of " + std::to_string(walls->size()), "a list of 3, for x, y and z");
  });
}

}  // namespace grit
