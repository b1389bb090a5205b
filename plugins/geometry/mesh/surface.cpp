#include "surface.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iomanip>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <sstream>
#include <tuple>

#include "groups.hpp"
#include "weld.hpp"

namespace grit {
namespace {

constexpr double flat = 1e-10;      // height of a triangle over its longest side below which it has no area
constexpr double rounding = 1e-15;  // relative to coordinates and directions
constexpr double slack_of_radius = 1e-12;
constexpr double one_point = 1e3;  // in slacks: closer points coincide
// Rounding between corners that should coincide: 5e-6 of a coordinate in text of six digits, 6e-8 in floats.
constexpr double no_gap = 1e-5;         // relative to the largest side of the surface
constexpr double long_as_a_seam = 100;  // in gaps: edges that diverge at 0.6 degrees or more are no seam
// Sine of the smallest angle of a valley. At 15 degrees a sphere over one face reaches the rim of the other at an
// overlap of 1 - cos(15 degrees), 3 % of its radius.
constexpr double valley = 0.2588;

std::string text(const Vec3& v) {
  return (std::ostringstream() << '(' << v.x() << ", " << v.y() << ", " << v.z() << ')').str();
}

std::string metres(double length) { return (std::ostringstream() << std::setprecision(2) << length).str(); }

/// A corner of the file in the scene. Negative zeros become positive.
Vec3 placed(const Vec3& corner, const SurfaceOptions& options) {
  const Vec3 scaled = options.scale * corner.cwiseProduct(options.stretch);
  return options.turn * scaled + options.position + Vec3::Zero();
}

/// The normal of a plane of the file in the scene, of any length.
Vec3 placed_normal(const Vec3& normal, const SurfaceOptions& options) {
  return options.turn * normal.cwiseQuotient(options.stretch);
}

/// Place of a number among numbers in ascending order.
std::optional<std::uint32_t> place(const std::vector<std::uint32_t>& numbers, std::uint32_t number) {
  const auto found = std::ranges::lower_bound(numbers, number);
  if (found == numbers.end() || *found != number) return {};
  return static_cast<std::uint32_t>(found - numbers.begin());
}

}  // namespace

Surface::Surface(const Stl& stl, const SurfaceOptions& options)
    : defects_(stl.defects), smooth_cosine_(std::cos(options.feature_angle)), two_sided_(options.two_sided) {
  if (!defects_.empty()) return;
  merge_corners(stl, options);
  span_facets(stl, options);
  join_edges(stl, options);
  if (!defects_.empty()) return;
  if (closed_ && oriented_ && !two_sided_) check_volumes(options.inside);
  find_regions();
  gather_corners();

  bounds_ = {vertices_.front().position, vertices_.front().position};
  std::vector<std::pair<Bounds, std::uint32_t>> boxes;
  double total_area = 0;
  for (std::uint32_t f = 0; f < facets_.size(); ++f) {
    if (facets_[f].skipped) continue;
    const Vec3 &a = corner(facets_[f], 0), &b = corner(facets_[f], 1), &c = corner(facets_[f], 2);
    const Vec3 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    boxes.push_back({{low, high}, f});
    bounds_ = {bounds_.low.cwiseMin(low), bounds_.high.cwiseMax(high)};
    area_vector_ += 0.5 * (b - a).cross(c - a);
    total_area += 0.5 * (b - a).cross(c - a).norm();
  }
  index_.emplace(boxes);
  size_ = std::max(bounds_.low.cwiseAbs().maxCoeff(), bounds_.high.cwiseAbs().maxCoeff());
  if (!closed_) check_seams();
  // For a tube it is zero except for rounding of the corners.
  if (closed_ || !oriented_ || area_vector_.norm() <= 1e-6 * total_area) area_vector_.setZero();
}

/// Numbers the corners; merged corners get the number of the first of them.
void Surface::merge_corners(const Stl& stl, const SurfaceOptions& options) {
  Weld weld(options.merge_distance);
  for (const Stl::Facet& facet : stl.facets) {
    Facet& mine = facets_.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) mine.corners[i] = weld.number(placed(facet.corners[i], options));
    if (options.inside) std::swap(mine.corners[1], mine.corners[2]);
  }
  for (const Vec3& point : weld.points()) vertices_.push_back({.position = point});
}

