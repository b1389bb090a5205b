// The lateral surface of a cylinder.
#pragma once

#include "grit/toolkit/frustum.hpp"

namespace grit {

class Cylinder : public Frustum {
 public:
  void declare(Parameters& p) override {
    declare_axis(p);
    p.add("radius", start_radius_).unit("m").symbol("R").required().above(0).doc("radius");
    declare_sides(p);
  }
  void prepare() override {
    end_radius_ = start_radius_;
    Frustum::prepare();
  }
};

}  // namespace grit
