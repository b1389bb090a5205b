// Read-only state of a simulation for probes, engines and conditions, at one instant; positions and forces are
// consistent. SI units.
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

/// State that is kept only if a component requests it.
enum class BodyState : unsigned {
  rotation = 1,      ///< rotation vector, cumulative since the start of the stage [rad]
  displacement = 2,  ///< displacement since the start of the stage [m], unwrapped
  energy = 4,        ///< the energy balance of all bodies
};

/// Arrays of World whose memory Simulation::keep() can keep.
enum class WorldArray : std::size_t {
  ids,
  positions,
  velocities,
  spins,
  materials,
  rotations,
  displacements,
  clump_of,
  clumps,
  departures,
  forces,
  moments,
  contacts,
};
inline constexpr std::size_t world_arrays = 13;

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

/// The box of the domain; infinite along open sides.
struct Cell {
  Vec3 low, high;  ///< m
  std::array<bool, 3> periodic{false, false, false};
  Vec3 strain_rate = Vec3::Zero();  ///< along periodic axes [1/s], positive in extension
  /// Gradients of the mean flow [1/s]: of v_x along y, of v_x along z, of v_y along z.
  Vec3 shear_rate = Vec3::Zero();
  /// Offsets of images across sides [m]: along x across y, along x across z, along y across z.
  Vec3 tilt = Vec3::Zero();

  Vec3 stage_lengths = Vec3::Zero();       ///< side lengths at the start of the stage [m]
  Vec3 stage_shear_strain = Vec3::Zero();  ///< shear rates integrated since the start of the stage

  template <class Archive>
  void serialize(Archive& archive) {
    archive(low, high, periodic, strain_rate, shear_rate, tilt, stage_lengths, stage_shear_strain);
  }
  bool periodic_anywhere() const { return periodic[0] || periodic[1] || periodic[2]; }
  bool periodic_everywhere() const { return periodic[0] && periodic[1] && periodic[2]; }
  bool shears() const { return !shear_rate.isZero(0.0); }
  /// Whether images are, or will be, off the axes.
  bool skewed() const { return shears() || !tilt.isZero(0.0); }
  /// From a body to its next image across the upper side of an axis [m]; zero along an axis that is not periodic. The
  /// image across z may be off along x and y, that across y along x.
  Vec3 period(int axis) const {
    if (!periodic[static_cast<std::size_t>(axis)]) return Vec3::Zero();
    const double length = high[axis] - low[axis];
    return axis == 0 ? Vec3(length, 0, 0) : axis == 1 ? Vec3(tilt[0], length, 0) : Vec3(tilt[1], tilt[2], length);
  }
  /// A coordinate [m] moved into the cell by whole periods; unchanged along an axis that is not periodic. Bodies may be
  /// slightly outside a periodic side until the next neighbour search wraps them.
  double inside(double x, int axis) const {
    const double period = high[axis] - low[axis];
    return periodic[static_cast<std::size_t>(axis)] ? x - period * std::floor((x - low[axis]) / period) : x;
  }
  /// The same for a point, also in a cell that is skewed.
  Vec3 inside(Vec3 x) const {
    if (!skewed()) return {inside(x[0], 0), inside(x[1], 1), inside(x[2], 2)};
    for (int axis = 2; axis >= 0; --axis)
      if (const double length = high[axis] - low[axis]; periodic[static_cast<std::size_t>(axis)])
        x -= std::floor((x[axis] - low[axis]) / length) * period(axis);
    return x;
  }
  /// Calls visit(shift) for each image, also in a cell that is skewed, in which a box may intersect a region.
  template <class Visit>
  void each_image(const Vec3& low_of_box, const Vec3& high_of_box, const Vec3& low_of_region,
                  const Vec3& high_of_region, const Visit& visit) const;
};

