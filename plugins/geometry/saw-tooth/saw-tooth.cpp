// A rectangular sheet with straight grooves cut into it. See README.md.
#include "saw-tooth.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <limits>
#include <numbers>
#include <sstream>

#include "grit/contact/lanes.hpp"
#include "grit/plugin.hpp"

namespace grit {

namespace {

constexpr double same_length = 1e-9;  // relative to a period; allows for rounded decimals
constexpr double most_grooves = 1e6;  // limited by drawing; feature numbers have 32 bits
constexpr std::size_t lane_count = lane_width<Lane>;

std::string number(double value) { return (std::ostringstream() << value).str(); }

}  // namespace

/// Closest point of a tooth or a floor to a centre, in the section.
struct SawTooth::Closest {
  double past = 0, above = 0;  // offset of the centre from it: along the face past its ends, and normal to it
  double squared = std::numeric_limits<double>::infinity();
  double height = -std::numeric_limits<double>::infinity();  // of the centre above the highest of its faces
  const Face* face = nullptr;                                // closest face
  const Face* highest = nullptr;
  bool in_valley = false;
};

void SawTooth::declare(Parameters& p) {
  constexpr double right_angle = std::numbers::pi / 2;
  sheet_.declare(p);
  p.add("depth", depth_).unit("m").symbol("h").required().above(0).doc("depth of a groove, from tips to bottom");
  p.add("inclination", inclination_)
      .unit("rad")
      .symbol("α")
      .above(0)
      .below(right_angle)
      .doc("angle of the flanks to the sheet; with second_inclination, of the flank that falls along edge_a");
  p.add("second_inclination", second_inclination_)
      .unit("rad")
      .symbol("α_2")
      .above(0)
      .below(right_angle)
      .doc("angle of the flank that rises along edge_a; default: inclination");
  p.add("floor", floor_).unit("m").symbol("f").at_least(0).doc("width of the flat bottom of a groove; 0: sharp");
  p.add("spacing", given_spacing_)
      .unit("m")
      .symbol("s")
      .above(0)
      .doc("period of the grooves; the rest is flat land; default: the width of a groove, no land");
  p.add("offset", offset_).unit("m").symbol("o").doc("distance along edge_a from the corner to the start of a groove");
  p.check([this](const Complain& complain) {
    const Widths width = widths();
    if (width.spacing < (1 - same_length) * width.groove())
      complain("spacing", number(width.spacing) + " m",
               "at least the width of a groove, flanks and floor: " + number(width.groove()) + " m");
    const double grooves = sheet_.edge_a.norm() / width.spacing;
    if (grooves > most_grooves)
      complain(given_spacing_ ? "spacing" : "depth", number(grooves) + " grooves on the sheet",
               "at most " + number(most_grooves));
  });
}

SawTooth::Widths SawTooth::widths() const {
  Widths width{.falling = depth_ / std::tan(inclination_),
               .floor = floor_,
               .rising = depth_ / std::tan(second_inclination_.value_or(inclination_)),
               .spacing = 0};
  width.spacing = given_spacing_.value_or(width.groove());
  return width;
}

void SawTooth::prepare() {
  sheet_.prepare();
  Widths width = widths();
  spacing_ = width.spacing;
  double land = spacing_ - width.groove();
  if (std::abs(land) < same_length * spacing_) {  // avoids slivers of land and overlapping teeth
    const double factor = spacing_ / width.groove();
    width.falling *= factor, width.floor *= factor, width.rising *= factor;
    land = 0;
  }
  tooth_ = width.rising + land + width.falling;

  const std::array<Vec2, 5> corners{Vec2(0, -depth_), Vec2(width.rising, 0), Vec2(width.rising + land, 0),
                                    Vec2(tooth_, -depth_), Vec2(tooth_ + width.floor, -depth_)};
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const Vec2 edge = corners[i + 1] - corners[i], along = edge.normalized();
    faces_[i] = {.start = corners[i],
                 .along = along,
                 .normal = {-along.y(), along.x()},
                 .length = edge.norm(),
                 .from_valley = corners[i].y() < 0,
                 .to_valley = corners[i + 1].y() < 0};
  }

  // The sheet starts in the first period. Teeth and floors with only a sliver on the sheet are omitted.
  const double sliver = same_length * spacing_, before = std::fmod(offset_, spacing_) - width.rising - land;
  start_ = before + spacing_ * std::floor(-before / spacing_);
  per_spacing_ = 1 / spacing_;
  first_ = 0, last_ = std::numeric_limits<int>::max();
  first_ = feature_at(sliver), last_ = feature_at(sheet_.length_a - sliver);
}

