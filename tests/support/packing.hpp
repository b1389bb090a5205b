// Dense packings at once, for tests that need many contacts and no time to make them.
#pragma once

#include <cstring>

#include "bodies/random.hpp"
#include "support/scene.hpp"

namespace grit::test {

/// Grains near the places of a cubic lattice with its corner at `low`, of radii around half the spacing: most overlap a
/// little, others have gaps. In random order, moving at random.
inline std::vector<Grain> jumble(const std::array<int, 3>& sides, double spacing, double speed, std::uint64_t seed,
                                 const Vec3& low = Vec3::Zero()) {
  Random random(seed);
  const auto about = [&](double size) { return size * (2 * random.uniform() - 1); };
  std::vector<Grain> grains;
  for (int x = 0; x < sides[0]; ++x)
    for (int y = 0; y < sides[1]; ++y)
      for (int z = 0; z < sides[2]; ++z) {
        const Vec3 shake(about(0.03), about(0.03), about(0.03)), velocity(about(speed), about(speed), about(speed));
        const Vec3 spin(about(speed), about(speed), about(speed));
        grains.push_back({low + spacing * (Vec3(x + 0.5, y + 0.5, z + 0.5) + shake), spacing * (0.505 + about(0.03)),
                          velocity, spin / spacing});
      }
  random.shuffle(grains);
  return grains;
}

/// A rectangle across an axis at `place`, over [low, high] of the other two, facing +axis or −axis.
inline Description side(int axis, double place, const Vec3& low, const Vec3& high, bool facing_up,
                        const std::string& material = "grain") {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  Vec3 corner = low, edge_u = Vec3::Zero(), edge_v = Vec3::Zero();
  corner[axis] = place, edge_u[u] = high[u] - low[u], edge_v[v] = high[v] - low[v];
  return {{"type", "rectangle"},
          {"corner", vector(corner)},
          {"edge_a", vector(facing_up ? edge_u : edge_v)},
          {"edge_b", vector(facing_up ? edge_v : edge_u)},
          {"material", material}};
}

/// Whether two kernels have the same bodies, contacts and memories, to the last bit and in the same order.
inline bool same_bits(const Kernel& a, const Kernel& b) {
  const auto same = [](auto x, auto y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size_bytes()) == 0;
  };
  if (!same(a.world().ids(), b.world().ids()) || !same(a.world().positions(), b.world().positions()) ||
      !same(a.world().velocities(), b.world().velocities()) || !same(a.world().spins(), b.world().spins()) ||
      a.state().pairs.candidates() != b.state().pairs.candidates())
    return false;
  for (std::size_t c = 0; c < a.state().pairs.candidates(); ++c)
    if (a.state().pairs.contacts(c) != b.state().pairs.contacts(c) || a.state().pairs.a(c) != b.state().pairs.a(c) ||
        a.state().pairs.b(c) != b.state().pairs.b(c) || a.state().pairs.state(c) != b.state().pairs.state(c))
      return false;
  const auto wall_memory = [](const Kernel& s) {
    std::vector<double> all;
    s.state().wall_contacts.each([&](const WallContacts::Touching& t) {
      all.push_back(t.contact->body), all.push_back(t.contact->wall);
      all.insert(all.end(), t.state.begin(), t.state.end());
    });
    return all;
  };
  return wall_memory(a) == wall_memory(b);
}

}  // namespace grit::test
