// Components of contact laws: springs that rotate with the contact and slip at a limit, and dashpots.
#pragma once

#include "grit/contact/contact_point.hpp"

namespace grit {

/// `v`, with its length limited to `limit` ≥ 0.
template <class L>
[[gnu::always_inline]] constexpr Vec<L> shortened(const Vec<L>& v, const L& limit) {
  return min(L(1.0), limit / max(sqrt(dot(v, v)), L(tiny<L>))) * v;
}

/// A spring in the contact plane: a force [N] with rate = at.velocity and stiffness in N/m, or a moment [N m] with
/// rate = at.spin and stiffness in N m/rad. `stored` rotates with the contact, then changes by the relative motion of
/// the step, against that of b. Not limited yet.
template <class L>
[[gnu::always_inline]] constexpr Vec<L> stretched(const ContactPoint<L>& at, const Vec<L>& stored, const L& stiffness,
                                                  const Vec<L>& rate) {
  return at.turn(stored) - (stiffness * at.dt) * at.tangential(rate);
}

/// Moment [N m] of a spring about the normal, against the relative spin; |moment| ≤ limit. Stiffness in N m/rad.
template <class L>
[[gnu::always_inline]] constexpr L twisted(const ContactPoint<L>& at, const L& stored, const L& stiffness,
                                           const L& limit) {
  const L moment = stored - (stiffness * at.dt) * dot(at.spin, at.normal);
  return max(-limit, min(limit, moment));
}

/// Two springs k = modulus · radius in series, each as long as its radius: 2 k_a k_b / (k_a + k_b) [N/m].
template <class L>
[[gnu::always_inline]] constexpr L spring_in_line(const L& modulus_a, const L& radius_a, const L& modulus_b,
                                                  const L& radius_b) {
  const L a = modulus_a * radius_a, b = modulus_b * radius_b;
  return L(2.0) * a * b / (a + b);
}

/// Coefficient [N s/m] of the dashpot that damps `stiffness` [N/m] by `ratio` of critical; `inverse_mass` [1/kg] is the
/// sum of both bodies. 0 between two fixed bodies.
template <class L>
[[gnu::always_inline]] constexpr L dashpot(const L& ratio, const L& stiffness, const L& inverse_mass) {
  const L product = select(inverse_mass > L(0.0), stiffness / max(inverse_mass, L(tiny<L>)), L(0.0));
  return L(2.0) * ratio * sqrt(product);
}

/// Energy [J] dissipated by slip when stretched() returned `trial` and the limit reduced it to `now`: the mean force of
/// the step times the slip.
template <class L>
[[gnu::always_inline]] constexpr L slip_work(const Vec<L>& before, const Vec<L>& trial, const Vec<L>& now,
                                             const L& stiffness) {
  return L(0.5) * dot(before + now, trial - now) / max(stiffness, L(tiny<L>));
}

/// Energy [J] dissipated by a dashpot parallel to a normal spring with the force `elastic` [N]: its force times the
/// mean of the velocities before and after this instant, without other contacts.
template <class L>
[[gnu::always_inline]] constexpr L dashpot_work(const ContactPoint<L>& at, const L& normal_force, const L& elastic) {
  const L after = dot(at.velocity, at.normal) + L(0.5) * at.dt * normal_force * (at.inverse_mass_a + at.inverse_mass_b);
  return (elastic - normal_force) * after * at.dt;
}

/// Elastic energy [J] of a spring, from the square of its force or moment; 0 without stiffness.
inline double spring_energy(double square, double stiffness) { return stiffness > 0 ? 0.5 * square / stiffness : 0.0; }

}  // namespace grit