/// The tooth or floor at `a`; beyond the sheet the first or last.
int SawTooth::feature_at(double a) const {
  const double period = std::floor((a - start_) * per_spacing_);
  const bool on_floor = floor_ > 0 && a - start_ - period * spacing_ > tooth_;
  return static_cast<int>(std::clamp<double>(2 * period + on_floor, first_, last_));
}

std::span<const SawTooth::Face> SawTooth::faces(int feature) const {
  return std::span(faces_).subspan(feature % 2 == 0 ? 0 : 3, feature % 2 == 0 ? 3 : 1);
}

/// Start and end along a face of its part on the sheet; none if that is within rounding.
std::optional<std::pair<double, double>> SawTooth::extent(int feature, const Face& face) const {
  if (face.length == 0) return {};
  if (feature != first_ && feature != last_) return std::pair(0.0, face.length);
  double from = 0, to = face.length;
  const double start = period_start(feature) + face.start.x();
  if (feature == first_) from = std::max(from, -start / face.along.x());
  if (feature == last_) to = std::min(to, (sheet_.length_a - start) / face.along.x());
  const bool cut = from > 0 || to < face.length;
  if (cut && to - from < same_length / 3 * spacing_) return {};  // one of three faces on a sliver has a third of it
  return std::pair(from, to);
}

SawTooth::Closest SawTooth::closest(int feature, const Vec2& centre) const {
  Closest best;
  const double start = period_start(feature);
  for (const Face& face : faces(feature)) {
    const auto part = extent(feature, face);
    if (!part) continue;
    const double x = centre.x() - start - face.start.x(), z = centre.y() - face.start.y();
    const double along = face.along.x() * x + face.along.y() * z, height = face.normal.x() * x + face.normal.y() * z;
    if (height > best.height) best.height = height, best.highest = &face;
    const double past = along - std::clamp(along, part->first, part->second), squared = past * past + height * height;
    if (!(squared < best.squared)) continue;
    best.squared = squared, best.past = past, best.above = height, best.face = &face;
    best.in_valley = (along < 0 && face.from_valley) || (along > face.length && face.to_valley);
  }
  return best;
}

/// From the closest point of the bounding box of the grooves.
Vec3 SawTooth::beyond(const Vec3& local) const {
  return local - local.cwiseMax(Vec3(0, 0, -depth_)).cwiseMin(Vec3(sheet_.length_a, sheet_.length_b, 0));
}

/// The sheet at its current pose.
struct SawTooth::PlacedSheet {
  Sheet::Frame at;
  std::array<Vec3, 4> into;  // opposite to the normal of each face
};
/// One sphere per lane.
struct SawTooth::SphereLanes {
  Lane x, z;  // of centres in the section, from the start of their period
  Lane past_end, radius;
};
/// Their contacts with one tooth.
struct SawTooth::ToothContacts {
  std::array<Quad, lane_count> normal_and_overlap;
  std::uint32_t lanes = 0;
};