template <class Visit>
void Cell::each_image(const Vec3& low_of_box, const Vec3& high_of_box, const Vec3& low_of_region,
                      const Vec3& high_of_region, const Visit& visit) const {
  // Images across z first: they shift those across y, and these those across x.
  const auto along = [&](int axis, const Vec3& shift, const auto& next) {
    const double before = low_of_region[axis] - shift[axis] - high_of_box[axis],
                 after = high_of_region[axis] - shift[axis] - low_of_box[axis];
    if (!periodic[static_cast<std::size_t>(axis)]) {
      if (before <= 0 && after >= 0) next(shift);
      return;
    }
    const double length = high[axis] - low[axis];
    const Vec3 to_next = period(axis);
    for (double n = std::ceil(before / length); n <= std::floor(after / length); ++n) next(Vec3(shift + n * to_next));
  };
  along(2, Vec3::Zero(),
        [&](const Vec3& z) { along(1, z, [&](const Vec3& y) { along(0, y, [&](const Vec3& x) { visit(x); }); }); });
}

/// A box over which averages are taken.
struct Region {
  Vec3 low, high;  ///< m
  double volume() const { return (high - low).cwiseMax(0.0).prod(); }
};

/// A contact of two bodies, or of a body and a wall.
struct Contact {
  std::uint32_t a = 0, b = 0;  ///< index of body a; index of body b or of the wall
  bool with_wall = false;
  std::uint32_t feature = 0;  ///< SurfaceContact::feature; 0 for two bodies
  Vec3 branch;                ///< from a's centre to b's centre, or to the contact point on the wall [m]
  Vec3 normal;                ///< unit, from a to b
  Vec3 force;                 ///< on b [N]; −force acts on a
  Vec3 moment;                ///< on b about its centre; on a wall about the contact point [N m]
  double normal_force = 0;    ///< N, > 0 in compression
  double overlap = 0;         ///< m; minus the distance of the surfaces where a law acts at a distance
};

/// A wall at one instant.
struct WallView {
  std::string name;
  Vec3 position;        ///< displacement since the start of the run [m]
  Vec3 stage_position;  ///< displacement since the start of the stage [m]
  Vec3 velocity, spin;  ///< m/s, rad/s
  Vec3 force;           ///< by the bodies on the wall [N]
  Vec3 moment;          ///< the same about the wall's reference point [N m]
  double area = 0;      ///< m²; 0 where the geometry has none
  double pressure = 0;  ///< normal force over area, > 0 in compression [Pa]
  Vec3 normal;          ///< mean unit normal, towards the bodies; zero where the geometry has none
  std::uint32_t contacts = 0;
  bool flat = false;                   ///< made of wide plane faces
  Pose pose;                           ///< present translation and rotation
  const Geometry* geometry = nullptr;  ///< at its initial position; null if it is not known
};

/// Distance of a point from the surface of a wall.
struct Clearance {
  double distance;  ///< m; negative behind a one-sided face
  Vec3 normal;      ///< unit, into the wall; the closest surface point is point + distance · normal
};

/// Entry of World::clump_of() for a sphere that belongs to no clump.
inline constexpr std::uint32_t no_clump = ~0u;

/// A rigid clump of spheres at one instant.
struct ClumpView {
  std::uint32_t id;
  Vec3 centre;           ///< of mass [m]
  Vec3 velocity, spin;   ///< half a step before time() [m/s, rad/s]
  Vec3 momentum;         ///< angular momentum about the centre, half a step before time() [kg m²/s]
  Vec3 force, moment;    ///< net, of gravity and contacts, about the centre, before damping [N, N m]
  double radius;         ///< of the enclosing sphere [m]
  double mass;           ///< kg
  double unscaled_mass;  ///< without density scaling [kg]
  Mat3 axes;             ///< columns: principal axes
  Vec3 inertia;          ///< principal moments of inertia [kg m²]
};

/// Bodies from this id on, up to the next entry, belong to the group of this name in the description.
struct BodyGroup {
  std::string name;
  std::uint32_t first_id;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(name, first_id);
  }
};

