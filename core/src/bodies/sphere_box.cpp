// Closed form. The planes of the box cut the ball into pieces {x > a, y > b, z > c} with a, b, c ≥ 0 (one, two or three
// planes), and the part inside is a sum of these with signs. A piece's volume is a third of the flux of the position
// vector: its spherical face by Gauss–Bonnet (circles' geodesic curvature and the angles between them), its plane faces
// as circular segments. All roots are taken once and all angles by atan2 from them: rounding errors of a nearly
// vanishing root then cancel to first order. Cf. S. Strobl, A. Formella, T. Pöschel, J. Comput. Phys. 311 (2016)
// 158–172, doi:10.1016/j.jcp.2016.02.003.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "grit/world.hpp"

namespace grit {

namespace {

using std::numbers::pi;

constexpr double ball = 4.0 / 3.0 * pi;

/// Unit ball, x > a.
double cap(double a) { return pi / 3 * (1 - a) * (1 - a) * (2 + a); }

/// Unit ball, x > a and y > b.
double edge(double a, double b) {
  const double square = 1 - a * a - b * b;
  if (square <= 0) return 0;
  const double root = std::sqrt(square);
  const double arc_a = 2 * std::atan2(root, b), arc_b = 2 * std::atan2(root, a);
  const double sphere = 2 * pi - a * arc_a - b * arc_b - 2 * std::atan2(root, -a * b);
  const double area_a = 0.5 * (1 - a * a) * arc_a - b * root, area_b = 0.5 * (1 - b * b) * arc_b - a * root;
  return (sphere - a * area_a - b * area_b) / 3;
}

/// Unit ball, x > a, y > b and z > c.
double corner(double a, double b, double c) {
  if (a * a + b * b + c * c >= 1) return 0;
  const double root_a = std::sqrt(1 - b * b - c * c);
  const double root_b = std::sqrt(1 - a * a - c * c);
  const double root_c = std::sqrt(1 - a * a - b * b);
  const double arc_a = std::atan2(root_c, b) - std::atan2(c, root_b);
  const double arc_b = std::atan2(root_c, a) - std::atan2(c, root_a);
  const double arc_c = std::atan2(root_b, a) - std::atan2(b, root_a);
  const double turns = std::atan2(root_a, -b * c) + std::atan2(root_b, -a * c) + std::atan2(root_c, -a * b);
  const double sphere = 2 * pi - a * arc_a - b * arc_b - c * arc_c - turns;
  const double area_a = 0.5 * ((1 - a * a) * arc_a - b * (root_c - c) - c * (root_b - b));
  const double area_b = 0.5 * ((1 - b * b) * arc_b - a * (root_c - c) - c * (root_a - a));
  const double area_c = 0.5 * ((1 - c * c) * arc_c - a * (root_b - b) - b * (root_a - a));
  return (sphere - a * area_a - b * area_b - c * area_c) / 3;
}

/// low < x < high as a sum over {everything, x > p, x > q} with p, q ≥ 0, by the ball's symmetry.
struct Side {
  double weight[3] = {};
  double plane[3] = {};

  Side(double low, double high) { add(1, low, 1), add(2, high, -1); }
  void add(int place, double at, double sign) {
    if (at < 0) weight[0] += sign, sign = -sign;
    if (std::abs(at) < 1) plane[place] = std::abs(at), weight[place] = sign;
  }
};

double piece(const double* plane, int planes) {
  switch (planes) {
    case 0:
      return ball;
    case 1:
      return cap(plane[0]);
    case 2:
      return edge(plane[0], plane[1]);
    default:
      return corner(plane[0], plane[1], plane[2]);
  }
}

}  // namespace

double sphere_box_volume(const Vec3& centre, double radius, const Vec3& low, const Vec3& high) {
  double outside = 0, farthest = 0, nearest_face = radius;
  int planes = 0;
  double plane = 0;  // from the centre towards the inside
  for (int k = 0; k < 3; ++k) {
    const double below = low[k] - centre[k], above = high[k] - centre[k];
    if (!(below < above)) return 0;
    const double gap = std::max({below, -above, 0.0}), far = std::max(-below, above);
    outside += gap * gap, farthest += far * far;
    nearest_face = std::min({nearest_face, -below, above});
    for (const double to : {below, -above})
      if (std::abs(to) < radius) ++planes, plane = to;
  }
  const double cube = radius * radius * radius;
  if (nearest_face >= radius) return ball * cube;
  if (outside >= radius * radius) return 0;
  const double box = (high - low).prod();
  if (farthest <= radius * radius) return box;
  // Most intersected spheres are cut by one plane only.
  if (planes == 1) return std::min(box, (plane < 0 ? ball - cap(-plane / radius) : cap(plane / radius)) * cube);

  const Vec3 from = (low - centre) / radius, to = (high - centre) / radius;
  const Side x(from[0], to[0]), y(from[1], to[1]), z(from[2], to[2]);
  double sum = 0;
  double cuts[3];
  for (int i = 0; i < 3; ++i) {
    if (x.weight[i] == 0) continue;
    int cut_x = 0;
    if (i > 0) cuts[cut_x++] = x.plane[i];
    for (int j = 0; j < 3; ++j) {
      if (y.weight[j] == 0) continue;
      int cut_y = cut_x;
      if (j > 0) cuts[cut_y++] = y.plane[j];
      for (int k = 0; k < 3; ++k) {
        if (z.weight[k] == 0) continue;
        int cut_z = cut_y;
        if (k > 0) cuts[cut_z++] = z.plane[k];
        sum += x.weight[i] * y.weight[j] * z.weight[k] * piece(cuts, cut_z);
      }
    }
  }
  return std::clamp(sum * cube, 0.0, std::min(box, ball * cube));
}

}  // namespace grit