void SawTooth::find_contacts(const Pose& pose, std::span<const Sphere> spheres,
                             std::vector<SurfaceContact>& contacts) const {
  PlacedSheet sheet{.at = sheet_.at(pose), .into = {}};
  for (std::size_t i = 0; i < faces_.size(); ++i)
    if (faces_[i].length > 0)
      sheet.into[i] = -(sheet.at.axes * Vec3(faces_[i].normal.x(), 0, faces_[i].normal.y())).normalized();
  const Lane zero(0.0);
  for (std::size_t first = 0; first < spheres.size(); first += lane_count) {
    const std::span<const Sphere> some = spheres.subspan(first, std::min(lane_count, spheres.size() - first));
    const RowLanes<Lane> sphere =
        load_fours<Lane>([&](std::size_t k) { return some[std::min(k, some.size() - 1)].centre.data(); });
    const Vec<Lane> from_corner =
        sphere.xyz() - Vec<Lane>{sheet.at.corner.x(), sheet.at.corner.y(), sheet.at.corner.z()};
    const auto along = [&](int axis) {
      return Lane(sheet.at.axes(0, axis)) * from_corner.x + Lane(sheet.at.axes(1, axis)) * from_corner.y +
             Lane(sheet.at.axes(2, axis)) * from_corner.z;
    };
    const Vec<Lane> local{along(0), along(1), along(2)};
    const Vec<Lane> beyond{local.x - min(max(local.x, zero), Lane(sheet_.length_a)),
                           local.y - min(max(local.y, zero), Lane(sheet_.length_b)),
                           local.z - min(max(local.z, Lane(-depth_)), zero)};
    const auto reaches = dot(beyond, beyond) < sphere.w * sphere.w;
    const std::uint32_t reaching = detail::bits(reaches) & ((1u << some.size()) - 1);
    if (reaching == 0) continue;

    const Lane periods = (local.x - Lane(start_)) * Lane(per_spacing_);
    const Lane period([&](std::size_t k) { return std::floor(periods[k]); });
    const auto whole_teeth_only = sphere.w <= Lane(floor_ == 0 ? spacing_ : 0) &&
                                  Lane(2.0) * period - Lane(2.0) > Lane(first_) &&
                                  Lane(2.0) * period + Lane(2.0) < Lane(last_);
    const std::uint32_t together = detail::bits(whole_teeth_only) & reaching;
    std::array<ToothContacts, 3> teeth;  // before, under and after the centres
    if (together != 0)
      add_contacts(sheet,
                   {.x = local.x - (Lane(start_) + period * Lane(spacing_)),
                    .z = local.z,
                    .past_end = beyond.y,
                    .radius = sphere.w},
                   teeth);
    for (std::uint32_t left = reaching; left != 0; left &= left - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(left));
      if ((together >> k & 1u) == 0) {
        add_contacts(sheet.at, some[k], contacts);
        continue;
      }
      for (std::size_t tooth = 0; tooth < teeth.size(); ++tooth) {
        if ((teeth[tooth].lanes >> k & 1u) == 0) continue;
        SurfaceContact& contact = contacts.emplace_back();
        std::memcpy(contact.normal.data(), &teeth[tooth].normal_and_overlap[k], sizeof(Quad));
        contact.body = some[k].body;
        contact.feature = static_cast<std::uint32_t>(2 * (static_cast<int>(period[k]) + static_cast<int>(tooth) - 1));
      }
    }
  }
}

/// One sphere, at any position.
void SawTooth::add_contacts(const Sheet::Frame& at, const Sphere& sphere, std::vector<SurfaceContact>& contacts) const {
  const double squared_radius = sphere.radius * sphere.radius;
  const Vec3 local = at.local(sphere.centre), beyond = this->beyond(local);
  const double past_end = beyond.y();
  const double half_width = std::sqrt(squared_radius - past_end * past_end - beyond.z() * beyond.z());
  const bool over = beyond.x() == 0 && past_end == 0;
  const int own = feature_at(local.x()), last = feature_at(local.x() + half_width);
  for (int feature = feature_at(local.x() - half_width); feature <= last; ++feature) {
    const Closest to = closest(feature, {local.x(), local.z()});
    const double squared = to.squared + past_end * past_end;
    if (!(squared < squared_radius)) continue;
    // The feature under the centre always counts. Others do not where their closest point is in a valley: the
    // neighbour is closer there. Features seen from behind have their closest point in a valley too.
    if (feature != own && to.in_valley) continue;
    const Face& face = *to.face;
    Vec3 away(to.past * face.along.x() + to.above * face.normal.x(), past_end,
              to.past * face.along.y() + to.above * face.normal.y());
    double distance = std::sqrt(squared);
    if (over && to.height < 0) {
      away = {to.highest->normal.x(), 0, to.highest->normal.y()};
      distance = to.height;
    } else if (to.past == 0 && past_end == 0) {  // the offset may be 0
      const double side = to.above < 0 ? -1 : 1;
      away = {side * face.normal.x(), 0, side * face.normal.y()};
    }
    contacts.push_back(
        {-(at.axes * away).normalized(), sphere.radius - distance, sphere.body, static_cast<std::uint32_t>(feature)});
  }
}

