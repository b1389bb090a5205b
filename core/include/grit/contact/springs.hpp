// Parts that laws are composed of: springs that rotate with the contact and slip at a limit, dashpots.
#pragma once

#include "grit/contact/contact_point.hpp"

namespace grit {

/// `v`, shortened to the length `limit` (≥ 0) where it is longer.
template <class L>
[[gnu::always_inline]] inline Vec<L> shortened(const Vec<L>& v, const L& limit) {
  return min(L(1.0), limit / max(sqrt(dot(v, v)), L(tiny<L>))) * v;
}

/// A spring in the contact plane, of a force driven by at.velocity or of a moment driven by at.spin: `stored`
/// rotates with the contact, then grows against the relative motion of b during the step. Not limited yet.
template <class L>
[[gnu::always_inline]] inline Vec<L> stretched(const ContactPoint<L>& at, const Vec<L>& stored, const L& stiffness,
                                               const Vec<L>& rate) {
  return at.turn(stored) - (stiffness * at.dt) * at.tangential(rate);
}

/// A spring about the normal, against the relative spin; |moment| ≤ limit.
template <class L>
[[gnu::always_inline]] inline L twisted(const ContactPoint<L>& at, const L& stored, const L& stiffness,
                                        const L& limit) {
  const L moment = stored - (stiffness * at.dt) * dot(at.spin, at.normal);
  return max(-limit, min(limit, moment));
}

/// Two springs k = modulus · radius in line, each as long as its radius: 2 k_a k_b / (k_a + k_b) [N/m].
template <class L>
[[gnu::always_inline]] inline L spring_in_line(const L& modulus_a, const L& radius_a, const L& modulus_b,
                                               const L& radius_b) {
  const L a = modulus_a * radius_a, b = modulus_b * radius_b;
  return L(2.0) * a * b / (a + b);
}

/// Coefficient [N s/m] of the dashpot that damps `stiffness` [N/m] by `ratio` of critical; 0 between two bodies that
/// cannot be moved.
template <class L>
[[gnu::always_inline]] inline L dashpot(const L& ratio, const L& stiffness, const L& inverse_mass) {
  const L product = select(inverse_mass > L(0.0), stiffness / max(inverse_mass, L(tiny<L>)), L(0.0));
  return L(2.0) * ratio * sqrt(product);
}

/// Energy [J] dissipated by slip, where a spring `trial` of stretched() was shortened to `now`: the mean force of the
/// step times the slip.
template <class L>
[[gnu::always_inline]] inline L slip_work(const Vec<L>& before, const Vec<L>& trial, const Vec<L>& now,
                                          const L& stiffness) {
  return L(0.5) * dot(before + now, trial - now) / max(stiffness, L(tiny<L>));
}

/// Energy [J] dissipated by a dashpot beside the normal spring `elastic` [N]: its force times the mean velocity before
/// and after this instant, as if no other contact acted.
template <class L>
[[gnu::always_inline]] inline L dashpot_work(const ContactPoint<L>& at, const L& normal_force, const L& elastic) {
  const L after = dot(at.velocity, at.normal) + L(0.5) * at.dt * normal_force * (at.inverse_mass_a + at.inverse_mass_b);
  return (elastic - normal_force) * after * at.dt;
}

/// Elastic energy [J] of a spring that carries the force or moment whose square is given; 0 for no spring.
inline double spring_energy(double square, double stiffness) { return stiffness > 0 ? 0.5 * square / stiffness : 0.0; }

}  // namespace grit
