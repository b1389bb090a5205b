// The lateral surface of a cone, whole or truncated.
#pragma once

#include "grit/toolkit/frustum.hpp"

namespace grit {

class Cone : public Frustum {
 public:
  void declare(Parameters& p) override {
    declare_axis(p);
    p.add("start_radius", start_radius_)
        .unit("m")
        .symbol("R_1")
        .required()
        .at_least(0)
        .doc("radius at the start; 0: a tip");
    p.add("end_radius", end_radius_).unit("m").symbol("R_2").required().at_least(0).doc("radius at the end; 0: a tip");
    declare_sides(p);
    p.check([this](const Complain& complain) {
      if (!(start_radius_ + end_radius_ > 0))
        complain("end_radius", "a cone whose radii are both 0", "at least one radius above 0");
    });
  }
};

}  // namespace grit
