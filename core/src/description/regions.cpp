#include "description/regions.hpp"

#include "description/axes.hpp"

namespace grit {

void RectangleRegion::declare(Parameters& p) {
  p.add("corner", corner).unit("m").required().doc("corner");
  p.add("edge_a", edge_a).unit("m").required().doc("one edge, from the corner");
  p.add("edge_b", edge_b).unit("m").required().doc("the other edge, from the corner");
  p.check([this](const Complain& complain) {
    if (!(edge_a.cross(edge_b).norm() > 0)) complain("edge_b", "parallel edges", "an edge across edge_a");
  });
}
void DiscRegion::declare(Parameters& p) {
  p.add("centre", centre).unit("m").required().doc("centre");
  p.add("normal", normal).doc("normal of the disc");
  p.add("radius", radius).unit("m").above(0).required().doc("radius of the disc");
  p.check([this](const Complain& complain) {
    if (!(normal.norm() > 0)) complain("normal", "a vector of length 0", "a direction");
  });
}
void BoxRegion::declare(Parameters& p) {
  p.add("low", low).unit("m").required().doc("lower corner");
  p.add("high", high).unit("m").required().doc("upper corner");
  p.check([this](const Complain& complain) { check_box(low, high, complain); }, {"low", "high"});
}
void SphereRegion::declare(Parameters& p) {
  p.add("centre", centre).unit("m").required().doc("centre");
  p.add("radius", radius).unit("m").above(0).required().doc("radius");
}
void CylinderRegion::declare(Parameters& p) {
  p.add("start", start).unit("m").required().doc("start of the axis: centre of one end");
  p.add("end", end).unit("m").required().doc("end of the axis: centre of the other end");
  p.add("radius", radius).unit("m").above(0).required().doc("radius");
  p.check([this](const Complain& complain) {
    if (start == end) complain("end", "the start of the axis", "another point");
  });
}
void HalfSpaceRegion::declare(Parameters& p) {
  p.add("point", point).unit("m").required().doc("any point of the plane");
  p.add("normal", normal).doc("normal of the plane, out of the region; any length above 0");
  p.check([this](const Complain& complain) {
    if (!(normal.norm() > 0)) complain("normal", "a vector of length 0", "a direction");
  });
}
void MeshRegion::declare(Parameters& p) {
  p.add("path", path).file().required().doc("STL file, ASCII or binary, of a closed surface");
  p.add("scale", scale).unit("m").required().above(0).doc("length of one file unit, e.g. \"1 mm\"");
  p.add("position", position).unit("m").doc("position of the file's origin in the scene");
}

void check_box(const Vec3& low, const Vec3& high, const Complain& complain) {
  for (int k = 0; k < 3; ++k)
    if (!(low[k] < high[k]))
      complain("high/" + std::to_string(k), "high not above low along " + one_axis[as_index(k)], "low < high");
}

}  // namespace grit
