// The kernel's side of a contact law. A law's author does not derive from this: see grit/contact/law.hpp.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "grit/contact/batch.hpp"
#include "grit/parameters.hpp"

namespace grit {

/// Stiffnesses of one contact, for the time step, and its viscous damping as a fraction of critical.
struct Stiffness {
  double normal = 0;               ///< N/m
  double shear = 0;                ///< N/m
  double rolling = 0;              ///< N m/rad, about axes in the contact plane
  double twisting = 0;             ///< N m/rad, about the normal
  double damping_ratio = 0;        ///< of the normal dashpot: over what is critical for the pair
  double shear_damping_ratio = 0;  ///< of a dashpot beside the shear spring; critical is 2 √(k_s m* / 3.5)
};

/// The pair whose stiffness is asked for. A wall has radius_b = radius_a and inverse_mass_b = 0; a body that only
/// happens to have both says `wall = false`.
struct PairSize {
  double radius_a, radius_b;              ///< m
  double inverse_mass_a, inverse_mass_b;  ///< 1/kg
  double overlap;                         ///< m; the largest that is expected, never below zero
  bool wall = inverse_mass_b == 0 && radius_b == radius_a;

  /// What shear does to the bodies on a path along which laws stretch its spring, over what the spring takes up on it:
  /// paths are told with the radii as arms, and the arms of forces add up to the branch.
  double work_share() const { return wall ? 1 : 1 - overlap / (radius_a + radius_b); }
};

/// What is stored in one contact [J].
struct ElasticEnergy {
  double normal = 0, shear = 0;
  double rolling = 0;  ///< with twisting
  double total() const { return normal + shear + rolling; }
  ElasticEnergy operator+(const ElasticEnergy& other) const {
    return {normal + other.normal, shear + other.shear, rolling + other.rolling};
  }
};

/// One number that a contact remembers.
struct StateField {
  std::string name, unit, doc;
  double swap;  ///< +1 or −1: what the number is multiplied with when a and b change places
};

/// The loop that evaluates a law's pairs.
struct LawLoop {
  std::size_t lanes = 1;              ///< pairs at once
  std::string precision = "double";   ///< of the arithmetic, or single
  std::vector<std::string> parts;     ///< of the law, compiled in
  std::vector<std::string> left_out;  ///< those that nothing here needs
};

/// All calls come from the thread that owns the simulation, but evaluate_*, which are called from several at once on
/// disjoint chunks.
class ContactLaw {
 public:
  virtual ~ContactLaw() = default;

  /// Settings of the law as a whole.
  virtual void declare(Parameters& parameters) = 0;
  /// Forgets all materials and interfaces.
  virtual void clear_materials() = 0;
  /// Declares the parameters of a material; adds it, with defaults, if it is new.
  virtual void declare_material(const std::string& name, Parameters& parameters) = 0;
  /// Declares what may be overridden where materials `a` and `b` meet, in either order.
  virtual void declare_interface(const std::string& a, const std::string& b, Parameters& parameters) = 0;
  /// Mixes all pairs of the materials, given in the order of their indices. The first `of_bodies` are those that bodies
  /// are of: two others never meet. Call again after any change.
  virtual void mix(std::span<const std::string> materials, std::size_t of_bodies) = 0;

  /// What a contact remembers with the present parameters; parts that a zero parameter switches off are left out.
  /// Always the first so many of the law's fields.
  virtual std::vector<StateField> state() const = 0;
  virtual LawLoop loop() const = 0;
  virtual void evaluate_pairs(PairBatch& batch) const noexcept = 0;
  virtual void evaluate_walls(WallBatch& batch) const noexcept = 0;
  /// The same by plain scalars, for tests.
  virtual void evaluate_pairs_reference(PairBatch& batch) const noexcept = 0;
  virtual Stiffness stiffness(const PairSize& pair, std::size_t material_a, std::size_t material_b) const = 0;
  /// All numbers that materials and interfaces come to where a body of the first meets one, or a wall, of the second.
  virtual std::vector<double> mixed(std::size_t material_a, std::size_t material_b, bool wall) const = 0;
  /// Stored in one contact with the given memory (as many numbers as state()).
  virtual ElasticEnergy energy(const PairSize& pair, std::size_t material_a, std::size_t material_b,
                               std::span<const double> state) const = 0;
};

}  // namespace grit
