// The step of one free body, for registers of four numbers and for devices.
#pragma once

#include "grit/engine.hpp"
#include "grit/vec.hpp"
#include "motion/motion.hpp"

namespace grit {

/// Four numbers where there are no registers of four.
struct Four {
  double n[4];

  constexpr double operator[](int k) const { return n[k]; }
  friend constexpr Four operator+(const Four& a, const Four& b) {
    return {{a.n[0] + b.n[0], a.n[1] + b.n[1], a.n[2] + b.n[2], a.n[3] + b.n[3]}};
  }
  friend constexpr Four operator-(const Four& a, const Four& b) {
    return {{a.n[0] - b.n[0], a.n[1] - b.n[1], a.n[2] - b.n[2], a.n[3] - b.n[3]}};
  }
  friend constexpr Four operator*(const Four& a, const Four& b) {
    return {{a.n[0] * b.n[0], a.n[1] * b.n[1], a.n[2] * b.n[2], a.n[3] * b.n[3]}};
  }
  friend constexpr Four operator*(const Four& a, double b) {
    return {{a.n[0] * b, a.n[1] * b, a.n[2] * b, a.n[3] * b}};
  }
  friend constexpr Four operator*(double a, const Four& b) { return b * a; }
};

/// yes where `sign` is positive, no where it is negative, else `none`; number by number.
[[gnu::always_inline]] inline Quad by_sign(const Quad& sign, const Quad& yes, const Quad& no, const Quad& none) {
  return sign > 0 ? yes : sign < 0 ? no : none;
}
constexpr Four by_sign(const Four& sign, const Four& yes, const Four& no, const Four& none) {
  Four chosen{};
  for (int k = 0; k < 4; ++k) chosen.n[k] = sign[k] > 0 ? yes[k] : sign[k] < 0 ? no[k] : none[k];
  return chosen;
}

/// Local damping: reduces components that accelerate the body, increases those that decelerate it; no effect at rest.
template <class Q>
[[gnu::always_inline]] constexpr Q damped(const Q& force, const Q& velocity, double coefficient) {
  return by_sign(force * velocity, force * (1 - coefficient), force * (1 + coefficient), force);
}

/// Share of a body's mass on which gravity acts; see MotionSettings::unscaled_share().
constexpr double weighing_share(double radius, double scaled_radius) {
  if (!(radius < scaled_radius)) return 1;
  const double ratio = radius / scaled_radius;
  return ratio * ratio * ratio;
}

/// What a step does to bodies with the same settings. The fourth numbers are 0.
template <class Q>
struct Kick {
  Q kick, turn_kick;  ///< times during which forces and moments act [s]; 0 in directions that are not free
  Q fall;             ///< change of velocity by gravity [m/s]
  double damping, scaled_radius;
};

/// The mean flow of a deforming cell in a step. The fourth numbers are 0.
template <class Q>
struct MeanFlowStep {
  Q rate, centre;  ///< 1/s, m
  Q growth;        ///< rate times `flowed`
  double flowed;   ///< previous step, in which bodies moved with the flow [s]
  double xy, xz, yz;

  /// The velocity that the gradients xy, xz and yz add at a place from the centre.
  [[gnu::always_inline]] constexpr Q sheared(const Q& place) const {
    return Q{xy * place[1] + xz * place[2], yz * place[2], 0, 0};
  }
};

template <class Q>
[[gnu::always_inline]] inline Q as_four(const Vec3& v) {
  return Q{v.x(), v.y(), v.z(), 0};
}
template <class Q>
Kick<Q> kick_of(const MotionSettings& settings, const MotionStep& step) {
  const Q free = as_four<Q>(settings.free_translation());
  return {.kick = step.kick * free,
          .turn_kick = step.kick * as_four<Q>(settings.free_rotation()),
          .fall = free * as_four<Q>(settings.gravity * step.kick),
          .damping = settings.local_damping,
          .scaled_radius = settings.scaled_radius};
}
template <class Q>
MeanFlowStep<Q> mean_flow_of(const MotionStep& step) {
  return {.rate = as_four<Q>(step.strain_rate),
          .centre = as_four<Q>(step.centre),
          .growth = as_four<Q>(step.strain_rate) * step.flowed,
          .flowed = step.flowed,
          .xy = step.shear_rate[0],
          .xz = step.shear_rate[1],
          .yz = step.shear_rate[2]};
}

/// Terms of the step of one body: velocity = free + pushed, spin = spin before + twisted.
template <class Q>
struct BodyStep {
  Q flow;            ///< mean flow at the body
  Q free;            ///< velocity without forces: the mean flow at a body changes as the body moves with it
  Q push, pushed;    ///< change of velocity by forces without and with damping
  Q twist, twisted;  ///< the same of the spin
};

template <bool Shears, class Q>
[[gnu::always_inline]] constexpr BodyStep<Q> step_of_body(const Q& position, const Q& velocity, const Q& spin,
                                                          const Q& force, const Q& moment, double inverse_mass,
                                                          double inverse_inertia, double share, const Kick<Q>& own,
                                                          const MeanFlowStep<Q>& mean) {
  BodyStep<Q> step{};
  step.free = velocity + mean.growth * velocity;
  step.flow = mean.rate * (position - mean.centre);
  if constexpr (Shears) {
    step.free = step.free + mean.flowed * mean.sheared(velocity);
    step.flow = step.flow + mean.sheared(position - mean.centre);
  }
  step.push = force * (own.kick * inverse_mass) + own.fall * share;
  step.twist = moment * (own.turn_kick * inverse_inertia);
  step.pushed = step.push, step.twisted = step.twist;
  if (own.damping > 0) {
    step.pushed = damped(step.push, step.free - step.flow, own.damping);
    step.twisted = damped(step.twist, spin, own.damping);
  }
  return step;
}

}  // namespace grit