/// Normals; facets without one, and those with a contradicting normal in the file.
void Surface::span_facets(const Stl& stl, const SurfaceOptions& options) {
  std::vector<std::size_t> degenerate, against;
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    Facet& facet = facets_[f];
    std::array<Vec3, 3> side;
    double longest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      side[i] = corner(facet, (i + 1) % 3) - corner(facet, i);
      longest = std::max(longest, side[i].norm());
    }
    const Vec3 twice_area = side[0].cross(side[1]);
    facet.skipped = !(twice_area.norm() > flat * longest * longest);
    if (facet.skipped) {
      degenerate.push_back(f);
      continue;
    }
    facet.normal = twice_area.normalized();
    for (std::size_t i = 0; i < 3; ++i) facet.inward[i] = facet.normal.cross(side[i]).normalized();
    if ((options.inside ? -1 : 1) * facet.normal.dot(placed_normal(stl.facets[f].normal, options)) < 0)
      against.push_back(f);
  }
  if (!degenerate.empty() && !options.skip_degenerate)
    defects_.push_back({"degenerate facets, without area: " + facet_numbers(degenerate),
                        "facets whose corners span an area; repair the file, or set \"skip_degenerate\": true to skip "
                        "them"});
  if (degenerate.size() == facets_.size() && options.skip_degenerate)
    defects_.push_back({"degenerate facets only", "at least one facet that has an area"});
  if (!against.empty() && !options.ignore_normals)
    defects_.push_back({"facets whose order of corners contradicts the normal in the file: " + facet_numbers(against),
                        "corners that are counter-clockwise as seen from the tip of the normal; repair the file, or "
                        "set \"ignore_normals\": true if the corners are right"});
}

/// Edges; defects where an edge does not join two facets of the same orientation.
void Surface::join_edges(const Stl& stl, const SurfaceOptions& options) {
  struct Entry {
    std::uint32_t from, to;
    Side side;
  };
  std::vector<Entry> entries;
  for (std::uint32_t f = 0; f < facets_.size(); ++f)
    for (std::uint32_t i = 0; i < 3 && !facets_[f].skipped; ++i) {
      const auto [low, high] = std::minmax(facets_[f].corners[i], facets_[f].corners[(i + 1) % 3]);
      entries.push_back({low, high, {f, i}});
    }
  std::ranges::sort(entries, {}, [](const Entry& e) { return std::tuple(e.from, e.to, e.side.facet, e.side.edge); });

  std::vector<std::size_t> single, crowded;
  std::string first_single;
  for (std::size_t i = 0; i < entries.size();) {
    const auto [from, to, first] = entries[i];
    const auto number = static_cast<std::uint32_t>(edges_.size()), begin = static_cast<std::uint32_t>(sides_.size());
    const Vec3 along = vertices_[to].position - vertices_[from].position;
    Edge edge{from, to, begin, begin, along.normalized()};
    edge.length = along.norm();
    int forwards = 0;
    for (; i < entries.size() && entries[i].from == from && entries[i].to == to; ++i, ++edge.end_side) {
      const Side& side = entries[i].side;
      Facet& facet = facets_[side.facet];
      facet.edges[side.edge] = number;
      forwards += facet.corners[side.edge] == from;
      edge.normal += facet.normal;
      sides_.push_back(side);
    }
    const std::uint32_t sides = edge.end_side - begin;
    edge.rim = sides == 1;
    edges_.push_back(edge);
    if (edge.rim) {
      if (single.empty()) first_single = text(vertices_[from].position) + " to " + text(vertices_[to].position);
      single.push_back(first.facet);
    }
    if (sides > 2)
      for (std::uint32_t k = begin; k < edge.end_side; ++k) crowded.push_back(sides_[k].facet);
    edges_.back().turns = sides == 2 && forwards != 1;
  }
  std::ranges::sort(single), std::ranges::sort(crowded);
  crowded.erase(std::unique(crowded.begin(), crowded.end()), crowded.end());
  const auto turned = inverted();
  closed_ = single.empty(), oriented_ = crowded.empty() && turned.empty();

  if (!closed_ && !options.open)
    defects_.push_back(
        {"an open surface: " + std::to_string(single.size()) + " edges with one facet only, the first from " +
             first_single + " m, of facets " + facet_numbers(single),
         "a closed surface; " + how_to_close(stl, options) + ", or set \"open\": true if it is a sheet"});
  if (!crowded.empty() && !two_sided_)
    defects_.push_back(
        {"edges shared by more than two facets, of facets " + facet_numbers(crowded),
         "two facets per edge; repair the file, or set \"two_sided\": true where bodies may be on either "
         "side of sheets that meet"});
  if (!turned.empty() && !two_sided_)
    defects_.push_back(
        {"inverted facets, oriented against most of their neighbours: " + facet_numbers(turned),
         "facets that all face outwards; repair the file, or set \"two_sided\": true if bodies may be on "
         "either side"});
}

