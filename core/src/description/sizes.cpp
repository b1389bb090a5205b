#include "description/sizes.hpp"

#include <algorithm>
#include <functional>
#include <string>

#include "format/number.hpp"

namespace grit {
namespace {

void declare_sizes(Parameters& p, double& smallest, double& largest) {
  p.add("smallest", smallest).unit("m").symbol("d_min").above(0).doc("smallest diameter");
  p.add("largest", largest).unit("m").symbol("d_max").above(0).doc("largest diameter");
  p.check(
      [&](const Complain& complain) {
        if (largest < smallest)
          complain("largest", number(largest) + " m, below smallest, which is " + number(smallest) + " m",
                   "at least smallest; are the units of both right?");
      },
      {"smallest", "largest"});
}

}  // namespace

void UniformSizes::declare(Parameters& p) { declare_sizes(p, smallest, largest); }
void LinearSizes::declare(Parameters& p) { declare_sizes(p, smallest, largest); }
void LogNormalSizes::declare(Parameters& p) {
  p.add("median", median).unit("m").symbol("d_50").above(0).doc("median diameter");
  p.add("log_standard_deviation", log_standard_deviation)
      .above(0)
      .at_most(3)
      .doc("standard deviation of the natural logarithm of the diameter");
  declare_sizes(p, smallest, largest);
}
void SieveSizes::declare(Parameters& p) {
  p.add("diameters", diameters).unit("m").above(0).required().entries(2).doc("sieve openings, increasing");
  p.add("passing", passing)
      .at_least(0)
      .at_most(1)
      .required()
      .entries(2)
      .doc("mass fraction that passes each sieve, increasing to 1");
  p.check(
      [this](const Complain& complain) {
        const auto rises = [](const std::vector<double>& v) {
          return std::ranges::adjacent_find(v, std::greater_equal()) == v.end();
        };
        if (passing.size() != diameters.size())
          complain("passing", counted(passing.size(), "entry", "entries"),
                   std::to_string(diameters.size()) + ", one per diameter");
        if (!rises(diameters)) complain("diameters", "a list that does not increase", "an increasing list");
        if (!rises(passing)) complain("passing", "a list that does not increase", "an increasing list");
        if (passing.back() != 1) complain("passing", "a last entry below 1", "1, all the mass");
      },
      {"diameters", "passing"});
}
void ListSizes::declare(Parameters& p) {
  p.add("diameters", diameters)
      .unit("m")
      .above(0)
      .required()
      .entries(1)
      .doc("diameters, assigned in order and repeated");
}

}  // namespace grit