/// The same for spheres that reach no further than the whole teeth before, under and after their centres: most grains
/// at a rough wall. Without branches, since those between two flanks are unpredictable.
void SawTooth::add_contacts(const PlacedSheet& sheet, const SphereLanes& spheres,
                            std::array<ToothContacts, 3>& teeth) const {
  static_assert(offsetof(SurfaceContact, overlap) == sizeof(Vec3));
  const Lane zero(0.0), end_squared = spheres.past_end * spheres.past_end;
  const auto over = spheres.past_end == zero;
  for (int tooth = 0; tooth < 3; ++tooth) {
    Lane squared(std::numeric_limits<double>::infinity()), height = -squared, past = zero, above = zero;
    Vec<Lane> away{zero, spheres.past_end, zero}, face_into{}, highest_into{};
    auto in_valley = zero > zero;
    for (std::size_t f = 0; f < 3; ++f) {
      const Face& face = faces_[f];
      if (face.length == 0) continue;
      const Vec<Lane> into{sheet.into[f].x(), sheet.into[f].y(), sheet.into[f].z()};
      const Lane from_x = spheres.x - Lane((tooth - 1) * spacing_ + face.start.x()),
                 from_z = spheres.z - Lane(face.start.y());
      const Lane along = Lane(face.along.x()) * from_x + Lane(face.along.y()) * from_z;
      const Lane off = Lane(face.normal.x()) * from_x + Lane(face.normal.y()) * from_z;
      const Lane beyond = along - min(max(along, zero), Lane(face.length)), square = beyond * beyond + off * off;
      const auto higher = off > height, closer = square < squared;
      height = select(higher, off, height), highest_into = select<Lane>(higher, into, highest_into);
      squared = select(closer, square, squared), past = select(closer, beyond, past),
      above = select(closer, off, above);
      away.x = select(closer, beyond * Lane(face.along.x()) + off * Lane(face.normal.x()), away.x);
      away.z = select(closer, beyond * Lane(face.along.y()) + off * Lane(face.normal.y()), away.z);
      face_into = select<Lane>(closer, into, face_into);
      const auto valley = f == 0 ? beyond < zero : f == 2 ? beyond > zero : zero > zero;
      in_valley = (closer && valley) || (!closer && in_valley);
    }
    squared = squared + end_squared;
    auto touching = squared < spheres.radius * spheres.radius;
    if (tooth != 1) touching = touching && !in_valley;
    ToothContacts& to = teeth[static_cast<std::size_t>(tooth)];
    to.lanes = detail::bits(touching);
    if (to.lanes == 0) continue;

    // On a face the normal of the face is used: the offset may be 0.
    const auto on_face = over && past == zero, behind = over && height < zero;
    Vec<Lane> normal = face_into;
    Lane distance = above;
    if (detail::bits(touching && !on_face) != 0) {
      const auto row = [&](int i) {
        return -(Lane(sheet.at.axes(i, 0)) * away.x + Lane(sheet.at.axes(i, 1)) * away.y +
                 Lane(sheet.at.axes(i, 2)) * away.z);
      };
      const Vec<Lane> towards{row(0), row(1), row(2)};
      const Lane length = sqrt(towards.x * towards.x + towards.y * towards.y + towards.z * towards.z);
      normal = select<Lane>(on_face, normal, {towards.x / length, towards.y / length, towards.z / length});
      distance = select(on_face, distance, sqrt(squared));
    }
    normal = select<Lane>(behind, highest_into, normal);
    distance = select(behind, height, distance);
    store_rows(normal.x, normal.y, normal.z, spheres.radius - distance,
               [&](std::size_t k, const Quad& quad) { to.normal_and_overlap[k] = quad; });
  }
}

bool SawTooth::near(const Pose& pose, const Vec3& centre, double reach) const {
  return beyond(sheet_.at(pose).local(centre)).squaredNorm() <= reach * reach;
}

Bounds SawTooth::bounds() const {
  const Bounds tips = sheet_.bounds();
  const Vec3 down = -depth_ * normal();
  return {tips.low.cwiseMin(tips.low + down), tips.high.cwiseMax(tips.high + down)};
}

std::vector<Vec3> SawTooth::triangles() const {
  std::vector<Vec3> corners;
  for (int feature = first_; feature <= last_; ++feature)
    for (const Face& face : faces(feature)) {
      const auto part = extent(feature, face);
      if (!part) continue;
      const Vec2 start = Vec2(period_start(feature), 0) + face.start, left = start + part->first * face.along,
                 right = start + part->second * face.along;
      const Vec3 a(left.x(), 0, left.y()), b(right.x(), 0, right.y()), along_b(0, sheet_.length_b, 0);
      for (const Vec3& local : {a, b, Vec3(b + along_b), a, Vec3(b + along_b), Vec3(a + along_b)})
        corners.push_back(sheet_.corner + sheet_.axes * local);
    }
  return corners;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "geometry",
                                     .name = "saw-tooth",
                                     .version = "1.0.0",
                                     .doc = "rectangular sheet with straight grooves, solid behind",
                                     .make_geometry = []() -> grit::Geometry* { return new grit::SawTooth; }};
  return &info;
}