/// What to do about free edges.
std::string Surface::how_to_close(const Stl& stl, const SurfaceOptions& options) const {
  std::vector<Segment> free, all;
  for (const Edge& edge : edges_)
    if (edge.rim) free.push_back({vertices_[edge.from].position, vertices_[edge.to].position});
  for (std::size_t f = 0; f < facets_.size(); ++f)
    for (std::size_t i = 0; i < 3 && !facets_[f].skipped; ++i)
      all.push_back({placed(stl.facets[f].corners[i], options), placed(stl.facets[f].corners[(i + 1) % 3], options)});
  if (const auto distance = closing_distance(free, all, two_sided_))
    return "set \"merge_distance\" to " + metres(*distance) + " m, which closes it";
  return "close it (no \"merge_distance\" does)";
}

/// For each facet the lowest number in its group; groups are joined by edges of two facets for which `joins` holds.
template <class Joins>
std::vector<std::uint32_t> Surface::groups(Joins joins) const {
  Groups groups(facets_.size());
  for (const Edge& edge : edges_) {
    if (edge.end_side - edge.first_side != 2) continue;
    const std::uint32_t a = sides_[edge.first_side].facet, b = sides_[edge.first_side + 1].facet;
    if (joins(edge, facets_[a], facets_[b])) groups.join(a, b);
  }
  std::vector<std::uint32_t> group(facets_.size());
  for (std::uint32_t f = 0; f < group.size(); ++f) group[f] = groups.root(f);
  return group;
}

/// Facets oriented against most of those to which they are joined.
std::vector<std::size_t> Surface::inverted() const {
  const auto part = groups([](auto&&...) { return true; }),
             facing = groups([](const Edge&edge, auto&&...) { return !edge.turns; });
  std::vector<std::uint32_t> count(facets_.size()), most(facets_.size(), ~0u);  // by group
  for (const std::uint32_t group : facing) ++count[group];
  for (std::size_t f = 0; f < facets_.size(); ++f)
    if (std::uint32_t& best = most[part[f]]; best == ~0u || count[facing[f]] > count[best]) best = facing[f];
  std::vector<std::size_t> facets;
  for (std::size_t f = 0; f < facets_.size(); ++f)
    if (facing[f] != most[part[f]]) facets.push_back(f);
  return facets;
}

