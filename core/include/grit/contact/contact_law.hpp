// Contact laws as the kernel calls them. To write a law, do not derive from this; see grit/contact/law.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "grit/contact/batch.hpp"
#include "grit/parameters.hpp"

namespace grit {

/// Stiffnesses and damping ratios of one contact, for the critical time step.
struct Stiffness {
  double normal = 0;               ///< N/m
  double shear = 0;                ///< N/m
  double rolling = 0;              ///< N m/rad, about axes in the contact plane
  double twisting = 0;             ///< N m/rad, about the normal
  double damping_ratio = 0;        ///< of the normal dashpot, over critical damping of the pair
  double shear_damping_ratio = 0;  ///< of a dashpot parallel to the shear spring; critical is 2 √(k_s m* / 3.5)
};

/// Size and mass of a pair. A wall has radius_b = radius_a and inverse_mass_b = 0; for a body with these values, set
/// `wall = false`.
struct PairSize {
  double radius_a, radius_b;              ///< m
  double inverse_mass_a, inverse_mass_b;  ///< 1/kg
  double overlap;  ///< largest expected overlap ≥ 0 [m]; minus the distance of two surfaces within the reach of a law
  bool wall = inverse_mass_b == 0 && radius_b == radius_a;
};

/// Elastic energy of one contact [J].
struct ElasticEnergy {
  double normal = 0;  ///< includes that of attraction; 0 where surfaces start to touch
  double shear = 0;
  double rolling = 0;  ///< includes twisting
  double total() const { return normal + shear + rolling; }
  ElasticEnergy operator+(const ElasticEnergy& other) const {
    return {normal + other.normal, shear + other.shear, rolling + other.rolling};
  }
};

/// One number of the contact history.
struct StateField {
  std::string name, unit, doc;
  double swap;  ///< +1 or −1: factor of the number when a and b are exchanged
};

/// Properties of the loop that evaluates the pairs of a law.
struct LawLoop {
  std::size_t lanes = 1;              ///< pairs evaluated at once
  std::string precision = "double";   ///< of the arithmetic: double or single
  std::vector<std::string> parts;     ///< active features of the law
  std::vector<std::string> inactive;  ///< features that no material pair needs
};

struct DevicePairs;

/// What a device needs of a law.
struct DeviceLaw {
  std::span<const std::byte> parameters;  ///< of pairs of materials, to be copied to the device
  std::uint32_t materials = 0;            ///< their number
  unsigned features = 0;                  ///< that are active, one bit each
  std::span<const char> ptx;              ///< its kernel for GPUs, ends with 0; empty if it was compiled without nvcc
};

/// evaluate_* is called from several threads at once on disjoint chunks; all other calls come from the thread that owns
/// the simulation. An exception ends the run, and its message names the law.
class ContactLaw {
 public:
  virtual ~ContactLaw() = default;

  /// Settings of the law as a whole.
  virtual void declare(Parameters& parameters) = 0;
  /// Removes all materials and interfaces.
  virtual void clear_materials() = 0;
  /// Declares the parameters of a material; adds it with defaults if it is new.
  virtual void declare_material(const std::string& name, Parameters& parameters) = 0;
  /// Declares the parameters that override those of materials `a` and `b`, in either order, at their interface.
  virtual void declare_interface(const std::string& a, const std::string& b, Parameters& parameters) = 0;
  /// Combines the parameters of all pairs of materials, given in the order of their indices. The first `of_bodies` are
  /// materials of bodies; the others are materials of walls, which never meet each other. Call after every change.
  virtual void mix(std::span<const std::string> materials, std::size_t of_bodies) = 0;

  /// Fields of the contact history with the present parameters, without those of inactive features; in the order of the
  /// law's fields.
  virtual std::vector<StateField> state() const = 0;
  virtual LawLoop loop() const = 0;
  virtual void evaluate_pairs(PairBatch& batch) const = 0;
  virtual void evaluate_walls(WallBatch& batch) const = 0;
  /// The same with scalars instead of SIMD lanes, for tests.
  virtual void evaluate_pairs_reference(PairBatch& batch) const = 0;
  /// With the present parameters; none if devices cannot evaluate the law with them.
  virtual std::optional<DeviceLaw> device() const { return {}; }
  /// The kernel of devices in a loop on the CPU, for bodies from `first` to before `last`; see device_kernel.hpp.
  /// `parameters`: a copy of those of device().
  virtual void evaluate_device_pairs(const DevicePairs& /*pairs*/, const void* /*parameters*/, std::uint32_t /*first*/,
                                     std::uint32_t /*last*/) const {}
  virtual Stiffness stiffness(const PairSize& pair, std::size_t material_a, std::size_t material_b) const = 0;
  /// Whether bodies may interact at a distance.
  virtual bool has_reach() const { return false; }
  /// Distance of two surfaces up to which they interact [m]; 0 for most laws.
  virtual double reach(const PairSize&, std::size_t, std::size_t) const { return 0; }
  /// The same for all pairs of materials of bodies of this radius [m], then for their materials and those of walls;
  /// empty if bodies interact in contact only.
  virtual std::vector<double> reaches(double) const { return {}; }
  /// All combined parameters of a body of the first material and a body, or wall, of the second.
  virtual std::vector<double> mixed(std::size_t material_a, std::size_t material_b, bool wall) const = 0;
  /// Elastic energy of one contact with the given history, one number per field of state().
  virtual ElasticEnergy energy(const PairSize& pair, std::size_t material_a, std::size_t material_b,
                               std::span<const double> state) const = 0;
};

}  // namespace grit
