// The world as probes, engines and conditions see it: const, at one instant, positions and forces belonging together.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "grit/geometry.hpp"
#include "grit/vec.hpp"

namespace grit {

/// State of bodies that exists only where a component asks for it.
enum class BodyState : unsigned {
  rotation = 1,      ///< rotation vector, cumulative since the start of the stage [rad]
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

  /// Where a coordinate is seen within the cell: along a periodic axis whole periods off, else itself [m]. Bodies are
  /// past a periodic side for a while before they come in at the other one.
  double inside(double x, int axis) const {
    const double period = high[axis] - low[axis];
    return periodic[static_cast<std::size_t>(axis)] ? x - period * std::floor((x - low[axis]) / period) : x;
  }
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
  std::uint32_t feature = 0;  ///< of the wall's geometry, what is touched; it stays while the body slides along it
  Vec3 branch;                ///< from a's centre to b's centre, or to the touching point of the wall [m]
  Vec3 normal;                ///< unit, from a to b
  Vec3 force;                 ///< on b [N]; −force acts on a
  Vec3 moment;                ///< on b about its centre; on a wall about the touching point [N m]
  double normal_force = 0;    ///< N, > 0 in compression
  double overlap = 0;         ///< m
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
  bool flat = false;  ///< made of wide plane faces
  Pose pose;          ///< where its shape has moved and turned to
};

/// How far a point is from the surface of a wall.
struct Clearance {
  double distance;  ///< m; below 0 where the point is behind a face that is solid behind
  Vec3 normal;      ///< unit, into the wall: the surface is at the point + distance · normal
};

/// Of World::clump_of(): a sphere by itself.
inline constexpr std::uint32_t no_clump = ~0u;

/// A rigid clump of spheres at one instant.
struct ClumpView {
  std::uint32_t id;
  Vec3 centre;          ///< of mass [m]
  Vec3 velocity, spin;  ///< half a step before time() [m/s, rad/s]
  Vec3 momentum;        ///< angular, about the centre, half a step before time() [kg m²/s]
  Vec3 force, moment;   ///< net, gravity and contacts, about the centre, before damping [N, N m]
  double radius;        ///< of the enclosing sphere [m]
  double mass;          ///< kg
  Mat3 axes;            ///< columns: its principal axes
  Vec3 inertia;         ///< about them [kg m²]
};

/// A body that has left through an open side of the domain.
struct Departure {
  std::uint32_t id;
  std::uint8_t material;
  double time;    ///< s, when it was found outside
  double mass;    ///< kg
  Vec3 position;  ///< where [m]
};

/// Where the energy is, and what came in and went out since a component first asked [J].
struct EnergyLedger {
  double kinetic = 0;                                                 ///< translation and rotation
  double elastic_normal = 0, elastic_shear = 0, elastic_rolling = 0;  ///< in contacts; rolling with twisting
  double gravitational = 0;                                           ///< against the first instant
  double walls = 0;                                                   ///< work done by walls
  double cell = 0;                                                    ///< work done by the straining of a periodic cell
  double engines = 0;                                                 ///< of added forces, and of what holds bodies
  double settings = 0;                                                ///< put in by changes of the description
  double friction = 0, rolling = 0, viscosity = 0, local_damping = 0;  ///< dissipated
  /// What there is and was dissipated, less what there was and was put in: made by errors of the time step and of the
  /// law.
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
  virtual std::span<const Vec3> rotations() const = 0;      ///< in the stage [rad]; empty unless asked for
  virtual std::span<const Vec3> displacements() const = 0;  ///< in the stage [m]; empty unless asked for
  /// Index into clumps() of each body, or no_clump; empty where there is no clump. A body of a clump has the clump's
  /// 1/mass beside its velocity and 1 over the clump's least moment of inertia beside its spin.
  virtual std::span<const std::uint32_t> clump_of() const { return {}; }
  virtual std::span<const ClumpView> clumps() const { return {}; }
  /// From its clump's centre to each body [m]; empty where there is no clump.
  virtual std::span<const Vec3> arms() const { return {}; }
  /// Of each body's volume what counts, as bodies of a clump overlap; empty where all of it does.
  virtual std::span<const double> volume_shares() const { return {}; }
  /// Bodies that have left, in the order in which they did.
  virtual std::span<const Departure> departures() const { return {}; }
  /// Net force and moment on each body, gravity and contacts, before damping [N, N m]; of contacts alone on a body of a
  /// clump.
  virtual std::span<const Row> forces() const = 0;
  virtual std::span<const Row> moments() const = 0;

  /// All touching pairs and touches of walls, pairs first, in a fixed order.
  virtual std::span<const Contact> contacts() const = 0;
  /// The touches of walls among them, found without a list of the others.
  virtual std::span<const Contact> contacts_with_walls() const;
  /// Mean normal force of all contacts [N], 0 without any; found without a list of them.
  virtual double mean_contact_force() const;
  virtual std::span<const WallView> walls() const = 0;
  /// Of a point from one of walls(); none where the surface is `reach` [m] or more away. Behind a face that has edges
  /// the distance may be too small, never too large. Periodic images of the point do not count.
  virtual std::optional<Clearance> clearance(std::size_t, const Vec3&, double) const { return {}; }
  virtual const Cell& cell() const = 0;

  /// The box that the specimen fills, from its walls or the periodic cell; as the description's "specimen" says.
  virtual Region specimen() const = 0;
  /// The same out to the far sides of its walls' surfaces: with the grooves of walls, which lie behind the specimen.
  virtual Region envelope() const { return specimen(); }
  /// The part of the specimen that lies `margin` or more off its walls; periodic sides have no margin.
  virtual Region interior(double margin) const = 0;
  virtual double mean_diameter() const = 0;  ///< by number, of a clump that of the enclosing sphere [m]
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

/// Of translation and rotation, `later` seconds after its velocities' instant [J].
double kinetic_energy_of(const ClumpView& clump, double later);

/// Spheres by themselves and clumps.
struct Grains {
  std::vector<Vec3> centre;            ///< m
  std::vector<std::uint32_t> of_body;  ///< the grain of each body
};
Grains grains_of(const World& world);

/// Of a contact: from the centre of the grain of body a, a sphere or a clump, to that of the grain of body b, or to the
/// touching point of a wall [m].
struct Branch {
  Vec3 start, way;
};
Branch branch_of(const World& world, const Contact& contact);

/// Volume of voids over volume of solids in a box, by exact sphere–box volumes; overlaps of contacts count twice, those
/// within a clump once (of a clump that the box cuts, up to how its spheres share them). Periodic images are counted.
/// Infinite without solids.
double void_ratio(const World& world, const Region& region);

/// Mean stress of a box, Love–Weber: each contact weighted by the part of its branch inside. Pa, compression positive.
Mat3 mean_stress(const World& world, const Region& region);

/// Volume [m³] of the part of a sphere that lies inside a box, to 1e-12 of the sphere's volume.
double sphere_box_volume(const Vec3& centre, double radius, const Vec3& low, const Vec3& high);

}  // namespace grit