/// Closed parts must enclose a positive volume, unless they are a cavity in another part.
void Surface::check_volumes(bool inside) {
  struct Part {
    Bounds bounds;
    double volume = 0;
    std::vector<std::size_t> facets;
  };
  std::map<std::uint32_t, Part> parts;
  const auto group = groups([](auto&&...) { return true; });
  const double outwards = inside ? -1 : 1;
  for (std::uint32_t f = 0; f < facets_.size(); ++f) {
    if (facets_[f].skipped) continue;
    const Vec3 &a = corner(facets_[f], 0), &b = corner(facets_[f], 1), &c = corner(facets_[f], 2);
    Part& part = parts[group[f]];
    if (part.facets.empty()) part.bounds = {a, a};
    const Vec3 from = corner(facets_[group[f]], 0);
    part.volume += outwards * (a - from).dot((b - from).cross(c - from)) / 6;
    part.bounds = {part.bounds.low.cwiseMin(a).cwiseMin(b).cwiseMin(c),
                   part.bounds.high.cwiseMax(a).cwiseMax(b).cwiseMax(c)};
    part.facets.push_back(f);
  }
  for (const auto& [first, part] : parts) {
    const auto holds = [&part = part](const auto& other) {
      return other.second.volume > 0 && (other.second.bounds.low.array() < part.bounds.low.array()).all() &&
             (other.second.bounds.high.array() > part.bounds.high.array()).all();
    };
    if (part.volume < 0 && std::ranges::none_of(parts, holds))
      defects_.push_back({"a closed surface that faces inwards: facets " + facet_numbers(part.facets),
                          "facets that face outwards; reverse them. For bodies inside such a surface also set "
                          "\"inside\": true"});
  }
}

/// Curved surfaces: regions of facets, and of edges and corners within one. Edges between the same two regions form a
/// curve.
void Surface::find_regions() {
  const auto group = groups([&](const Edge& edge, const Facet& a, const Facet& b) {
    return (edge.turns ? -1 : 1) * a.normal.dot(b.normal) > smooth_cosine_;
  });
  region_.assign(group.begin(), group.end());
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> curves;
  for (Edge& edge : edges_) {
    std::set<std::int32_t> regions;
    for (std::uint32_t s = edge.first_side; s < edge.end_side; ++s) regions.insert(region_[sides_[s].facet]);
    const auto next = static_cast<std::int32_t>(facets_.size() + curves.size());
    if (regions.size() == 1) edge.region = *regions.begin();
    if (regions.size() == 2)
      edge.region = curves.try_emplace({*regions.begin(), *regions.rbegin()}, next).first->second;
  }
}

/// Normal, lowest facet and edges of each corner.
void Surface::gather_corners() {
  constexpr std::int32_t unknown = -2;
  for (std::uint32_t f = 0; f < facets_.size(); ++f) {
    const Facet& facet = facets_[f];
    if (facet.skipped) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      Vertex& vertex = vertices_[facet.corners[i]];
      const Vec3 a = (corner(facet, (i + 1) % 3) - vertex.position).normalized(),
                 b = (corner(facet, (i + 2) % 3) - vertex.position).normalized();
      vertex.normal += std::atan2(a.cross(b).norm(), a.dot(b)) * facet.normal;
      vertex.owner = std::min(vertex.owner, f);
      vertex.region = vertex.region == unknown || vertex.region == region_[f] ? region_[f] : -1;
    }
  }
  for (const Edge& edge : edges_) ++vertices_[edge.from].end_edge, ++vertices_[edge.to].end_edge;
  std::uint32_t next = 0;
  for (Vertex& vertex : vertices_)
    vertex.first_edge = std::exchange(next, next + vertex.end_edge), vertex.end_edge = vertex.first_edge;
  vertex_edges_.resize(next);
  for (std::uint32_t e = 0; e < edges_.size(); ++e)
    for (Vertex* vertex : {&vertices_[edges_[e].from], &vertices_[edges_[e].to]})
      vertex_edges_[vertex->end_edge++] = e, vertex->rim = vertex->rim || edges_[e].rim;
  for (Vertex& vertex : vertices_) {
    if (vertex.region != -1) continue;
    std::set<std::int32_t> curves;
    for (std::uint32_t e = vertex.first_edge; e < vertex.end_edge; ++e)
      if (const std::int32_t region = edges_[vertex_edges_[e]].region; !is_surface(region)) curves.insert(region);
    if (curves.size() == 1) vertex.region = *curves.begin();
  }
}

