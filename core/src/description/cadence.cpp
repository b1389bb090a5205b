#include "description/cadence.hpp"

#include "description/axes.hpp"

namespace grit {

void DisplacementCadence::declare(Parameters& p) {
  p.add("wall", wall).required().doc("name of the wall");
  p.add("axis", axis).one_of(one_axis).doc("axis of the displacement");
  p.add("value", value)
      .unit("m")
      .symbol("u")
      .above(0)
      .required()
      .doc("displacement between two samples or frames, in either direction");
}
void Cadence::declare(Parameters& p) {
  p.add("every_time", every_time).unit("s").above(0).doc("simulated time between two samples or frames");
  p.add("every_steps", every_steps).at_least(0).doc("steps between two samples or frames; 0: not used");
  p.add("every_displacement", every_displacement).doc("displacement of a wall between two samples or frames");
  p.add("every_discharged", every_discharged)
      .above(0)
      .at_most(1)
      .doc("mass discharged between two samples or frames, over the mass of all bodies so far");
  p.check(
      [this](const Complain& complain) {
        std::string key, given;
        int count = 0;
        const auto add = [&](bool there, const char* name, const char* what) {
          if (there) key = name, given += (++count == 1 ? "a cadence " : " and ") + std::string(what);
        };
        add(every_time.has_value(), "every_time", "in time");
        add(every_steps > 0, "every_steps", "in steps");
        add(every_displacement.has_value(), "every_displacement", "in displacement");
        add(every_discharged.has_value(), "every_discharged", "in discharged mass");
        if (count > 1) complain(key, given, "one of them");
      },
      {"every_time", "every_steps", "every_displacement", "every_discharged"});
}

}  // namespace grit