/// A body that left the domain through an open side.
struct Departure {
  std::uint32_t id;
  std::uint8_t material;
  double time;    ///< when it was found outside [s]
  double mass;    ///< without density scaling [kg]
  Vec3 position;  ///< at that time [m]
  template <class Archive>
  void serialize(Archive& archive) {
    archive(id, material, time, mass, position);
  }
};

/// Energy balance [J]: stored energies, and work and dissipation since a component first requested it.
struct Energies {
  double kinetic = 0;                                                 ///< translation and rotation
  double elastic_normal = 0, elastic_shear = 0, elastic_rolling = 0;  ///< in contacts; rolling includes twisting
  double gravitational = 0;                                           ///< relative to the first instant
  double walls = 0;                                                   ///< work done by walls
  double cell = 0;                                                    ///< work done by the straining of a periodic cell
  double engines = 0;   ///< work done by engines: added forces, held bodies
  double settings = 0;  ///< added by changes of the description
  double friction = 0, rolling = 0, viscosity = 0, local_damping = 0;  ///< dissipated; viscosity includes broken bonds
  /// Stored and dissipated energy less the initial energy and the work done. Its sources are errors of the time
  /// integration and of the contact law.
  double closure_error = 0;

  double elastic() const { return elastic_normal + elastic_shear + elastic_rolling; }
  double dissipated() const { return friction + rolling + viscosity + local_damping; }
};

/// State at one instant. Arrays of bodies have one entry per body, by index.
class World {
 public:
  virtual ~World() = default;

  virtual double time() const = 0;         ///< since the start of the run [s]
  virtual std::uint64_t step() const = 0;  ///< since the start of the run
  virtual double dt() const = 0;           ///< time step [s]
  virtual const std::string& stage() const = 0;

  // The index of a body may change in any step; its id never does.
  virtual std::span<const std::uint32_t> ids() const = 0;
  virtual std::span<const Row> positions() const = 0;   ///< centre [m], w: radius [m]
  virtual std::span<const Row> velocities() const = 0;  ///< half a step before time() [m/s], w: 1/mass [1/kg]
  virtual std::span<const Row> spins() const = 0;  ///< half a step before time() [rad/s], w: 1/inertia [1/(kg m²)]
  virtual std::span<const std::uint8_t> materials() const = 0;  ///< indices of material_names()
  virtual std::span<const std::string> material_names() const { return {}; }
  /// In ascending order of ids; one group may have several entries.
  virtual std::span<const BodyGroup> groups() const { return {}; }
  /// Name of the group of the body with this id; empty if there are no groups().
  std::string group_of(std::uint32_t id) const;
  virtual std::span<const Vec3> rotations() const = 0;      ///< during the stage [rad]; empty unless requested
  virtual std::span<const Vec3> displacements() const = 0;  ///< during the stage [m]; empty unless requested
  /// Index into clumps() of each body, or no_clump; empty without clumps. For a body of a clump, w of velocities() is
  /// 1/mass of the clump, and w of spins() is 1 over the clump's smallest moment of inertia.
  virtual std::span<const std::uint32_t> clump_of() const { return {}; }
  virtual std::span<const ClumpView> clumps() const { return {}; }
  /// Vectors from the clump's centre of mass to each body [m]; empty without clumps.
  virtual std::span<const Vec3> arms() const { return {}; }
  /// Fraction of each body's volume that counts, as bodies of a clump overlap; empty if all are 1.
  virtual std::span<const double> volume_fractions() const { return {}; }
  /// Mass without density scaling over mass of each body; empty if all are 1.
  virtual std::span<const double> unscaled_shares() const { return {}; }
  /// 1 for bodies whose translation engines hold or prescribe along all axes, 0 for others; empty if there are none.
  virtual std::span<const std::uint8_t> held() const { return {}; }
  /// Bodies that left the domain, in order of time.
  virtual std::span<const Departure> departures() const { return {}; }
  /// Net force [N] and moment [N m] on each body, of gravity and contacts, before damping; for a body of a clump, of
  /// contacts only. 0 along (or about) axes that engines hold.
  virtual std::span<const Row> forces() const = 0;
  virtual std::span<const Row> moments() const = 0;

