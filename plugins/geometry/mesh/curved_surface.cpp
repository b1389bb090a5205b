#include "curved_surface.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "groups.hpp"

namespace grit {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double negligible = 1e-9;  // overlap over the deepest
constexpr double ridge = 1e-13;      // makes equations of dependent contacts solvable
// β ≥ 30°: a sphere with an overlap of up to a third of its radius has one contact with a flat surface of many facets.
constexpr double least_squared_sine = 0.25;
// A path that keeps half the overlap links two contacts fully: there are valleys between facets of a curved surface.
constexpr double valley_keeps = 0.5;
constexpr double one_side = 0.5;  // links between contacts on one far side
// Facets with this share of the deepest overlap count fully in the span of normals. It must be below 0.5, so that
// facets around a sphere that fills a pipe span 90 degrees, however far it is off the axis.
constexpr double spans = 0.25;
constexpr double balances = 0.1;  // overlap on the far side over the deepest, from which both sides balance
// Overlap over the deepest from which a contact may stand for the near side. Where overlaps are nearly equal all
// around, the choice must not change with each small displacement: friction needs a history.
constexpr double as_good_as_deepest = 0.97;

/// Share of a contact's overlap by which it relieves another whose normal differs by θ: 1 − sin² θ/2 / sin² β.
double relief(const Vec3& away, const Vec3& other, double squared_sine) {
  return std::max(0.0, 1 - (away - other).squaredNorm() / (4 * squared_sine));
}

/// The nonnegative shares for which Σ share · relief ≥ overlap, with equality where the share is positive: the active
/// set of Lawson & Hanson. `relief(i)` is a column of a symmetric matrix.
template <class Relief>
VectorXd shares(const Relief& relief, const VectorXd& overlap) {
  const double slack = negligible * overlap.maxCoeff();
  VectorXd share = VectorXd::Zero(overlap.size());
  std::vector<Index> active;
  std::vector<VectorXd> columns;  // of active ones
  for (Index round = 0; round < 3 * overlap.size(); ++round) {
    VectorXd left = overlap;
    for (std::size_t a = 0; a < active.size(); ++a) left -= share[active[a]] * columns[a];
    for (const Index a : active) left[a] = 0;
    const double most = left.maxCoeff();
    if (!(most > slack)) break;
    // The first of equal ones, whatever their rounding.
    active.push_back(std::ranges::find_if(left, [&](double one) { return one >= most - slack; }) - left.begin());
    columns.push_back(relief(active.back()));
    for (bool falls = true; falls && !active.empty();) {
      const auto count = static_cast<Index>(active.size());
      Eigen::MatrixXd among(count, count);
      for (Index a = 0; a < count; ++a) among.col(a) = columns[as_index(a)](active);
      among.diagonal().array() += ridge;
      const VectorXd from = share(active), to = among.ldlt().solve(overlap(active));
      double part = 1;
      std::ptrdiff_t first = 0;
      falls = false;
      for (Index a = 0; a < count; ++a) {
        if (to[a] > 0) continue;
        const double until = from[a] > 0 ? from[a] / (from[a] - to[a]) : 0;
        if (!falls || until < part) part = until, first = a, falls = true;
      }
      share(active) = from + part * (to - from);
      if (!falls) break;
      share[active[as_index(first)]] = 0;
      active.erase(active.begin() + first), columns.erase(columns.begin() + first);
    }
  }
  return share;
}

/// Linked facets.
class Patch {
 public:
  Patch(std::span<const CurveFacet> facets, std::span<const CurveLink> links, const std::vector<std::uint32_t>& members,
        double smooth_cosine);
  void add_contacts_that_count(std::vector<CurveContact>& found) const;

