// A prescribed rigid motion during one step.
#pragma once

#include <Eigen/Geometry>

#include "grit/engine.hpp"

namespace grit {

class RigidStep {
 public:
  RigidStep(const RigidMotion& motion, double dt) : motion_(motion), dt_(dt) {
    const double angle = dt * motion.spin.norm();
    if (angle > 0) turn_ = Eigen::AngleAxisd(angle, motion.spin.normalized());
    matrix_ = turn_.toRotationMatrix();
  }

  /// The mean velocity of a point in the step [m/s]: its displacement over the step. `place`: where it is before [m].
  Vec3 velocity_at(const Vec3& place) const {
    if (motion_.spin.isZero(0.0)) return motion_.velocity;
    const Vec3 arm = place - motion_.about;
    return motion_.velocity + (matrix_ * arm - arm) / dt_;
  }
  const Vec3& spin() const { return motion_.spin; }
  const Eigen::Quaterniond& turn() const { return turn_; }

 private:
  RigidMotion motion_;
  double dt_;
  Eigen::Quaterniond turn_ = Eigen::Quaterniond::Identity();
  Mat3 matrix_;
};

}  // namespace grit
