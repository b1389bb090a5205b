// The world as probes, engines and conditions see it: const, at one instant, positions and forces belonging together.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "grit/vec.hpp"

namespace grit {

/// State of bodies that exists only where a component asks for it.
enum class BodyState : unsigned {
  rotation = 1,      ///< cumulative rotation vector [rad]
  displacement = 2,  ///< displacement since the start of the stage [m], unwrapped
  energy = 4,        ///< the ledger of energies, of all bodies together
};

/// A set of BodyState.
class StateRequest {
 public:
  constexpr StateRequest() = default;
  constexpr StateRequest(BodyState state) : bits_(static_cast<unsigned>(state)) {}
  constexpr StateRequest operator|(StateRequest other) const { return StateRequest(bits_ | other.bits_); }
  constexpr bool has(BodyState state) const { return (bits_ & static_cast<unsigned>(state)) != 0; }

 private:
  constexpr explicit StateRequest(unsigned bits) : bits_(bits) {}
  unsigned bits_ = 0;
};

constexpr StateRequest operator|(BodyState a, BodyState b) { return StateRequest(a) | StateRequest(b); }

/// The box of the world. Not finite where it is open.
struct Cell {
  Vec3 low, high;  ///< m
  std::array<bool, 3> periodic{false, false, false};
  Vec3 strain_rate = Vec3::Zero();  ///< of the periodic axes, 1/s, positive in extension
};

/// A box, for averages.
struct Region {
  Vec3 low, high;  ///< m
  double volume() const { return (high - low).cwiseMax(0.0).prod(); }
};

/// One touching pair, or one touch of a wall.
struct Contact {
  std::uint32_t a = 0, b = 0;  ///< index of body a; of body b, or of the wall
  bool with_wall = false;
  Vec3 branch;              ///< from a's centre to b's centre, or to the touching point of the wall [m]
  Vec3 normal;              ///< unit, from a to b
  Vec3 force;               ///< on b [N]; −force acts on a
  Vec3 moment;              ///< on b about its centre; on a wall about the touching point [N m]
  double normal_force = 0;  ///< N, > 0 in compression
  double overlap = 0;       ///< m
};

/// A wall at one instant.
struct WallView {
  std::string name;
  Vec3 position;        ///< displacement since the start of the run [m]
  Vec3 stage_position;  ///< displacement since the start of the stage [m]
  Vec3 velocity, spin;  ///< m/s, rad/s
  Vec3 force;           ///< that the bodies exert on the wall [N]
  Vec3 moment;          ///< the same about the wall's reference point [N m]
  double area = 0;      ///< m²; 0 where the geometry has none
  double pressure = 0;  ///< normal force over area, > 0 in compression [Pa]
  Vec3 normal;          ///< mean unit normal, towards the bodies; zero where the geometry has none
  std::uint32_t touches = 0;
};

/// Where the energy is, and what came in and went out since a component first asked [J].
struct EnergyLedger {
  double kinetic = 0;                                                  ///< translation and rotation
  double elastic_normal = 0, elastic_shear = 0, elastic_rolling = 0;   ///< in contacts; rolling with twisting
  double gravitational = 0;                                            ///< against the first instant
  double walls = 0;                                                    ///< work done by walls
  double settings = 0;                                                 ///< put in by changes of the description
  double friction = 0, rolling = 0, viscosity = 0, local_damping = 0;  ///< dissipated
  /// What there is and was dissipated, less what there was and was put in: made by errors of the time step and of the
  /// law. NaN where something takes part whose work is not kept: a deforming cell, engines that add forces, held
  /// bodies.
  double closure_error = 0;

  double elastic() const { return elastic_normal + elastic_shear + elastic_rolling; }
  double dissipated() const { return friction + rolling + viscosity + local_damping; }
};

class World {
 public:
  virtual ~World() = default;

  virtual double time() const = 0;         ///< s since the start of the run
  virtual std::uint64_t step() const = 0;  ///< since the start of the run
  virtual double dt() const = 0;           ///< s
  virtual const std::string& stage() const = 0;

  // Bodies by index; an index may belong to another body after any step, an id never changes.
  virtual std::span<const std::uint32_t> ids() const = 0;
  virtual std::span<const Row> positions() const = 0;   ///< centre [m], w: radius [m]
  virtual std::span<const Row> velocities() const = 0;  ///< half a step before time() [m/s], w: 1/mass [1/kg]
  virtual std::span<const Row> spins() const = 0;  ///< half a step before time() [rad/s], w: 1/inertia [1/(kg m²)]
  virtual std::span<const std::uint8_t> materials() const = 0;
  virtual std::span<const Vec3> rotations() const = 0;      ///< empty unless asked for
  virtual std::span<const Vec3> displacements() const = 0;  ///< empty unless asked for
  /// Net force and moment on each body, gravity and contacts, before damping [N, N m].
  virtual std::span<const Row> forces() const = 0;
  virtual std::span<const Row> moments() const = 0;

  /// All touching pairs and touches of walls, pairs first, in a fixed order.
  virtual std::span<const Contact> contacts() const = 0;
  /// Mean normal force of all contacts [N], 0 without any; found without a list of them.
  virtual double mean_contact_force() const;
  virtual std::span<const WallView> walls() const = 0;
  virtual const Cell& cell() const = 0;

  /// The box that the specimen fills, from its walls or the periodic cell; as the description's "specimen" says.
  virtual Region specimen() const = 0;
  /// The part of the specimen that lies `margin` or more off its walls; periodic sides have no margin.
  virtual Region interior(double margin) const = 0;
  virtual double mean_diameter() const = 0;  ///< by number [m]
  virtual double solid_density() const = 0;  ///< mass over volume of all bodies, scaled masses too [kg/m³]
  /// For components that asked for BodyState::energy.
  virtual EnergyLedger energies() const { return {}; }
};

/// What the whole world's motion amounts to: the figures that tell whether it rests.
struct Unrest {
  double kinetic_energy;      ///< J, translation and rotation, at time()
  double unbalanced_force;    ///< mean net force of a body over the mean contact force; 0 without contacts
  double mean_contact_force;  ///< N
};
Unrest unrest(const World& world);

/// Volume of voids over volume of solids in a box, by exact sphere–box volumes; overlaps count twice. Periodic images
/// are counted. Infinite without solids.
double void_ratio(const World& world, const Region& region);

/// Mean stress of a box, Love–Weber: each contact weighted by the part of its branch inside. Pa, compression positive.
Mat3 mean_stress(const World& world, const Region& region);

/// Volume [m³] of the part of a sphere that lies inside a box, to 1e-12 of the sphere's volume.
double sphere_box_volume(const Vec3& centre, double radius, const Vec3& low, const Vec3& high);

}  // namespace grit
