#include "linear_chains.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <unordered_map>

namespace grit {

namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t shortest = 3;

/// What a grain bears, and the next one on either side of it.
struct Grain {
  std::uint32_t name = none;                                        ///< least id of its bodies
  double volume = 0;                                                ///< m³
  Mat3 load = Mat3::Zero();                                         ///< Σ f ⊗ arm, compression positive [N m]
  double major = 0;                                                 ///< Pa
  Vec3 direction = Vec3::Zero();                                    ///< of the major stress, unit
  std::array<std::uint32_t, 2> next{none, none}, link{none, none};  ///< by side: grain and contact

  bool has_both() const { return next[0] != none && next[1] != none; }
};

std::vector<Grain> bearing_grains(const World& world, const std::vector<std::uint32_t>& of_body, std::size_t count) {
  std::vector<Grain> grains(count);
  const auto positions = world.positions();
  const auto shares = world.volume_fractions();
  const auto arms = world.arms();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    Grain& grain = grains[of_body[i]];
    const double radius = positions[i].w;
    grain.name = std::min(grain.name, world.ids()[i]);
    grain.volume += (shares.empty() ? 1 : shares[i]) * 4 / 3 * std::numbers::pi * radius * radius * radius;
  }
  const auto arm = [&](std::uint32_t body) -> Vec3 { return arms.empty() ? Vec3::Zero() : arms[body]; };
  for (const Contact& contact : world.contacts()) {
    const Vec3 point =
        contact.with_wall ? contact.branch : (positions[contact.a].w - 0.5 * contact.overlap) * contact.normal;
    grains[of_body[contact.a]].load += contact.force * (arm(contact.a) + point).transpose();
    if (contact.with_wall) continue;
    grains[of_body[contact.b]].load -= contact.force * (arm(contact.b) + point - contact.branch).transpose();
  }
  for (Grain& grain : grains) {
    const Mat3 stress = 0.5 / grain.volume * (grain.load + grain.load.transpose());
    if (!stress.allFinite()) continue;  // a run that has failed
    const Eigen::SelfAdjointEigenSolver<Mat3> principal(stress);
    grain.major = principal.eigenvalues()[2], grain.direction = principal.eigenvectors().col(2);
  }
  return grains;
}

}  // namespace

LinearChains linear_chains(const World& world, double angle) {
  const Grains places = grains_of(world);
  std::vector<Grain> grains = bearing_grains(world, places.of_body, places.centre.size());
  const auto contacts = world.contacts();
  LinearChains chains;
  chains.of_contact.assign(contacts.size(), 0);
  if (grains.empty()) return chains;
  for (const Grain& grain : grains) chains.mean_major_stress += grain.major / static_cast<double>(grains.size());

  struct Link {
    std::uint32_t contact, a, b;
    int side_a, side_b;
    double force;
  };
  std::vector<Link> links;
  for (std::uint32_t k = 0; k < contacts.size() && !contacts[k].with_wall; ++k) {
    const std::uint32_t a = places.of_body[contacts[k].a], b = places.of_body[contacts[k].b];
    if (!(grains[a].major > chains.mean_major_stress && grains[b].major > chains.mean_major_stress)) continue;
    const Vec3 line = branch_of(world, contacts[k]).vector.normalized();
    const double at_a = line.dot(grains[a].direction), at_b = -line.dot(grains[b].direction);
    if (!(std::min(std::abs(at_a), std::abs(at_b)) >= std::cos(angle))) continue;
    links.push_back({k, a, b, at_a > 0 ? 1 : 0, at_b > 0 ? 1 : 0, contacts[k].normal_force});
  }
  std::ranges::stable_sort(links, [](const Link& one, const Link& other) { return one.force > other.force; });
  for (const Link& link : links) {
    Grain &a = grains[link.a], &b = grains[link.b];
    const auto side_a = static_cast<std::size_t>(link.side_a), side_b = static_cast<std::size_t>(link.side_b);
    if (a.next[side_a] != none || b.next[side_b] != none) continue;
    a.next[side_a] = link.b, a.link[side_a] = link.contact;
    b.next[side_b] = link.a, b.link[side_b] = link.contact;
  }

  std::vector<bool> seen(grains.size());
  const auto follow = [&](std::uint32_t first) {
    std::vector<std::uint32_t> names, way;
    for (std::uint32_t at = first, link = none; at != none && !seen[at];) {
      seen[at] = true, names.push_back(grains[at].name);
      const auto& links_here = grains[at].link;
      const auto on = std::ranges::find_if(links_here, [&](std::uint32_t l) { return l != none && l != link; });
      if (on == links_here.end()) break;
      way.push_back(link = *on);
      at = grains[at].next[static_cast<std::size_t>(on - links_here.begin())];
    }
    if (names.size() < shortest) return;
    chains.grains.push_back(std::move(names));
    for (const std::uint32_t link : way) chains.of_contact[link] = static_cast<std::uint32_t>(chains.grains.size());
  };
  const auto count = static_cast<std::uint32_t>(grains.size());
  for (std::uint32_t i = 0; i < count; ++i)
    if (!seen[i] && !grains[i].has_both()) follow(i);
  for (std::uint32_t i = 0; i < count; ++i)  // what is left closes upon itself
    if (!seen[i]) follow(i);
  return chains;
}

Turnover turnover(const LinearChains& before, const LinearChains& after) {
  std::unordered_map<std::uint32_t, std::size_t> chain_of;
  for (std::size_t k = 0; k < after.grains.size(); ++k)
    for (const std::uint32_t grain : after.grains[k]) chain_of[grain] = k;
  std::vector<bool> is_old(after.grains.size());
  Turnover change;
  for (const auto& chain : before.grains) {
    std::unordered_map<std::size_t, std::size_t> shared;
    for (const std::uint32_t grain : chain)
      if (const auto found = chain_of.find(grain); found != chain_of.end()) ++shared[found->second];
    bool lives = false;
    for (const auto& [k, grains] : shared)
      if (grains >= 2 && 2 * grains >= chain.size()) lives = is_old[k] = true;
    change.died += lives ? 0 : 1;
  }
  change.born = static_cast<std::size_t>(std::ranges::count(is_old, false));
  return change;
}

}  // namespace grit