/// Rims that lie on other facets are defects: corners were not merged, or a facet ends on the middle of another.
void Surface::check_seams() {
  const double gap = no_gap * (bounds_.high - bounds_.low).maxCoeff();
  std::vector<std::uint32_t> near;
  std::vector<std::size_t> facets;
  std::optional<Seam> first;
  double merge = 0;
  bool split = false;
  for (const Edge& edge : edges_) {
    if (!edge.rim) continue;
    const Side& side = sides_[edge.first_side];
    const Vec3 &a = vertices_[edge.from].position, &b = vertices_[edge.to].position;
    index_->intersecting({a.cwiseMin(b) - Vec3::Constant(gap), a.cwiseMax(b) + Vec3::Constant(gap)}, near);
    for (const std::uint32_t other : near) {
      const auto found = seam(side, other, gap);
      if (!found) continue;
      facets.insert(facets.end(), {side.facet, other});
      if (!first) first = found;
      if (found->mergeable) merge = std::max(merge, found->gap);
      else split = true;
    }
  }
  if (!first) return;
  std::ranges::sort(facets);
  facets.erase(std::ranges::unique(facets).begin(), facets.end());
  std::string remedy;
  if (merge > 0) remedy = "set \"merge_distance\" to " + metres(1.1 * merge) + " m or more, to merge corners";
  if (split)
    remedy +=
        std::string(remedy.empty() ? "" : ", and ") + "split facets in the file at corners of others that lie on them";
  defects_.push_back(
      {"edges with one facet only that lie on other facets, where a body would have two contacts: the first "
       "of facet " +
           std::to_string(first->facet + 1) + " on facet " + std::to_string(first->other + 1) + ", from " +
           text(first->from) + " to " + text(first->to) + " m, " + metres(first->gap) + " m apart; of facets " +
           facet_numbers(facets),
       "facets that share their common edges; " + remedy});
}

/// Where a facet's rim lies within `gap` of another facet over some length, and a sphere would have two contacts where
/// a joined surface has one: everywhere but in sharp valleys.
std::optional<Surface::Seam> Surface::seam(const Side& side, std::uint32_t number, double gap) const {
  const Facet &facet = facets_[side.facet], &other = facets_[number];
  const Edge& edge = edges_[facet.edges[side.edge]];

  // The part of the edge over the other facet; first by projection on the edge.
  const Vec3& start = vertices_[edge.from].position;
  const auto along = [&](std::size_t i) { return edge.along.dot(corner(other, i) - start); };
  double from = std::max(0.0, std::min({along(0), along(1), along(2)})),
         to = std::min(edge.length, std::max({along(0), along(1), along(2)}));
  const auto clip = [&](double at_start, double slope) {  // to at_start + slope x ≥ −gap
    if (slope > 0) from = std::max(from, (-gap - at_start) / slope);
    else if (slope < 0) to = std::min(to, (-gap - at_start) / slope);
    else if (at_start < -gap) to = from;
  };
  for (const double sign : {1.0, -1.0}) clip(sign * height(other, start), sign * other.normal.dot(edge.along));
  for (std::uint32_t i = 0; i < 3; ++i) clip(inside_edge({number, i}, start), other.inward[i].dot(edge.along));
  if (!(to - from > long_as_a_seam * gap)) return {};

  const auto at = [&](double fraction) -> Vec3 { return start + (from + fraction * (to - from)) * edge.along; };
  std::uint32_t nearest = 0;
  for (std::uint32_t i = 1; i < 3; ++i)
    if (inside_edge({number, i}, at(0.5)) < inside_edge({number, nearest}, at(0.5))) nearest = i;
  const Vec3 &mine = facet.inward[side.edge], &its = other.inward[nearest];
  const bool at_its_edge = inside_edge({number, nearest}, at(0.5)) <= gap;
  // Facets that share a corner in a fan of narrow ones.
  const auto has = [&](std::uint32_t corner) { return std::ranges::count(other.corners, corner) > 0; };
  if (at_its_edge && (has(edge.from) || has(edge.to)) && mine.dot(its) > 0.5) return {};

  const double rises = other.normal.dot(mine);
  if (at_its_edge && edges_[other.edges[nearest]].rim) {
    // Seen from the other side a valley is a convex edge.
    if (!two_sided_ && rises >= valley && facet.normal.dot(its) >= valley && mine.dot(its) > -smooth_cosine_) return {};
  } else if ((two_sided_ ? std::abs(rises) : rises) >= valley) {
    return {};  // it stands on the front of the other
  }

  double farthest = 0;  // distance of the edge's ends from the other's corners
  for (const std::uint32_t end : {edge.from, edge.to}) {
    double closest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i)
      closest = std::min(closest, (corner(other, i) - vertices_[end].position).norm());
    farthest = std::max(farthest, closest);
  }
  const bool mergeable = farthest <= 2 * gap;
  double apart = mergeable ? farthest : std::max(distance(number, at(0.25)), distance(number, at(0.75)));
  if (apart <= one_point * rounding * size_) apart = 0;
  return Seam{side.facet, number, at(0), at(1), apart, mergeable};
}

