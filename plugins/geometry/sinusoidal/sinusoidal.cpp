// A rectangular sheet in sine waves. See README.md.
#include "sinusoidal.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <sstream>

#include "grit/plugin.hpp"

namespace grit {

namespace {

constexpr double most_waves = 1e6;                // each is drawn, and a feature's number has 32 bits
constexpr double facets = 64, most_facets = 4e6;  // drawn of a wave, of a sheet

std::string number(double value) { return (std::ostringstream() << value).str(); }

}  // namespace

void Sinusoidal::declare(Parameters& p) {
  sheet_.declare(p);
  p.add("depth", depth_).unit("m").symbol("d").required().at_least(0).doc("from crest down to trough; 0: a flat sheet");
  p.add("wavelength", wavelength_).unit("m").symbol("l").required().above(0).doc("from crest to crest");
  p.add("offset", offset_).unit("m").symbol("o").doc("from the corner along edge_a to where some crest is");
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
  // In a trough beyond which the next crest rises, a sphere may touch an end and that crest.
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

/// On the half wave that faces a centre the squared distance is lowest where its derivative rises through 0. From crest
/// to trough the derivative first rises; where the centre is higher above the trough than that is curved, it falls
/// again from that place on whose centre of curvature is level with the centre.
Sinusoidal::Sight Sinusoidal::sight(double above) const {
  if (!(above + depth_ > trough_radius_)) return {std::numeric_limits<double>::infinity(), 0};
  const double square = steepest_ * steepest_, linear = square + steepest_ * wave_number_ * above;
  const double cosine = -2 * (1 + square) / (linear + std::sqrt(linear * linear + 8 * square * (1 + square)));
  const double last = std::acos(std::max(cosine, -1.0)) / wave_number_;
  const Wave there = wave(last);
  return {last, last - (above - there.height) * there.slope};
}

/// Where the half wave that faces a centre is closest to it, from its crest on. The centre is `beside` ≥ 0 from the
/// crest, `above` the plane of the crests, in front of the waves, and has a closest place no farther on than `last`.
double Sinusoidal::closest(double beside, double above, double last) const {
  constexpr double fine = 1e-13;  // of a wavelength; what is left then is the square of it
  constexpr int enough = 60;
  double low = 0, high = std::min(beside, last), way = high;
  double at = above > 0 ? std::min(high, beside / (1 + steepest_ * wave_number_ * above)) : high;
  for (int i = 0; i < enough; ++i) {
    const Wave here = wave(at);
    const double over = above - here.height, error = at - beside - over * here.slope;
    (error > 0 ? high : low) = at;
    const double step = -error / (1 + here.slope * here.slope - over * here.bend);
    if (std::abs(step) <= fine * wavelength_) return std::clamp(at + step, low, high);
    // Newton's method alone may leave the bracket, or go to and fro in it for ever.
    const bool slow = !(at + step >= low && at + step <= high) || std::abs(step) > 0.5 * way;
    const double next = slow ? 0.5 * (low + high) : at + step;
    way = std::abs(next - at);
    at = next;
  }
  return at;
}

/// How far a centre behind the waves is past its closest place along edge a, from which the waves look alike with
/// crests for troughs. That place is no farther than the ends of the sheet.
double Sinusoidal::past_closest_from_behind(double a, double above) const {
  const double below = -depth_ - above;
  const Sight sight = this->sight(below);
  const auto past = [&](double trough) {
    const double from_trough = a - trough, beside = std::abs(from_trough);
    return std::copysign(beside - closest(beside, below, sight.last), from_trough);
  };
  const auto on_sheet = [&](double past) { return std::clamp(past, a - sheet_.length_a, a); };
  const auto distance = [&](double past) { return std::hypot(past, above - wave_at(a - past).height); };
  const double trough = crest(std::floor(number_at(a)) + 0.5), own = past(trough), here = on_sheet(own);
  if (here == own) return own;
  const double other_trough = trough + std::copysign(wavelength_, a - trough);
  if (!(std::abs(a - other_trough) < sight.reach)) return here;
  const double there = on_sheet(past(other_trough));
  return distance(there) < distance(here) ? there : here;
}

/// Half the rate at which the squared distance from a place in the section changes along the waves at `a`.
double Sinusoidal::rate(double a, const Vec3& place) const {
  const Wave here = wave_at(a);
  return a - place.x() - (place.z() - here.height) * here.slope;
}

/// Calls found(feature, past, here, edge) wherever on the waves the distance from a place in front of them, or beyond
/// their ends, has a local minimum: how far the place is past that along edge a, and whether it is an end of the sheet.
template <class Found>
void Sinusoidal::each_in_front(const Vec3& place, double half_width, Found found) const {
  constexpr double rounding = 1e-12;  // of a wavelength
  const double x = place.x(), z = place.z(), length = sheet_.length_a, on = std::clamp(x, 0.0, length);
  const double own = std::round(number_at(x));
  const Sight sight = this->sight(z);
  const double reach = std::min(sight.reach, half_width + 0.5 * wavelength_);
  double first = std::min(own, std::ceil(number_at(x - reach))), last = std::max(own, std::floor(number_at(x + reach)));
  const double valley = std::floor(number_at(on));
  if (z < 0) first = valley, last = valley + 1;  // these crests hide all others
  const bool in_front = z >= wave_at(on).height, sees_start = in_front ? z >= 0 || number_at(0) >= valley : x < 0,
             sees_end = in_front ? z >= 0 || number_at(length) <= valley + 1 : x > length;
  const bool at_start = sees_start && x < half_width && (!in_front || rate(0, place) > 0),
             at_end = sees_end && length - x < half_width && (!in_front || rate(length, place) < 0);
  if (at_start) found(start_feature_, x, wave_at(0), true);
  if (in_front)
    for (double n = std::max(first, 0.0); n <= std::min(last, last_crest_); ++n) {
      const double from_crest = x - crest(n), beside = std::abs(from_crest);
      if (n != own && !(beside < sight.reach)) continue;
      if ((at_start && start_feature_ == n + 1) || (at_end && end_feature_ == n + 1)) continue;
      const double to = std::copysign(closest(beside, z, sight.last), from_crest), a = crest(n) + to;
      if (a < (at_start ? 0 : -rounding * wavelength_) || a > length + (at_end ? 0 : rounding * wavelength_)) continue;
      found(n + 1, from_crest - to, wave(to), false);
    }
  if (at_end) found(end_feature_, x - length, wave_at(length), true);
}

/// From the closest point of the box that just holds the waves.
Vec3 Sinusoidal::beyond(const Vec3& place) const {
  return place - place.cwiseMax(Vec3(0, 0, -depth_)).cwiseMin(Vec3(sheet_.length_a, sheet_.length_b, 0));
}

void Sinusoidal::touch(const Pose& pose, std::span<const Sphere> spheres, std::vector<Touch>& touches) const {
  const Sheet::Frame at = sheet_.at(pose);
  for (const Sphere& sphere : spheres) {
    const double squared_radius = sphere.radius * sphere.radius;
    const Vec3 place = at.place(sphere.centre), beyond = this->beyond(place);
    if (!(beyond.squaredNorm() < squared_radius)) continue;
    const double past_side = beyond.y();
    const bool fits = sphere.radius <= trough_radius_;
    const std::size_t before = touches.size();
    const auto touched = [&](double feature, const Vec3& away, double distance) {
      touches.push_back({-(at.axes * away).normalized(), sphere.radius - distance, sphere.body,
                         fits ? 0 : static_cast<std::uint32_t>(feature)});
    };
    if (beyond.x() == 0 && place.z() < wave_at(place.x()).height) {
      const double past = past_closest_from_behind(place.x(), place.z()), a = place.x() - past;
      const Wave here = wave_at(a);
      const Vec3 away(past, past_side, place.z() - here.height);
      const double distance = away.norm(), feature = 1 + std::clamp(std::round(number_at(a)), 0.0, last_crest_);
      if (!(distance < sphere.radius)) continue;
      if (past_side == 0) touched(feature, {-here.slope, 0, 1}, -distance);
      else touched(feature, away, distance);
      continue;
    }
    const double half_width = std::sqrt(squared_radius - past_side * past_side - beyond.z() * beyond.z());
    each_in_front(place, half_width, [&](double feature, double past, const Wave& here, bool edge) {
      const Vec3 away(past, past_side, place.z() - here.height);
      const double distance = away.norm();
      if (!(distance < sphere.radius)) return;
      // On a face the normal is that of the face, however close the centre is.
      touched(feature, edge || past_side != 0 ? away : Vec3(-here.slope, 0, 1), distance);
    });
    if (!fits || touches.size() < before + 2) continue;
    const auto own = touches.begin() + static_cast<std::ptrdiff_t>(before);
    *own = *std::max_element(own, touches.end(), [](const Touch& a, const Touch& b) { return a.overlap < b.overlap; });
    touches.resize(before + 1);
  }
}

bool Sinusoidal::near(const Pose& pose, const Vec3& centre, double reach) const {
  return beyond(sheet_.at(pose).place(centre)).squaredNorm() <= reach * reach;
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
    for (const Vec3& place : {a, b, Vec3(b + along_b), a, Vec3(b + along_b), Vec3(a + along_b)})
      corners.push_back(sheet_.corner + sheet_.axes * place);
  }
  return corners;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "geometry",
                                     .name = "sinusoidal",
                                     .version = "1.0.0",
                                     .doc = "rectangular sheet in sine waves, solid behind",
                                     .make_geometry = []() -> grit::Geometry* { return new grit::Sinusoidal; }};
  return &info;
}
