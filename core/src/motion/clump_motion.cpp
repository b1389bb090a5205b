#include "motion/clump_motion.hpp"

#include <algorithm>
#include <cmath>

#include "motion/rigid_step.hpp"

namespace grit {
namespace {

/// Local damping by components, as for spheres: reduces what accelerates, increases what decelerates.
Vec3 damped(const Vec3& push, const Vec3& velocity, double coefficient) {
  return push.binaryExpr(
      velocity, [=](double p, double v) { return p - coefficient * (v != 0 ? std::copysign(std::abs(p), v) : 0.0); });
}

// Rotations in a step are small. Up to this angle a few terms of the series are exact to rounding and take a tenth of
// the time of the functions.
constexpr double little = 0.02;

/// Sine and cosine to rounding.
struct SineCosine {
  double sine, cosine;
};
SineCosine sine_cosine(double angle) {
  if (std::abs(angle) > little) return {std::sin(angle), std::cos(angle)};
  const double s = angle * angle;
  return {angle - angle * s * (1.0 / 6 - s * (1.0 / 120 - s * (1.0 / 5040))),
          1 - s * (1.0 / 2 - s * (1.0 / 24 - s * (1.0 / 720)))};
}
/// Arc sine over its argument, to rounding; `square` is the square of the argument.
double arc_over_sine(double square) {
  if (square > little * little) {
    const double sine = std::sqrt(std::min(square, 1.0));
    return std::asin(sine) / sine;
  }
  return 1 + square * (1.0 / 6 + square * (3.0 / 40 + square * (5.0 / 112 + square * (35.0 / 1152))));
}

/// Rotates about one principal axis with the angular velocity of the momentum along this axis; `time` is divided by
/// twice the moment of inertia.
template <int axis>
[[gnu::always_inline]] inline void turn_about(double time, Eigen::Quaterniond& orientation, Vec3& momentum) {
  constexpr int next = (axis + 1) % 3, last = (axis + 2) % 3;
  const auto [sine, cosine] = sine_cosine(time * momentum[axis]);
  // orientation · (cosine, sine along the axis)
  auto& q = orientation.coeffs();  // x, y, z, w
  const double along = q[axis], one = q[next], other = q[last], scalar = q[3];
  q[3] = cosine * scalar - sine * along, q[axis] = cosine * along + sine * scalar;
  q[next] = cosine * one + sine * other, q[last] = cosine * other - sine * one;
  // In the frame of the axes, the momentum rotates by the opposite of the whole angle.
  const double double_sine = 2 * sine * cosine, double_cosine = 1 - 2 * sine * sine;
  const double p = momentum[next], r = momentum[last];
  momentum[next] = double_cosine * p + double_sine * r, momentum[last] = double_cosine * r - double_sine * p;
}

/// Rotates a clump to a new orientation; `turn` is the rotation from the old one.
void set_orientation(const Eigen::Quaterniond& now, Eigen::Quaterniond turn, double dt, Clump& clump) {
  if (turn.w() < 0) turn.coeffs() *= -1;
  clump.orientation = now;
  clump.axes = now.toRotationMatrix();
  clump.half_turn = turn.vec() / turn.w();
  clump.chord_rate = 2 / (dt * (1 + clump.half_turn.squaredNorm()));
  clump.spin = 2 * arc_over_sine(turn.vec().squaredNorm()) / dt * turn.vec();
}

void turn_freely(Clump& clump, double dt) {
  Eigen::Quaterniond now = clump.orientation;
  Vec3 momentum = clump.axes.transpose() * clump.momentum;
  const Vec3 time = 0.5 * dt * clump.inertia.cwiseInverse();
  turn_about<0>(0.5 * time[0], now, momentum);
  turn_about<1>(0.5 * time[1], now, momentum);
  turn_about<2>(time[2], now, momentum);
  turn_about<1>(0.5 * time[1], now, momentum);
  turn_about<0>(0.5 * time[0], now, momentum);
  // It was normalised before, so that one Newton step normalises it to rounding.
  now.coeffs() *= 1.5 - 0.5 * now.squaredNorm();
  set_orientation(now, now * clump.orientation.conjugate(), dt, clump);
}

double kinetic_energy(const Clump& clump) {
  return 0.5 * clump.velocity.squaredNorm() / clump.inverse_mass +
         0.5 * clump.spin_of(clump.momentum).dot(clump.momentum);
}

/// Moves a clump whose motion is prescribed; returns the change of its kinetic energy [J].
double move_rigidly(const RigidStep& motion, double dt, Clump& clump) {
  const double before = kinetic_energy(clump);
  clump.velocity = motion.velocity_at(clump.centre);
  clump.centre += dt * clump.velocity;
  // Normalised by one Newton step.
  Eigen::Quaterniond now = motion.turn() * clump.orientation;
  now.coeffs() *= 1.5 - 0.5 * now.squaredNorm();
  set_orientation(now, motion.turn(), dt, clump);
  clump.momentum = clump.axes * clump.inertia.cwiseProduct(clump.axes.transpose() * motion.spin());
  return kinetic_energy(clump) - before;
}

/// This number of periods, or of their growths.
[[gnu::always_inline]] inline Vec3 across_sides(const Vec3& periods, const Vec3& length, const Vec3& tilt,
                                                bool skewed) {
  const Vec3 straight = periods.cwiseProduct(length);
  if (!skewed) return straight;
  return straight + Vec3(periods.y() * tilt[0] + periods.z() * tilt[1], periods.z() * tilt[2], 0);
}

/// The velocity that the mean flow of a cell adds at `place` from its centre.
[[gnu::always_inline]] inline Vec3 flow_at(const Vec3& place, const MotionStep& step, bool shears) {
  const Vec3 stretching = step.strain_rate.cwiseProduct(place);
  if (!shears) return stretching;
  const Vec3& rate = step.shear_rate;
  return stretching + Vec3(rate[0] * place.y() + rate[1] * place.z(), rate[2] * place.z(), 0);
}

/// Moves a body with its clump; its velocity is its displacement in the step over the step.
[[gnu::always_inline]] inline void carry(std::uint32_t body, const Clump& clump, Bodies& bodies, const MotionStep& step,
                                         bool skewed) {
  const ClumpSphere& own = bodies.clumps.of_body[body];
  const Vec3 arm = clump.axes * own.place;
  const Vec3 periods(own.periods[0], own.periods[1], own.periods[2]);
  // Chord of the arc over the step: from the arm before the rotation to the arm.
  const Vec3 across = clump.half_turn.cross(arm);
  const Vec3 v = clump.velocity + clump.chord_rate * (across - clump.half_turn.cross(across)) -
                 across_sides(periods, step.period_growth, step.tilt_growth, skewed);
  const Vec3 x = clump.centre + arm - across_sides(periods, step.period, step.tilt, skewed);
  Row &position = bodies.position[body], &velocity = bodies.velocity[body], &spin = bodies.spin[body];
  position.x = x.x(), position.y = x.y(), position.z = x.z();
  velocity.x = v.x(), velocity.y = v.y(), velocity.z = v.z();
  spin.x = clump.spin.x(), spin.y = clump.spin.y(), spin.z = clump.spin.z();
}

/// Prefetches: spheres of a clump are in spatial order, which the processor cannot predict.
constexpr std::size_t fetched_ahead = 3;
void fetch(const Clump& clump, const Bodies& bodies, const BodySum* sum) {
  for (std::uint32_t k = clump.first; k < clump.last; ++k) {
    const std::uint32_t body = bodies.clumps.spheres[k];
    __builtin_prefetch(&sum[body]);
    __builtin_prefetch(&bodies.clumps.of_body[body]);
    __builtin_prefetch(&bodies.position[body], 1);
    __builtin_prefetch(&bodies.velocity[body], 1);
    __builtin_prefetch(&bodies.spin[body], 1);
  }
}

}  // namespace

ClumpLoad load_of(const Clump& clump, const Bodies& bodies, const BodySum* sum) {
  ClumpLoad load{Vec3::Zero(), Vec3::Zero()};
  for (std::uint32_t k = clump.first; k < clump.last; ++k) {
    const std::uint32_t body = bodies.clumps.spheres[k];
    const Vec3 arm = clump.axes * bodies.clumps.of_body[body].place, force = xyz(sum[body].force);
    load.force += force;
    load.moment += xyz(sum[body].moment) + arm.cross(force);
  }
  return load;
}

Motion move_clumps(std::size_t first, std::size_t last, Bodies& bodies, const BodySum* sum, const MotionStep& step) {
  Motion motion;
  const bool shears = step.shears(), skewed = !step.tilt.isZero(0.0) || !step.tilt_growth.isZero(0.0);
  for (std::size_t c = first; c < last; ++c) {
    fetch(bodies.clumps.clump[std::min(c + fetched_ahead, last - 1)], bodies, sum);
    Clump& clump = bodies.clumps.clump[c];
    const MotionSettings& settings = step.of(bodies.clumps.spheres[clump.first]);
    if (settings.prescribed) {
      motion.prescribed += move_rigidly(RigidStep(*settings.prescribed, step.drift), step.drift, clump);
      motion.fallen += step.drift * settings.gravity_on(clump.radius).dot(clump.velocity) / clump.inverse_mass;
      for (std::uint32_t k = clump.first; k < clump.last; ++k)
        carry(bodies.clumps.spheres[k], clump, bodies, step, skewed);
      continue;
    }
    const Vec3 free = settings.free_translation(), turns = settings.free_rotation(),
               gravity = settings.gravity_on(clump.radius);
    const ClumpLoad load = load_of(clump, bodies, sum);
    const Vec3 before = clump.velocity;
    const Vec3 carried = shears ? Vec3(step.flowed * flow_at(before, step, true))
                                : Vec3((step.flowed * step.strain_rate).cwiseProduct(before));
    clump.velocity += carried;
    const Vec3 flow = flow_at(clump.centre - step.centre, step, shears);
    Vec3 push = step.kick * free.cwiseProduct(clump.inverse_mass * load.force + gravity);
    Vec3 twist = step.kick * turns.cwiseProduct(load.moment);
    if (settings.local_damping > 0) {
      const Vec3 pushed = damped(push, clump.velocity - flow, settings.local_damping);
      const Vec3 twisted = damped(twist, clump.spin, settings.local_damping);
      if (step.energies) {
        motion.damped += (push - pushed).dot(clump.velocity - flow + 0.5 * pushed) / clump.inverse_mass +
                         (twist - twisted).dot(clump.spin_of(clump.momentum + 0.5 * twisted));
        motion.carried -= (push - pushed).dot(flow) / clump.inverse_mass;
      }
      push = pushed, twist = twisted;
    }
    clump.velocity += push, clump.momentum += twist;
    clump.centre += step.drift * clump.velocity;
    if (step.energies) {
      motion.fallen += step.drift * gravity.dot(clump.velocity) / clump.inverse_mass;
      motion.carried += 0.5 * carried.dot(before + clump.velocity) / clump.inverse_mass;
    }
    turn_freely(clump, step.drift);
    for (std::uint32_t k = clump.first; k < clump.last; ++k)
      carry(bodies.clumps.spheres[k], clump, bodies, step, skewed);
  }
  return motion;
}

}  // namespace grit