std::vector<Vec3> Surface::triangles() const {
  std::vector<Vec3> corners;
  for (const Facet& facet : facets_)
    for (std::size_t i = 0; i < 3; ++i) corners.push_back(corner(facet, facet.skipped ? 0 : i));
  return corners;
}

double Surface::inside_edge(const Side& side, const Vec3& centre) const {
  const Facet& facet = facets_[side.facet];
  return facet.inward[side.edge].dot(centre - corner(facet, side.edge));
}

/// Adds the closest points on one facet that are local minima of the distance from a centre.
void Surface::closest_of(std::uint32_t number, const Vec3& centre, double radius, std::vector<Nearest>& found) const {
  const Facet& facet = facets_[number];
  const double height = this->height(facet, centre), slack = slack_of_radius * radius + rounding * size_;
  if (!(std::abs(height) < radius)) return;
  std::array<double, 3> inside;
  for (std::uint32_t i = 0; i < 3; ++i) inside[i] = inside_edge({number, i}, centre);
  if (std::ranges::all_of(inside, [&](double distance) { return distance >= -slack; })) {
    found.push_back({.away = height < 0 ? Vec3(-facet.normal) : facet.normal,
                     .distance = std::abs(height),
                     .behind = !two_sided_ && height < 0,
                     .feature = features_per_facet * number,
                     .region = region_[number]});
    return;
  }
  const auto add = [&](const Vec3& point, const auto& of, std::uint32_t feature) {
    const Vec3 away = centre - point;
    const double distance = away.norm();
    if (!(distance < radius)) return;
    found.push_back({.away = (distance > 0 ? away : of.normal).normalized(),
                     .distance = distance,
                     .behind = !two_sided_ && !of.rim && away.dot(of.normal) < 0,
                     .feature = features_per_facet * number + feature,
                     .region = of.region});
  };
  for (std::uint32_t i = 0; i < 3; ++i) {
    const Edge& edge = edges_[facet.edges[i]];
    const Vertex& vertex = vertices_[facet.corners[i]];
    if (sides_[edge.first_side].facet == number && touches_edge(edge, centre, slack))
      add(vertices_[edge.from].position + edge.along.dot(centre - vertices_[edge.from].position) * edge.along, edge,
          1 + i);
    if (vertex.owner == number && touches_vertex(vertex, centre, slack)) add(vertex.position, vertex, 4 + i);
  }
}

/// Whether the inner part of an edge is the closest point of all its facets.
bool Surface::touches_edge(const Edge& edge, const Vec3& centre, double slack) const {
  const double along = edge.along.dot(centre - vertices_[edge.from].position);
  if (!(along > 0 && along < edge.length)) return false;
  for (std::uint32_t s = edge.first_side; s < edge.end_side; ++s)
    if (inside_edge(sides_[s], centre) > slack) return false;
  return true;
}

/// Whether a corner is the closest point of all its edges.
bool Surface::touches_vertex(const Vertex& vertex, const Vec3& centre, double slack) const {
  const Vec3 away = centre - vertex.position;
  for (std::uint32_t e = vertex.first_edge; e < vertex.end_edge; ++e) {
    const Edge& edge = edges_[vertex_edges_[e]];
    const double along = edge.along.dot(away);
    if ((&vertices_[edge.from] == &vertex ? along : -along) > slack) return false;
  }
  return true;
}

