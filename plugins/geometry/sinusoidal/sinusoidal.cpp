// A rectangular sheet with a sinusoidal surface. See README.md.
#include "sinusoidal.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <sstream>

#include "grit/plugin.hpp"

namespace grit {

namespace {

constexpr double most_waves = 1e6;                // limited by drawing; feature numbers have 32 bits
constexpr double facets = 64, most_facets = 4e6;  // drawn per wave, per sheet

std::string number(double value) { return (std::ostringstream() << value).str(); }

}  // namespace

void Sinusoidal::declare(Parameters& p) {
  sheet_.declare(p);
  p.add("depth", depth_).unit("m").symbol("d").required().at_least(0).doc("crest to trough; 0: a flat sheet");
  p.add("wavelength", wavelength_).unit("m").symbol("l").required().above(0).doc("from crest to crest");
  p.add("offset", offset_).unit("m").symbol("o").doc("distance along edge_a from the corner to a crest");
  p.check([this](const Complain& complain) {
    const double waves = sheet_.edge_a.norm() / wavelength_;
    if (waves > most_waves)
      complain("wavelength", number(waves) + " waves on the sheet", "at most " + number(most_waves));
  });
}

void Sinusoidal::prepare() {
  sheet_.prepare();
  wave_number_ = 2 * std::numbers::pi / wavelength_;
  steepest_ = 0.5 * depth_ * wave_number_;
  trough_radius_ = 1 / (steepest_ * wave_number_);
  first_crest_ = std::remainder(offset_, wavelength_);  // within half a wave of the corner
  last_crest_ = std::ceil(number_at(sheet_.length_a) - 0.5);
  // A sphere may touch an end that lies in a trough as well as the next crest.
  const double past_last = sheet_.length_a - crest(last_crest_);
  const bool start_in_trough = first_crest_ > 0 && wave(first_crest_).bend > 0,
             end_in_trough = past_last > 0 && wave(past_last).bend > 0;
  start_feature_ = start_in_trough ? 0 : 1;
  end_feature_ = static_cast<std::uint32_t>(last_crest_) + (end_in_trough ? 2 : 1);
}

Sinusoidal::Wave Sinusoidal::wave(double from_crest) const {
  const double half = 0.5 * wave_number_ * from_crest, sine = std::sin(half), cosine = std::cos(half);
  return {.height = -depth_ * sine * sine,
          .slope = -2 * steepest_ * sine * cosine,
          .bend = steepest_ * wave_number_ * (2 * sine * sine - 1)};
}

/// A minimum of squared distance is where its derivative rises through 0. From crest to trough the derivative first
/// rises. If the centre is more than the trough's radius of curvature above the trough, it falls again past the point
/// whose centre of curvature is level with the centre.
Sinusoidal::MinimumRange Sinusoidal::minimum_range(double above) const {
  if (!(above + depth_ > trough_radius_)) return {std::numeric_limits<double>::infinity(), 0};
  const double square = steepest_ * steepest_, linear = square + steepest_ * wave_number_ * above;
  const double cosine = -2 * (1 + square) / (linear + std::sqrt(linear * linear + 8 * square * (1 + square)));
  const double last = std::acos(std::max(cosine, -1.0)) / wave_number_;
  const Wave there = wave(last);
  return {last, last - (above - there.height) * there.slope};
}

/// Closest point of the facing half wave, as a distance from its crest. The centre is in front, `beside` ≥ 0 from the
/// crest and `above` the plane of the crests; a closest point no farther than `last` must exist.
double Sinusoidal::closest(double beside, double above, double last) const {
  constexpr double fine = 1e-13;  // of a wavelength; the remaining error is its square
  constexpr int max_iterations = 60;
  double low = 0, high = std::min(beside, last), last_step = high;
  double at = above > 0 ? std::min(high, beside / (1 + steepest_ * wave_number_ * above)) : high;
  for (int i = 0; i < max_iterations; ++i) {
    const Wave here = wave(at);
    const double over = above - here.height, error = at - beside - over * here.slope;
    (error > 0 ? high : low) = at;
    const double step = -error / (1 + here.slope * here.slope - over * here.bend);
    if (std::abs(step) <= fine * wavelength_) return std::clamp(at + step, low, high);
    // Newton's method alone may leave the bracket or oscillate.
    const bool slow = !(at + step >= low && at + step <= high) || std::abs(step) > 0.5 * last_step;
    const double next = slow ? 0.5 * (low + high) : at + step;
    last_step = std::abs(next - at);
    at = next;
  }
  return at;
}

/// Offset along edge a of a centre behind the surface from its closest point on the sheet. Seen from behind the surface
/// is the same, with crests and troughs exchanged.
double Sinusoidal::past_closest_from_behind(double a, double above) const {
  const double below = -depth_ - above;
  const MinimumRange range = minimum_range(below);
  const auto past = [&](double trough) {
    const double from_trough = a - trough, beside = std::abs(from_trough);
    return std::copysign(beside - closest(beside, below, range.last), from_trough);
  };
  const auto on_sheet = [&](double past) { return std::clamp(past, a - sheet_.length_a, a); };
  const auto distance = [&](double past) { return std::hypot(past, above - wave_at(a - past).height); };
  const double trough = crest(std::floor(number_at(a)) + 0.5), own = past(trough), here = on_sheet(own);
  if (here == own) return own;
  const double other_trough = trough + std::copysign(wavelength_, a - trough);
  if (!(std::abs(a - other_trough) < range.reach)) return here;
  const double there = on_sheet(past(other_trough));
  return distance(there) < distance(here) ? there : here;
}

/// Half the derivative, along edge a at `a`, of the squared distance from a point in the section.
double Sinusoidal::rate(double a, const Vec3& local) const {
  const Wave here = wave_at(a);
  return a - local.x() - (local.z() - here.height) * here.slope;
}

/// Calls found(feature, past, here, edge) at each local minimum of distance from a point in front of the surface or
/// beyond its ends. `past` is the offset of the point from it along edge a; `edge`: at an end of the sheet.
template <class Found>
void Sinusoidal::each_in_front(const Vec3& local, double half_width, Found found) const {
  constexpr double rounding = 1e-12;  // of a wavelength
  const double x = local.x(), z = local.z(), length = sheet_.length_a, on = std::clamp(x, 0.0, length);
  const double own = std::round(number_at(x));
  const MinimumRange range = minimum_range(z);
  const double reach = std::min(range.reach, half_width + 0.5 * wavelength_);
  double first = std::min(own, std::ceil(number_at(x - reach))), last = std::max(own, std::floor(number_at(x + reach)));
  const double valley = std::floor(number_at(on));
  if (z < 0) first = valley, last = valley + 1;  // these crests hide all others
  const bool in_front = z >= wave_at(on).height, start_visible = in_front ? z >= 0 || number_at(0) >= valley : x < 0,
             end_visible = in_front ? z >= 0 || number_at(length) <= valley + 1 : x > length;
  const bool at_start = start_visible && x < half_width && (!in_front || rate(0, local) > 0),
             at_end = end_visible && length - x < half_width && (!in_front || rate(length, local) < 0);
  if (at_start) found(start_feature_, x, wave_at(0), true);
  if (in_front)
    for (double n = std::max(first, 0.0); n <= std::min(last, last_crest_); ++n) {
      const double from_crest = x - crest(n), beside = std::abs(from_crest);
      if (n != own && !(beside < range.reach)) continue;
      if ((at_start && start_feature_ == n + 1) || (at_end && end_feature_ == n + 1)) continue;
      const double to = std::copysign(closest(beside, z, range.last), from_crest), a = crest(n) + to;
      if (a < (at_start ? 0 : -rounding * wavelength_) || a > length + (at_end ? 0 : rounding * wavelength_)) continue;
      found(n + 1, from_crest - to, wave(to), false);
    }
  if (at_end) found(end_feature_, x - length, wave_at(length), true);
}

/// From the closest point of the bounding box of the waves.
Vec3 Sinusoidal::beyond(const Vec3& local) const {
  return local - local.cwiseMax(Vec3(0, 0, -depth_)).cwiseMin(Vec3(sheet_.length_a, sheet_.length_b, 0));
}

void Sinusoidal::find_contacts(const Pose& pose, std::span<const Sphere> spheres,
                               std::vector<SurfaceContact>& contacts) const {
  const Sheet::Frame at = sheet_.at(pose);
  for (const Sphere& sphere : spheres) {
    const double squared_radius = sphere.radius * sphere.radius;
    const Vec3 local = at.local(sphere.centre), beyond = this->beyond(local);
    if (!(beyond.squaredNorm() < squared_radius)) continue;
    const double past_side = beyond.y();
    const bool fits = sphere.radius <= trough_radius_;
    const std::size_t before = contacts.size();
    const auto add = [&](double feature, const Vec3& away, double distance) {
      contacts.push_back({-(at.axes * away).normalized(), sphere.radius - distance, sphere.body,
                          fits ? 0 : static_cast<std::uint32_t>(feature)});
    };
    if (beyond.x() == 0 && local.z() < wave_at(local.x()).height) {
      const double past = past_closest_from_behind(local.x(), local.z()), a = local.x() - past;
      const Wave here = wave_at(a);
      const Vec3 away(past, past_side, local.z() - here.height);
      const double distance = away.norm(), feature = 1 + std::clamp(std::round(number_at(a)), 0.0, last_crest_);
      if (!(distance < sphere.radius)) continue;
      if (past_side == 0) add(feature, {-here.slope, 0, 1}, -distance);
      else add(feature, away, distance);
      continue;
    }
    const double half_width = std::sqrt(squared_radius - past_side * past_side - beyond.z() * beyond.z());
    each_in_front(local, half_width, [&](double feature, double past, const Wave& here, bool edge) {
      const Vec3 away(past, past_side, local.z() - here.height);
      const double distance = away.norm();
      if (!(distance < sphere.radius)) return;
      // On a face the normal of the face is used: the offset may be 0.
      add(feature, edge || past_side != 0 ? away : Vec3(-here.slope, 0, 1), distance);
    });
    if (!fits || contacts.size() < before + 2) continue;
    const auto own = contacts.begin() + static_cast<std::ptrdiff_t>(before);
    *own = *std::max_element(own, contacts.end(),
                             [](const SurfaceContact& a, const SurfaceContact& b) { return a.overlap < b.overlap; });
    contacts.resize(before + 1);
  }
}

bool Sinusoidal::near(const Pose& pose, const Vec3& centre, double reach) const {
  return beyond(sheet_.at(pose).local(centre)).squaredNorm() <= reach * reach;
}

Bounds Sinusoidal::bounds() const {
  const Bounds crests = sheet_.bounds();
  const Vec3 down = -depth_ * normal();
  return {crests.low.cwiseMin(crests.low + down), crests.high.cwiseMax(crests.high + down)};
}

std::vector<Vec3> Sinusoidal::triangles() const {
  const double length = sheet_.length_a;
  const double facet = wavelength_ / std::clamp(std::floor(most_facets / (length / wavelength_)), 4.0, facets);
  std::vector<double> cuts{0};
  if (depth_ > 0)
    for (double n = std::floor(-first_crest_ / facet) + 1; n * facet + first_crest_ < length; ++n)
      cuts.push_back(n * facet + first_crest_);
  cuts.push_back(length);
  std::vector<Vec3> corners;
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    const Vec3 a(cuts[i - 1], 0, wave_at(cuts[i - 1]).height), b(cuts[i], 0, wave_at(cuts[i]).height),
        along_b(0, sheet_.length_b, 0);
    for (const Vec3& local : {a, b, Vec3(b + along_b), a, Vec3(b + along_b), Vec3(a + along_b)})
      corners.push_back(sheet_.corner + sheet_.axes * local);
  }
  return corners;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "geometry",
                                     .name = "sinusoidal",
                                     .version = "1.0.0",
                                     .doc = "rectangular sheet with a sinusoidal surface, solid behind",
                                     .make_geometry = []() -> grit::Geometry* { return new grit::Sinusoidal; }};
  return &info;
}
