// Input and output of a contact law for one contact.
#pragma once

#include "grit/contact/lanes.hpp"
#include "grit/vec.hpp"

namespace grit {

/// Rotates a vector of the contact history with the contact: by the change of its normal, and about the normal by the
/// mean spin of the two bodies. Lengths are preserved to round-off. A tangential vector stays tangential.
template <class L>
struct Turn {
  Vec<L> normal;    ///< now
  Vec<L> bisector;  ///< normal now + normal before
  L over;           ///< 1 / (bisector · normal)
  L cosine, sine;   ///< of the rotation about the normal

  [[gnu::always_inline]] constexpr Vec<L> operator()(const Vec<L>& v) const {
    const Vec<L> carried = v - (dot(v, normal) * over) * bisector;
    return cosine * carried + sine * cross(normal, carried);
  }
};

/// A contact of bodies a and b, or of body a and wall b. Velocities are those at the middle of the last step.
template <class L>
struct ContactPoint {
  Vec<L> normal;                     ///< unit, from a to b
  L overlap;                         ///< m, > 0 in contact; minus the distance within the reach of the law
  L radius_a, radius_b;              ///< m; for a wall radius_b = radius_a
  L branch_fraction;                 ///< distance of the centres over the sum of the radii; 1 for a wall
  L inverse_mass_a, inverse_mass_b;  ///< 1/kg; 0 for a wall
  Vec<L> velocity;                   ///< of b's surface relative to a's, with the radii as arms [m/s]; zero while both
                                     ///< rotate as one rigid body; its integral over a closed path is zero
  Vec<L> spin;                       ///< of b relative to a [rad/s]
  L dt;                              ///< time step [s]
  Turn<L> turn;                      ///< rotates vectors of the contact history to the present instant

  [[gnu::always_inline]] constexpr Vec<L> tangential(const Vec<L>& v) const { return v - dot(v, normal) * normal; }

  /// The limit of Response::shear [N] at which the shear force on the bodies is `friction` times `normal_force`.
  [[gnu::always_inline]] constexpr L friction_limit(const L& friction, const L& normal_force) const {
    return friction * normal_force * branch_fraction;
  }
};

/// Force and moment of a contact.
template <class L>
struct Response {
  L normal_force{};  ///< N, > 0 in compression
  Vec<L> shear{};    ///< N, on b, in the contact plane: of springs and dashpots that ContactPoint::velocity stretches.
                     ///< Its limit by Coulomb's law is ContactPoint::friction_limit(). The loop divides it by
                     ///< branch_fraction for the force on the bodies, which then does the same work on them
  Vec<L> moment{};   ///< N m, on b; the opposite acts on a
};

/// Energy dissipated by one contact in the last step [J]; that of shear is Response::shear times the slip by
/// ContactPoint::velocity.
template <class L>
struct Loss {
  L friction{}, rolling{}, viscosity{};
};

}  // namespace grit