void Surface::nearest(const Vec3& centre, double radius, std::vector<std::uint32_t>& facets,
                      std::vector<Nearest>& found) const {
  facets_near(centre, radius, facets);
  found.clear();
  for (const std::uint32_t facet : facets) closest_of(facet, centre, radius, found);
  if (found.size() > 1) remove_duplicates(centre, radius, found);
  if (found.empty()) return;
  const auto closest = std::ranges::min_element(found, {}, &Nearest::distance);
  if (closest->behind) {
    Nearest only = *closest;
    only.away = -only.away, only.distance = -only.distance;
    found.assign(1, only);
    return;
  }
  std::erase_if(found, [](const Nearest& one) { return one.behind; });
  if (found.size() > 1) keep_those_that_count(centre, radius, facets, found);
  std::ranges::sort(found, {}, &Nearest::feature);
}

/// Removes points found twice within tolerances: a facet precedes an edge, an edge a corner.
void Surface::remove_duplicates(const Vec3& centre, double radius, std::vector<Nearest>& found) const {
  const double same = one_point * (slack_of_radius * radius + rounding * size_);
  const auto point = [&](const Nearest& one) -> Vec3 { return centre - one.distance * one.away; };
  std::ranges::sort(found, {}, [](const Nearest& one) {
    const std::uint32_t kind = (one.feature % features_per_facet + 2) / 3;
    return std::tuple(kind, one.feature);
  });
  std::size_t kept = 0;
  for (const Nearest& one : found) {
    const auto end = found.begin() + static_cast<std::ptrdiff_t>(kept);
    if (std::none_of(found.begin(), end,
                     [&](const Nearest& other) { return (point(other) - point(one)).norm() <= same; }))
      found[kept++] = one;
  }
  found.resize(kept);
}

/// On each curved surface keeps the contacts that count.
void Surface::keep_those_that_count(const Vec3& centre, double radius, const std::vector<std::uint32_t>& facets,
                                    std::vector<Nearest>& found) const {
  std::ranges::sort(found, {}, [](const Nearest& one) { return std::tuple(one.region, one.distance, one.feature); });
  std::vector<Nearest> more;
  auto kept = found.begin();
  for (auto begin = found.begin(), end = begin; begin != found.end(); begin = end) {
    const auto elsewhere = [&](const Nearest& other) { return other.region != begin->region; };
    end = begin->region < 0 ? begin + 1 : std::find_if(begin, found.end(), elsewhere);
    const std::span<Nearest> minima(begin, end);
    if (closest_relieves_all(minima, radius)) *kept++ = *begin;
    else add_contacts_that_count(centre, radius, facets, minima, more);
  }
  found.erase(kept, found.end());
  found.insert(found.end(), more.begin(), more.end());
}

/// Whether each other contact is on the side of the closest one, or relieved by it entirely and within a feature angle
/// of a closer one. `minima` are in ascending order of distance.
bool Surface::closest_relieves_all(std::span<const Nearest> minima, double radius) const {
  for (std::size_t i = 1; i < minima.size(); ++i) {
    const auto within = [&](const Nearest& closer) { return closer.away.dot(minima[i].away) > smooth_cosine_; };
    if (within(minima[0])) continue;
    const double relief = least_relief(minima[0].away, minima[i].away);
    if (radius - minima[i].distance > relief * (radius - minima[0].distance)) return false;
    if (std::ranges::none_of(minima.first(i), within)) return false;
  }
  return true;
}

