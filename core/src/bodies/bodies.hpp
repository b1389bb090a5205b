// The bodies: a structure of arrays, by index. Indices follow the bodies through space and change; ids do not.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bodies/clumps.hpp"
#include "bodies/large_array.hpp"
#include "grit/memory.hpp"
#include "grit/vec.hpp"
#include "grit/world.hpp"

namespace grit {

/// Arrays have one entry a body; position, velocity and spin one more at the end, of a body so far away that it touches
/// nothing, which pads blocks of contacts.
struct Bodies {
  LargeArray<Row> position;  ///< m, w: radius [m]
  LargeArray<Row> velocity;  ///< m/s, half a step before the positions; w: 1/mass [1/kg]
  LargeArray<Row> spin;      ///< rad/s; w: 1/inertia [1/(kg m²)]
  std::vector<std::uint32_t> id;
  std::vector<std::uint8_t> material;
  std::vector<Vec3> rotation;  ///< cumulative, see start_paths() [rad]; empty unless asked for
  std::vector<Vec3> origin;    ///< from where displacements count [m], see start_paths(); empty unless asked for
  Clumps clumps;
  /// A group of the description, whose bodies have this id and those up to that of the next group.
  struct Group {
    std::string name;
    std::uint32_t first_id;
    void remember(Memory& memory) { memory(name, first_id); }
  };
  std::vector<Group> groups;                         ///< by rising id
  StateRequest state;                                ///< that components asked for
  std::uint32_t ids_given = 0, clump_ids_given = 0;  ///< ever, to those that have left too

  std::size_t count() const { return id.size(); }
  /// The name of the group of a body with this id; empty where groups are not known.
  std::string group_of(std::uint32_t body) const;
  /// Whether a component asked for the ledger of energies.
  bool energies() const { return state.has(BodyState::energy); }
  /// Makes room for so many more, and the padding.
  void reserve(std::size_t more);
  /// Adds a body (before finish()). Ids count on.
  void add(const Vec3& centre, double radius, double mass, double inertia, std::uint8_t material,
           const Vec3& velocity = Vec3::Zero(), const Vec3& spin = Vec3::Zero());
  /// Adds the bodies of a clump (before finish()), whose centre of mass is `centre`, of that size, mass and
  /// orientation.
  void add_clump(const ClumpShape& shape, const Vec3& centre, double radius, double mass, const Vec3& inertia,
                 const Eigen::Quaterniond& orientation, std::uint8_t material, const Vec3& velocity = Vec3::Zero(),
                 const Vec3& spin = Vec3::Zero());
  /// After the last add(): pads, and allocates the state that was asked for.
  void finish(StateRequest asked_for);
  /// Displacements and rotations count from here on. Origins go on at the other side with their bodies, so that no step
  /// has to add up ways.
  void start_paths();
  /// Adds other bodies after these; both are finished, with the same state. The others get the ids that come after all
  /// that were ever given away here.
  void append(const Bodies& others);
  /// Puts body order[i] at place i. Bodies that are not in `order` are gone.
  void reorder(std::span<const std::uint32_t> order);
  /// All but `state`, which the scene says.
  void remember(Memory& memory) {
    memory(position, velocity, spin, id, material, rotation, origin, clumps, groups, ids_given, clump_ids_given);
  }
};

}  // namespace grit