  /// All contacts of bodies, then all wall contacts, in a fixed order.
  virtual std::span<const Contact> contacts() const = 0;
  /// The wall contacts of contacts(); cheaper if the others are not needed.
  virtual std::span<const Contact> contacts_with_walls() const;
  /// Mean normal force of all contacts [N]; 0 without contacts; cheaper than contacts().
  virtual double mean_contact_force() const;
  virtual std::span<const WallView> walls() const = 0;
  /// Clearance of a point [m] from wall `index` of walls(); none if the surface is `reach` [m] or more away. Behind a
  /// face with edges the distance may be too small, never too large. Periodic images of the point are not considered.
  virtual std::optional<Clearance> clearance(std::size_t /*index*/, const Vec3& /*point*/, double /*reach*/) const {
    return {};
  }
  virtual const Cell& cell() const = 0;

  /// The box of the specimen, bounded by walls or the periodic cell as defined by "specimen" in the description.
  /// Infinite along open sides.
  virtual Region specimen() const = 0;
  /// The specimen extended to the far sides of its walls' surfaces, so that it includes their grooves.
  virtual Region envelope() const { return specimen(); }
  /// The specimen without a margin [m] along its walls; periodic sides have no margin.
  virtual Region interior(double margin) const = 0;
  virtual double mean_diameter() const = 0;  ///< by number; for clumps, of the enclosing sphere [m]
  virtual double solid_density() const = 0;  ///< mass over volume of all bodies, with density scaling [kg/m³]
  /// For components that requested BodyState::energy.
  virtual Energies energies() const { return {}; }
};

/// Measures of static equilibrium of all bodies that are not held().
struct Equilibrium {
  double kinetic_energy;      ///< J, translation and rotation, at time()
  double unbalanced_force;    ///< mean net force on a body over the mean contact force; 0 without contacts
  double mean_contact_force;  ///< N
};
Equilibrium equilibrium(const World& world);

/// Whether contacts carry the bodies. Loads are all forces on bodies but those of contacts: weight, forces of engines.
struct Support {
  double unbalance;  ///< sum of net forces on bodies over the sum of loads and contact forces; 1 for bodies in flight,
                     ///< infinite without forces
  double carried;    ///< sum of the contact forces on each body over the sum of the loads; infinite without loads
  /// Bodies in flight are not at rest: neither those that fall freely, nor those that sink at a constant velocity.
  bool at_rest(double below) const { return unbalance < below && carried >= 0.5; }
};
Support support(const World& world);

/// Kinetic energy [J] of translation and rotation, `later` seconds after the instant of its velocities.
double kinetic_energy_of(const ClumpView& clump, double later);

/// Grains: single spheres and clumps.
struct Grains {
  std::vector<Vec3> centre;            ///< m
  std::vector<std::uint32_t> of_body;  ///< the grain of each body
};
Grains grains_of(const World& world);

/// Branch vector of a contact [m]: from the centre of the grain (sphere or clump) of body a to that of body b, or to
/// the contact point on a wall.
struct Branch {
  Vec3 start;
  Vec3 vector;
};
Branch branch_of(const World& world, const Contact& contact);

/// Volume of voids over volume of solids in a box, by exact sphere–box volumes. Overlaps at contacts count twice, those
/// within a clump once. For a clump that the box cuts, the volume inside is approximate. Periodic images are included.
/// Infinite without solids.
double void_ratio(const World& world, const Region& region);

/// Mean stress in a box [Pa] by the Love–Weber formula, compression positive. Each contact is weighted by the fraction
/// of its branch inside the box.
Mat3 mean_stress(const World& world, const Region& region);

/// Volume [m³] of the intersection of a sphere and a box; error below 1e-12 of the sphere's volume.
double sphere_box_volume(const Vec3& centre, double radius, const Vec3& low, const Vec3& high);

}  // namespace grit