/// Adds the contacts that count with the curved surface, or curve, that has these minima.
void Surface::add_contacts_that_count(const Vec3& centre, double radius, const std::vector<std::uint32_t>& facets,
                                      std::span<Nearest> minima, std::vector<Nearest>& found) const {
  const std::int32_t region = minima.front().region;
  std::vector<CurveFacet> touching;
  std::vector<std::uint32_t> numbers, features;  // of these facets, in ascending order
  const auto add = [&](std::uint32_t facet, std::uint32_t feature, const CurveFacet& one) {
    numbers.push_back(facet), features.push_back(feature), touching.push_back(one);
  };
  std::ranges::sort(minima, {}, &Nearest::feature);
  auto minimum = minima.begin();
  for (const std::uint32_t f : facets) {
    const bool owner = minimum != minima.end() && minimum->feature / features_per_facet == f;
    for (; minimum != minima.end() && minimum->feature / features_per_facet == f; ++minimum)
      add(f, minimum->feature, {minimum->away, radius - minimum->distance, true});
    if (owner || region_[f] != region) continue;
    const auto rim = closest_on_rim(f, centre);
    const double height = this->height(facets_[f], centre), distance = rim ? rim->from.norm() : std::abs(height);
    const bool behind = !rim && !two_sided_ && height < 0, elsewhere = rim && rim->region != region;
    if (behind || elsewhere || !(distance > 0 && distance < radius)) continue;
    const Vec3 from = rim ? rim->from : height * facets_[f].normal;
    add(f, features_per_facet * f, {from / distance, radius - distance, false});
  }
  for (const CurveContact& one : contacts_that_count(touching, links(touching, numbers), smooth_cosine_))
    found.push_back({.away = one.away,
                     .distance = radius - one.overlap,
                     .behind = false,
                     .feature = features[one.facet],
                     .region = region});
}

/// Paths lead over facets that share an edge, and between local minima whose normals differ by less than the feature
/// angle.
std::vector<CurveLink> Surface::links(std::span<const CurveFacet> touching,
                                      const std::vector<std::uint32_t>& numbers) const {
  std::vector<CurveLink> links;
  Groups groups(touching.size());
  std::vector<std::uint32_t> order(touching.size()), minima;
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, std::greater(), [&](std::uint32_t i) { return touching[i].overlap; });
  std::vector<bool> reached(touching.size(), false);
  // In descending order of overlap, groups of facets join at the best place between them.
  for (const std::uint32_t i : order) {
    const auto join = [&](std::uint32_t other) {
      if (groups.join(i, other)) links.push_back({i, other, touching[i].overlap});
    };
    const Facet& facet = facets_[numbers[i]];
    reached[i] = true;
    for (const std::uint32_t e : facet.edges)
      for (std::uint32_t s = edges_[e].first_side; s < edges_[e].end_side; ++s) {
        const std::uint32_t number = sides_[s].facet;
        const double cosine = (edges_[e].turns ? -1 : 1) * facet.normal.dot(facets_[number].normal);
        if (number == numbers[i] || cosine <= smooth_cosine_) continue;
        if (const auto other = place(numbers, number); other && reached[*other]) join(*other);
      }
    if (!touching[i].minimum) continue;
    for (const std::uint32_t other : minima)
      if (touching[i].away.dot(touching[other].away) > smooth_cosine_) join(other);
    minima.push_back(i);
  }
  return links;
}

bool Surface::near(const Vec3& centre, double reach) const {
  std::vector<std::uint32_t> facets;
  facets_near(centre, reach, facets);
  return std::ranges::any_of(facets, [&](std::uint32_t f) { return distance(f, centre) <= reach; });
}

double Surface::distance(std::uint32_t number, const Vec3& centre) const {
  const auto rim = closest_on_rim(number, centre);
  return rim ? rim->from.norm() : std::abs(height(facets_[number], centre));
}

/// The closest point on the edges of a facet; nothing if the centre is above the facet.
std::optional<Surface::OnRim> Surface::closest_on_rim(std::uint32_t number, const Vec3& centre) const {
  std::optional<OnRim> closest;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < 3; ++i) {
    if (inside_edge({number, i}, centre) > 0) continue;
    const Edge& edge = edges_[facets_[number].edges[i]];
    const Vec3 start = centre - vertices_[edge.from].position;
    const double along = edge.along.dot(start);
    const Vec3 from = start - std::clamp(along, 0.0, edge.length) * edge.along;
    if (from.squaredNorm() >= least) continue;
    least = from.squaredNorm();
    const bool inner = along > 0 && along < edge.length;
    closest = {from, inner ? edge.region : vertices_[along > 0 ? edge.to : edge.from].region};
  }
  return closest;
}

}  // namespace grit
