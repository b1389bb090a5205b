#include "engines/clump_motion.hpp"

#include <cmath>

namespace grit {
namespace {

/// Component by component, as of spheres: lessens what speeds up, adds to what slows down.
Vec3 damped(const Vec3& push, const Vec3& velocity, double coefficient) {
  const Vec3 power = push.cwiseProduct(velocity);
  return push.binaryExpr(power, [=](double p, double w) {
    return w > 0 ? (1 - coefficient) * p : w < 0 ? (1 + coefficient) * p : p;
  });
}

/// Turns for `time` about one principal axis by the angular velocity that the momentum along it alone would give.
void turn_about(int axis, double time, const Vec3& inertia, Eigen::Quaterniond& orientation, Vec3& momentum) {
  const double half = 0.5 * time * momentum[axis] / inertia[axis];
  const double sine = std::sin(half), cosine = std::cos(half);
  Vec3 vector = Vec3::Zero();
  vector[axis] = sine;
  const Eigen::Quaterniond turn(cosine, vector.x(), vector.y(), vector.z());
  orientation = orientation * turn;
  momentum = turn.conjugate() * momentum;
}

void turn_freely(Clump& clump, double dt) {
  const Eigen::Quaterniond before = clump.orientation;
  Vec3 momentum = clump.axes.transpose() * clump.momentum;
  for (const auto& [axis, share] : {std::pair(0, 0.5), {1, 0.5}, {2, 1.0}, {1, 0.5}, {0, 0.5}})
    turn_about(axis, share * dt, clump.inertia, clump.orientation, momentum);
  clump.orientation.normalize();
  clump.axes = clump.orientation.toRotationMatrix();
  Eigen::Quaterniond turn = clump.orientation * before.conjugate();
  if (turn.w() < 0) turn.coeffs() *= -1;
  const double sine = turn.vec().norm(), angle = 2 * std::atan2(sine, turn.w());
  clump.spin = (sine > 0 ? angle / sine : 2.0) / dt * turn.vec();
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
  const MotionSettings& settings = step.settings;
  const Vec3 free = step.free_translation(), turns = step.free_rotation();
  for (std::size_t c = first; c < last; ++c) {
    Clump& clump = bodies.clumps.clump[c];
    const ClumpLoad load = load_of(clump, bodies, sum);
    clump.velocity += (step.flowed * step.strain_rate).cwiseProduct(clump.velocity);
    const Vec3 flow = step.strain_rate.cwiseProduct(clump.centre - step.centre);
    Vec3 push = step.kick * free.cwiseProduct(clump.inverse_mass * load.force + settings.gravity);
    Vec3 twist = step.kick * turns.cwiseProduct(load.moment);
    if (settings.local_damping > 0) {
      const Vec3 pushed = damped(push, clump.velocity - flow, settings.local_damping);
      const Vec3 twisted = damped(twist, clump.spin, settings.local_damping);
      if (step.energies)
        motion.damped += (push - pushed).dot(clump.velocity + 0.5 * pushed) / clump.inverse_mass +
                         (twist - twisted).dot(clump.spin_of(clump.momentum + 0.5 * twisted));
      push = pushed, twist = twisted;
    }
    clump.velocity += push, clump.momentum += twist;
    clump.centre += step.drift * clump.velocity;
    if (step.energies) motion.fallen += step.drift * settings.gravity.dot(clump.velocity) / clump.inverse_mass;
    turn_freely(clump, step.drift);
  }
  return motion;
}

double carry(std::size_t body, Bodies& bodies, const MotionStep& step) {
  const ClumpSphere& own = bodies.clumps.of_body[body];
  const Clump& clump = bodies.clumps.clump[own.clump];
  const Vec3 arm = clump.axes * own.place;
  const Vec3 periods(own.periods[0], own.periods[1], own.periods[2]);
  // The chord of the arc over the step: the mean arm turned by twice the tangent of half the angle.
  const double angle = step.drift * clump.spin.norm();
  const Vec3 half = (angle > 0 ? std::tan(0.5 * angle) / angle : 0.5) * step.drift * clump.spin;
  const Vec3 mean_arm = (arm - half.cross(arm) + half.dot(arm) * half) / (1 + half.squaredNorm());
  const Vec3 v = clump.velocity + 2 / step.drift * half.cross(mean_arm) - periods.cwiseProduct(step.period_growth);
  const Vec3 x = clump.centre + arm - periods.cwiseProduct(step.period);
  const Vec3 flow = step.strain_rate.cwiseProduct(xyz(bodies.position[body]) - step.centre);
  bodies.position[body] = {x.x(), x.y(), x.z(), bodies.position[body].w};
  bodies.velocity[body] = {v.x(), v.y(), v.z(), bodies.velocity[body].w};
  bodies.spin[body] = {clump.spin.x(), clump.spin.y(), clump.spin.z(), bodies.spin[body].w};
  return (v - flow).norm();
}

}  // namespace grit
