// The bodies: a structure of arrays, by index. Indices are in spatial order and change; ids do not.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bodies/clumps.hpp"
#include "bodies/large_array.hpp"
#include "grit/vec.hpp"
#include "grit/world.hpp"
#include "ranks/shared_archive.hpp"
#include "threads/team.hpp"

namespace grit {

/// Arrays have one entry per body. Position, velocity and spin have one more at the end: a dummy body far away from all
/// others, which pads blocks of contacts.
struct Bodies {
  LargeArray<Row> position;  ///< m, w: radius [m]
  LargeArray<Row> velocity;  ///< m/s, half a step before the positions; w: 1/mass [1/kg]
  LargeArray<Row> spin;      ///< rad/s; w: 1/inertia [1/(kg m²)]
  std::vector<std::uint32_t> id;
  std::vector<std::uint8_t> material;
  std::vector<Vec3> rotation;  ///< cumulative, see start_paths() [rad]; empty unless requested
  std::vector<Vec3> origin;    ///< origin of displacements [m], see start_paths(); empty unless requested
  Clumps clumps;
  std::vector<BodyGroup> groups;                     ///< in ascending order of ids
  StateRequest state;                                ///< requested by components
  std::uint32_t ids_given = 0, clump_ids_given = 0;  ///< number of ids ever given, including bodies that left

  std::size_t count() const { return id.size(); }
  /// The name of the group of a body with this id; empty if unknown.
  std::string group_of(std::uint32_t body) const;
  /// Whether a component requested the energy balance.
  bool energies() const { return state.has(BodyState::energy); }
  /// Reserves memory for further bodies and the padding.
  void reserve(std::size_t more);
  /// Adds a body with the next id (before finish()).
  void add(const Vec3& centre, double radius, double mass, double inertia, std::uint8_t material,
           const Vec3& velocity = Vec3::Zero(), const Vec3& spin = Vec3::Zero());
  /// Adds the bodies of a clump (before finish()) with this centre of mass, size, mass and orientation.
  void add_clump(const ClumpShape& shape, const Vec3& centre, double radius, double mass, const Vec3& inertia,
                 const Eigen::Quaterniond& orientation, std::uint8_t material, const Vec3& velocity = Vec3::Zero(),
                 const Vec3& spin = Vec3::Zero());
  /// After the last add(): adds the padding and allocates the requested state.
  void finish(StateRequest asked_for);
  /// Changes the requested state of finished bodies.
  void request(StateRequest asked_for);
  /// Resets displacements and rotations to zero. Origins are shifted by a period with their bodies, so that
  /// displacements need not be summed up in each step.
  void start_paths();
  /// Appends other bodies; both are finished, with the same state. The others get new ids, after all that were ever
  /// given here.
  void append(const Bodies& others);
  /// Moves body order[i] to index i. Bodies that are not in `order` are removed.
  void reorder(std::span<const std::uint32_t> order, Team& team);
  /// Everything except `state`, which follows from the scene.
  void serialize(SharedArchive& archive);

 private:
  void pad();
};

/// Throws Error unless restored bodies fit together. `materials`: their number; `groups`: names of the scene.
void check_restored(const Bodies& bodies, std::size_t materials, std::span<const std::string> groups);

}  // namespace grit