 private:
  struct Neighbour {
    std::size_t facet;
    double overlap;
  };
  Index size() const { return static_cast<Index>(facets_.size()); }
  CurveContact contact(Index i) const {
    return {facets_[as_index(i)].away, facets_[as_index(i)].overlap, number_[as_index(i)]};
  }
  bool on_one_side(Index i, Index j) const {
    return facets_[as_index(i)].away.dot(facets_[as_index(j)].away) > smooth_cosine_;
  }
  Index first_minimum(double least) const;
  VectorXd reliefs(Index from, double squared_sine) const;
  VectorXd links(Index from) const;
  bool relieves_all(Index near) const;
  double squared_sine_of_span() const;
  std::vector<Vec3> far_sides(Index& near) const;

  std::vector<CurveFacet> facets_;
  std::vector<std::uint32_t> number_;
  std::vector<std::size_t> first_neighbour_;
  std::vector<Neighbour> neighbours_;
  VectorXd overlap_;
  double deepest_, little_, smooth_cosine_;
};

Patch::Patch(std::span<const CurveFacet> facets, std::span<const CurveLink> links,
             const std::vector<std::uint32_t>& members, double smooth_cosine)
    : number_(members),
      first_neighbour_(members.size() + 1, 0),
      neighbours_(2 * links.size()),
      overlap_(static_cast<Index>(members.size())),
      smooth_cosine_(smooth_cosine) {
  for (const std::uint32_t member : members) {
    overlap_[size()] = facets[member].overlap;
    facets_.push_back(facets[member]);
  }
  deepest_ = overlap_.maxCoeff(), little_ = negligible * deepest_;

  const auto place = [&](std::uint32_t member) {
    return static_cast<std::size_t>(std::ranges::lower_bound(members, member) - members.begin());
  };
  for (const CurveLink& link : links) ++first_neighbour_[place(link.a)], ++first_neighbour_[place(link.b)];
  std::size_t end = 0;
  for (std::size_t& first : first_neighbour_) first = end += first;
  for (const CurveLink& link : links) {
    const std::size_t a = place(link.a), b = place(link.b);
    neighbours_[--first_neighbour_[a]] = {b, link.overlap}, neighbours_[--first_neighbour_[b]] = {a, link.overlap};
  }
}

/// The first local minimum of distance with an overlap of at least `least`; the deepest one if there is none.
Index Patch::first_minimum(double least) const {
  const auto deep = [&](const CurveFacet& one) { return one.minimum && one.overlap >= least; };
  const auto first = std::ranges::find_if(facets_, deep);
  if (first != facets_.end()) return first - facets_.begin();
  return std::ranges::max_element(facets_, {},
                                  [](const CurveFacet& one) { return std::pair(one.minimum, one.overlap); }) -
         facets_.begin();
}

VectorXd Patch::reliefs(Index from, double squared_sine) const {
  VectorXd reliefs(size());
  for (Index i = 0; i < size(); ++i)
    reliefs[i] = relief(facets_[as_index(i)].away, facets_[as_index(from)].away, squared_sine);
  return reliefs;
}

/// How well a facet is linked to each, 0 … 1.
VectorXd Patch::links(Index from) const {
  VectorXd least = VectorXd::Zero(size());
  least[from] = overlap_[from];
  std::vector<Index> reached{from};
  for (std::size_t k = 0; k < reached.size(); ++k)
    for (std::size_t n = first_neighbour_[as_index(reached[k])]; n < first_neighbour_[as_index(reached[k]) + 1]; ++n) {
      const auto& [facet, overlap] = neighbours_[n];
      const auto next = static_cast<Index>(facet);
      if (least[next] == 0) least[next] = std::min(least[reached[k]], overlap), reached.push_back(next);
    }
  for (Index i = 0; i < size(); ++i)
    least[i] = std::min(1.0, least[i] / (valley_keeps * std::min(overlap_[i], overlap_[from])));
  return least;
}

/// Whether a contact relieves all that are not on its side.
bool Patch::relieves_all(Index near) const {
  const VectorXd left = overlap_ - overlap_[near] * reliefs(near, least_squared_sine).cwiseProduct(links(near));
  for (Index i = 0; i < size(); ++i)
    if (left[i] > little_ && !on_one_side(i, near)) return false;
  return true;
}

/// sin² β. With equal overlaps and reliefs for 90° the sum of shares is 2 / (1 + cos² β).
double Patch::squared_sine_of_span() const {
  const VectorXd weight = (overlap_ / (spans * deepest_)).cwiseMin(1.0);
  const double sum = shares([&](Index i) { return reliefs(i, 1); }, weight).sum();
  return 1 - std::clamp(2 / sum - 1, 0.0, 1 - least_squared_sine);
}

/// Overlap times direction of each far side, such that the sum with the contact `near`, which may be replaced, is that
/// of all shares.
std::vector<Vec3> Patch::far_sides(Index& near) const {
  const double squared_sine = squared_sine_of_span();
  VectorXd share =
      shares([&](Index i) -> VectorXd { return reliefs(i, squared_sine).cwiseProduct(links(i)); }, overlap_);
  const auto take = [&](auto belongs) {
    Vec3 side = Vec3::Zero();
    for (Index i = 0; i < size(); ++i)
      if (share[i] > 0 && belongs(i)) side += share[i] * facets_[as_index(i)].away, share[i] = 0;
    return side;
  };
  const Vec3 near_side = take([&](Index i) { return on_one_side(i, near); });
  const double far = share.sum();
  std::vector<Vec3> sides;
  for (Index head = 0; share.maxCoeff(&head) > little_;) {
    const VectorXd link = links(head);
    sides.push_back(take([&](Index i) { return link[i] > one_side; }));
  }
  if (sides.empty()) return sides;
  const double balance = std::min(1.0, far / (balances * deepest_));
  if (balance == 1) near = first_minimum(as_good_as_deepest * deepest_);
  sides.front() += balance * (near_side - overlap_[near] * facets_[as_index(near)].away);
  return sides;
}

void Patch::add_contacts_that_count(std::vector<CurveContact>& found) const {
  Index near = first_minimum(deepest_ - little_);
  std::vector<Vec3> sides;
  if (!relieves_all(near)) sides = far_sides(near);
  found.push_back(contact(near));
  std::vector<bool> used(facets_.size(), false);
  used[as_index(near)] = true;
  for (const Vec3& side : sides) {
    const double overlap = side.norm();
    if (!(overlap > little_)) continue;
    const Vec3 away = side / overlap;
    std::size_t facet = 0;
    double closest = -2;
    for (std::size_t i = 0; i < used.size() && closest <= smooth_cosine_; ++i)
      if (const double cosine = away.dot(facets_[i].away); !used[i] && cosine > closest) closest = cosine, facet = i;
    used[facet] = true;
    found.push_back({away, overlap, number_[facet]});
  }
}

}  // namespace

double least_relief(const Vec3& away, const Vec3& other) { return relief(away, other, least_squared_sine); }

std::vector<CurveContact> contacts_that_count(std::span<const CurveFacet> facets, std::span<const CurveLink> links,
                                              double smooth_cosine) {
  Groups groups(facets.size());
  for (const CurveLink& link : links) groups.join(link.a, link.b);
  std::vector<std::vector<std::uint32_t>> members(facets.size());
  std::vector<std::vector<CurveLink>> inner(facets.size());
  for (std::uint32_t i = 0; i < facets.size(); ++i) members[groups.root(i)].push_back(i);
  for (const CurveLink& link : links) inner[groups.root(link.a)].push_back(link);
  std::vector<CurveContact> found;
  const auto minimum = [&](std::uint32_t member) { return facets[member].minimum; };
  for (std::size_t root = 0; root < facets.size(); ++root)
    if (std::ranges::any_of(members[root], minimum))
      Patch(facets, inner[root], members[root], smooth_cosine).add_contacts_that_count(found);
  return found;
}

}  // namespace grit
