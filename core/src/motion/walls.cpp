#include "motion/walls.hpp"

#include <spdlog/fmt/fmt.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "description/placed_error.hpp"
#include "description/servo_face.hpp"
#include "grit/error.hpp"

namespace grit {

namespace {

/// Averaging time of a servo's velocity in steps, times the gain; longer than a stack of some dozens of grains
/// responds.
constexpr double habit_steps = 30;
/// Factor by which a servo weights the dashpots of its contacts. Their forces follow a change of its velocity
/// immediately, but the servo reads them one step late. With a factor of 1, a gain of 1 oscillates on dashpots that are
/// stable in isolation; with 3, no gain does at 0.8 of the critical step (eigenvalues in tests/stability/servo.cpp).
constexpr double dashpots_counted = 3;
/// Relative error of the force of a servo above which it is reported.
constexpr double most_behind = 0.05;
/// Fraction of the target force that a servo may always add in one step.
constexpr double always_added = 0.25;
/// Number of halvings after which the displacement in a step is practically zero.
constexpr int most_halvings = 50;
/// Minimum number of steps per period of an oscillation: there the mean velocity of a step differs from that at its
/// middle by (ω dt)²/24 = 0.4 %.
constexpr double steps_to_a_period = 20;

/// `key`: the key of the motion at fault.
[[noreturn]] void fail(const std::string& wall, const std::string& key, const std::string& what) {
  throw PlacedError({"walls", wall, "motion", key}, "wall \"" + wall + "\": " + what);
}
[[noreturn]] void fail(const WallSetup& setup, const std::string& what) {
  throw PlacedError({"walls", setup.name, "motion"}, "wall \"" + setup.name + "\": " + what);
}

std::array<bool, 3> axes_of(const WallSetup& setup, const std::string& motion, const std::string& letters) {
  std::array<bool, 3> axes{};
  for (const char letter : letters) {
    if (letter < 'x' || letter > 'z') fail(setup, motion + " along \"" + letters + "\"; allowed is x, y or z");
    axes[as_index(letter - 'x')] = true;
  }
  if (letters.empty()) fail(setup, motion + " has no axis; give one or more of x, y and z");
  return axes;
}

/// The same pose with another reference point.
void change_reference(const Vec3& about, WallState& state) {
  if (about == state.pose.about) return;
  const Vec3 before = state.pose.about + state.pose.shift, now = state.pose.to_world(about), shift = now - about;
  state.stage_start += shift - state.pose.shift;
  state.moment += (before - now).cross(state.force);
  state.velocity += state.spin.cross(now - before);
  state.pose.about = about;
  state.pose.shift = shift;
}

void check_oscillation(const std::string& wall, const MotionDescription& motion, double dt) {
  if (!motion.oscillation) return;
  const double frequency = motion.oscillation->frequency;
  if (frequency * dt * steps_to_a_period > 1)
    fail(wall, "oscillation",
         fmt::format("oscillates at {:.4g} Hz, with {:.3g} steps of {:.4g} s per period; allowed is {:g} or "
                     "more: lower the frequency, or shorten the time step by /time_step/safety or "
                     "/time_step/value",
                     frequency, 1 / (frequency * dt), dt, steps_to_a_period));
}

/// Default reference point of a wall: the centre of its bounds; 0 along axes where they are infinite.
Vec3 middle(const Geometry& geometry) {
  const Bounds bounds = geometry.bounds();
  Vec3 middle = 0.5 * (bounds.low + bounds.high);
  for (int axis = 0; axis < 3; ++axis)
    if (!std::isfinite(middle[axis])) middle[axis] = 0;
  return middle;
}

/// Displacement of an oscillation of amplitude 1 and this phase at a time [s] after its start.
double swing(const MotionDescription& motion, double phase, double time, double lead) {
  const OscillationDescription& how = *motion.oscillation;
  const double periods = how.frequency * time + lead,
               ramp = motion.ramp_time > 0 ? std::min(1.0, time / motion.ramp_time) : 1;
  const double angle = 2 * std::numbers::pi * (periods - std::floor(periods)) + phase;
  return ramp * (std::sin(angle) - std::sin(phase));
}

/// Mean velocities of oscillations of amplitude 1 and these phases in the next step of dt [s].
Vec3 swing_velocities(const MotionDescription& motion, const Vec3& phases, const WallState& state, double dt) {
  const auto one = [&](double phase) {
    return (swing(motion, phase, state.swing_time + dt, state.swing_lead) -
            swing(motion, phase, state.swing_time, state.swing_lead)) /
           dt;
  };
  return {one(phases.x()), one(phases.y()), one(phases.z())};
}

/// Updates an oscillation after a change of motion: it continues from its present phase at the new frequency, or
/// starts.
void swing_on(const MotionDescription& motion, WallState& state) {
  const OscillationDescription how = motion.oscillation.value_or(OscillationDescription{});
  const Vec3 phases = how.phases_of_displacement(), angle_phases = how.phases_of_rotation();
  if (state.swing_frequency > 0 && how.frequency > 0 && state.swing_phases == phases &&
      state.swing_angle_phases == angle_phases)
    state.swing_lead += (state.swing_frequency - how.frequency) * state.swing_time;
  else state.swing_time = state.swing_lead = 0;
  state.swing_frequency = how.frequency, state.swing_phases = phases, state.swing_angle_phases = angle_phases;
}

/// A wall that is free to rotate keeps the component of its spin along the axis.
void keep_spin_along(const Vec3& axis, WallState& state) {
  constexpr double rounding = 1e-12;
  if (axis.isZero(0.0) || axis.cross(state.spin).norm() <= rounding * state.spin.norm()) return;
  state.spin = axis.dot(state.spin) * axis;
}

/// Component of the normal of a servo's wall along its axis. Throws if it is zero.
double facing(const WallSetup& setup, const Pose& pose) {
  const Vec3 normal = pose.turn * setup.geometry->normal();
  if (const std::string why = presses_with_nothing(setup.motion, *setup.geometry, normal); !why.empty())
    fail(setup.name, "servo", why);
  return normal[setup.motion.servo->axis.front() - 'x'];
}

/// A servo reads the effect of a step only afterwards: a stiff grain, or many grains of one height, could carry a
/// multiple of the target force in the step in which they come into contact. Therefore a step moves the wall at most to
/// where the estimated force reaches the target; `velocity` is the requested one.
double braked(double velocity, std::size_t wall, int axis, double wanted, const WallState& state, double dt,
              const Walls::Ahead& ahead) {
  if (ahead == nullptr || !(velocity * wanted > 0)) return velocity;
  const double most = std::abs(wanted), borne = -std::copysign(1.0, wanted) * state.force[axis],
               may_add = std::max(most - borne, always_added * most);
  // Cheap bound that suffices in nearly all steps: the force if all nearby bodies were as stiff as those in contact.
  if ((state.stiffness * dt + state.dashpot) * std::abs(velocity) * state.near < always_added * most * state.contacts)
    return velocity;
  for (int halving = 0; halving < most_halvings; ++halving) {
    const Vec3 moves = velocity * Vec3::Unit(axis);
    Pose there = state.pose;
    there.shift += dt * moves;
    if (ahead(wall, there, moves, std::abs(velocity) * dt) - ahead(wall, state.pose, moves, 0) <= may_add) break;
    velocity *= 0.5;
  }
  return velocity;
}

/// Moves like a dashpot relative to the recent mean velocity of the wall. It corrects the fraction `gain` of the force
/// error in one step if contacts are springs, less with dashpots, and leaves no error when the specimen expands or
/// contracts steadily.
double servo_velocity(const WallSetup& setup, std::size_t wall, int axis, double area, WallState& state, double dt,
                      const Walls::Ahead& ahead) {
  const ServoDescription& servo = *setup.motion.servo;
  const double wanted = servo.force ? *servo.force : *servo.pressure * area * facing(setup, state.pose);
  if (state.contacts == 0 || !(state.stiffness > 0)) {  // no contact yet: close
    state.habit = 0;
    return wanted != 0 ? braked(std::copysign(servo.max_velocity, wanted), wall, axis, wanted, state, dt, ahead) : 0;
  }
  const double wished = state.habit + servo.gain * (state.force[axis] + wanted) /
                                          (state.stiffness * dt + dashpots_counted * state.dashpot);
  const double velocity =
      braked(std::clamp(wished, -servo.max_velocity, servo.max_velocity), wall, axis, wanted, state, dt, ahead);
  state.habit += servo.gain / habit_steps * (velocity - state.habit);
  return velocity;
}

}  // namespace

std::vector<WallSetup> wall_setups(const SceneDescription& scene, const Components& components) {
  std::vector<WallSetup> setups;
  for (const auto& [name, wall] : scene.walls) setups.push_back({name, components.geometries.at(name), wall.motion});
  return setups;
}

Pose moved(Pose pose, const WallMotion& motion, double dt) {
  pose.shift += dt * motion.velocity;
  const double angle = dt * motion.spin.norm();
  if (angle == 0) return pose;  // the rotation of a wall without spin stays exactly the identity
  const Mat3 turn = Eigen::AngleAxisd(angle, motion.spin.normalized()) * pose.turn;
  pose.turn = Eigen::Quaterniond(turn).normalized().toRotationMatrix();
  return pose;
}

void check_oscillations(const SceneDescription& scene, double dt) {
  for (const auto& [name, wall] : scene.walls) check_oscillation(name, wall.motion, dt);
}

void Walls::check_oscillations(double dt) const {
  for (const WallSetup& setup : setups_) check_oscillation(setup.name, setup.motion, dt);
}

void Walls::apply(std::vector<WallSetup> setups) {
  change(std::move(setups));
  for (WallState& state : states_) {
    state.stage_start = state.pose.shift;
    state.stage_time = 0;
  }
}

void Walls::change(std::vector<WallSetup> setups) {
  std::vector<Drive> drives;
  std::vector<WallState> states;
  for (const WallSetup& setup : setups) {
    const auto known =
        std::find_if(setups_.begin(), setups_.end(), [&](const auto& old) { return old.name == setup.name; });
    WallState state;
    if (known != setups_.end()) state = states_[static_cast<std::size_t>(known - setups_.begin())];
    else state.pose.about = middle(*setup.geometry);
    swing_on(setup.motion, state);
    change_reference(setup.motion.about.value_or(state.pose.about), state);
    drives.push_back(drive_of(setups, setup));
    keep_spin_along(drives.back().free_axis, state);
    if (drives.back().servo_axis >= 0 && setup.motion.servo->pressure) facing(setup, state.pose);
    states.push_back(state);
  }
  order_ = leaders_first(setups, drives);
  setups_ = std::move(setups);
  drives_ = std::move(drives);
  states_ = std::move(states);
}

Walls::Drive Walls::drive_of(const std::vector<WallSetup>& setups, const WallSetup& setup) {
  const MotionDescription& motion = setup.motion;
  Drive drive;
  Axes servo{};
  if (motion.servo) {
    servo = axes_of(setup, "servo", motion.servo->axis);
    if (std::count(servo.begin(), servo.end(), true) != 1)
      fail(setup, "a servo along \"" + motion.servo->axis + "\"; allowed is one axis");
    if (!(motion.servo->max_velocity > 0)) fail(setup, "a servo needs max_velocity above 0");
    if (motion.servo->pressure.has_value() == motion.servo->force.has_value())
      fail(setup, "a servo needs either a pressure or a force");
    drive.servo_axis = static_cast<int>(std::find(servo.begin(), servo.end(), true) - servo.begin());
  }
  if (motion.follow) {
    drive.follow = axes_of(setup, "following", motion.follow->axes);
    const auto leader =
        std::find_if(setups.begin(), setups.end(), [&](const auto& s) { return s.name == motion.follow->wall; });
    if (leader == setups.end()) fail(setup, "follows the wall \"" + motion.follow->wall + "\", which does not exist");
    drive.leader = static_cast<std::size_t>(leader - setups.begin());
  }
  if (motion.free) {
    drive.free = axes_of(setup, "free", motion.free->axes);
    if (!(motion.free->mass > 0)) fail(setup, "a free wall needs a mass above 0");
  }
  if (motion.free_rotation) {
    if (!(motion.free_rotation->inertia > 0)) fail(setup, "free rotation needs an inertia above 0");
    if (!(motion.free_rotation->axis.norm() > 0)) fail(setup, "free rotation needs an axis of a length above 0");
    if (!motion.spin.isZero(0.0) || (motion.oscillation && !motion.oscillation->angle.isZero(0.0)))
      fail(setup, "two rotations; choose spin and oscillation, or free_rotation");
    drive.free_axis = motion.free_rotation->axis.normalized();
  }
  for (int axis = 0; axis < 3; ++axis) {
    const bool swings = motion.oscillation && motion.oscillation->amplitude[axis] != 0;
    if ((motion.velocity[axis] != 0 || swings) + servo[as_index(axis)] + drive.follow[as_index(axis)] +
            drive.free[as_index(axis)] >
        1)
      fail(setup, std::string("two motions along ") + "xyz"[axis] +
                      "; choose velocity and oscillation, or one of servo, follow and free");
  }
  return drive;
}

std::vector<std::size_t> Walls::leaders_first(const std::vector<WallSetup>& setups, const std::vector<Drive>& drives) {
  enum class Mark { unseen, waiting, placed };
  std::vector<Mark> marks(setups.size(), Mark::unseen);
  std::vector<std::size_t> order;
  const std::function<void(std::size_t)> place = [&](std::size_t wall) {
    if (marks[wall] == Mark::placed) return;
    if (marks[wall] == Mark::waiting) fail(setups[wall], "follows itself, directly or through other walls");
    marks[wall] = Mark::waiting;
    if (setups[wall].motion.follow) place(drives[wall].leader);
    marks[wall] = Mark::placed;
    order.push_back(wall);
  };
  for (std::size_t wall = 0; wall < setups.size(); ++wall) place(wall);
  return order;
}

Vec3 Walls::point_velocity(std::size_t wall, const Vec3& point) const {
  return states_[wall].velocity + states_[wall].spin.cross(point - reference(wall));
}

WallMotion Walls::expected_motion(std::size_t wall) const {
  const MotionDescription& motion = setups_[wall].motion;
  const Drive& how = drives_[wall];
  const WallState& state = states_[wall];
  WallMotion expected{motion.velocity, motion.spin};
  if (motion.oscillation) {
    const double peak = 2 * std::numbers::pi * motion.oscillation->frequency;
    for (int axis = 0; axis < 3; ++axis)
      expected.velocity[axis] += std::copysign(peak * motion.oscillation->amplitude[axis], expected.velocity[axis]);
    expected.spin += peak * motion.oscillation->angle;
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (how.free[as_index(axis)]) expected.velocity[axis] = state.velocity[axis];
    if (how.follow[as_index(axis)]) expected.velocity[axis] = expected_motion(how.leader).velocity[axis];
    if (axis == how.servo_axis)
      expected.velocity[axis] = state.contacts > 0 ? state.velocity[axis] : motion.servo->max_velocity;
  }
  if (motion.free_rotation) expected.spin = state.spin;
  return expected;
}

bool Walls::surface_moves(std::size_t wall) const {
  return setups_[wall].motion.surface_moves() || !states_[wall].surface_velocity.isZero(0.0) ||
         !states_[wall].surface_spin.isZero(0.0);
}

bool Walls::presses_on_specimen() const {
  return std::ranges::any_of(setups_, [](const WallSetup& setup) { return grit::presses_on_specimen(setup.motion); });
}

bool Walls::any_servo() const {
  return std::ranges::any_of(setups_, [](const WallSetup& setup) { return setup.motion.servo.has_value(); });
}

double Walls::area(std::size_t wall) const {
  const WallSetup& setup = setups_[wall];
  if (!grit::presses_on_specimen(setup.motion)) return setup.geometry->area();
  const int axis = drives_[wall].servo_axis;
  const double across = specimen_[(axis + 1) % 3] * specimen_[(axis + 2) % 3];
  if (!std::isfinite(across) || !(across > 0)) fail(setup, lacks_cross_section(setup.motion.servo->axis));
  return across / std::abs(facing(setup, states_[wall].pose));
}

void Walls::put(std::size_t wall, const Pose& pose, const WallMotion& motion) {
  WallState& state = states_[wall];
  state.pose = pose, state.velocity = motion.velocity, state.spin = motion.spin;
}

void Walls::drop(const std::vector<std::string>& names) {
  for (std::size_t wall = size(); wall-- > 0;) {
    if (std::ranges::find(names, name(wall)) == names.end()) continue;
    const auto at = static_cast<std::ptrdiff_t>(wall);
    setups_.erase(setups_.begin() + at), drives_.erase(drives_.begin() + at), states_.erase(states_.begin() + at);
  }
  order_.clear();  // indices of leaders are not valid either until the next apply()
}

void Walls::clear_forces() {
  for (WallState& state : states_) {
    state.force.setZero(), state.moment.setZero();
    state.surface_force.setZero(), state.surface_moment.setZero();
    state.stiffness = state.spring = state.dashpot = state.turning_spring = state.turning_dashpot = 0;
    state.contacts = state.near = 0;
  }
}

void Walls::add(std::size_t wall, const WallLoad& load) {
  WallState& state = states_[wall];
  state.force += load.force;
  state.moment += load.moment;
  state.surface_force += load.surface_force, state.surface_moment += load.surface_moment;
  state.stiffness += load.stiffness, state.spring += load.spring, state.dashpot += load.dashpot;
  state.turning_spring += load.turning_spring, state.turning_dashpot += load.turning_dashpot;
  state.contacts += load.contacts, state.near += load.near;
}

void Walls::drive(double dt, const Ahead& ahead) {
  for (const std::size_t wall : order_) {
    const MotionDescription& motion = setups_[wall].motion;
    const Drive& how = drives_[wall];
    WallState& state = states_[wall];
    // The ramp at the middle of the step: a ramp of whole steps then covers exactly velocity × ramp_time / 2.
    const double ramp = motion.ramp_time > 0 ? std::min(1.0, (state.stage_time + 0.5 * dt) / motion.ramp_time) : 1.0;
    Vec3 swings = Vec3::Zero();  // amplitudes per second
    if (motion.oscillation) swings = swing_velocities(motion, motion.oscillation->phases_of_displacement(), state, dt);
    for (int axis = 0; axis < 3; ++axis) {
      double& velocity = state.velocity[axis];
      if (axis == how.servo_axis) velocity = servo_velocity(setups_[wall], wall, axis, area(wall), state, dt, ahead);
      else if (how.follow[as_index(axis)]) velocity = states_[how.leader].velocity[axis];
      else if (how.free[as_index(axis)])
        velocity += (state.force[axis] + motion.free->load[axis]) / motion.free->mass * dt;
      else {
        velocity = ramp * motion.velocity[axis];
        if (motion.oscillation) velocity += swings[axis] * motion.oscillation->amplitude[axis];
      }
    }
    if (const auto& free = motion.free_rotation) {
      state.spin += (how.free_axis.dot(state.moment) + free->moment) / free->inertia * dt * how.free_axis;
    } else {
      state.spin = ramp * motion.spin;
      if (const auto& of = motion.oscillation)
        state.spin += swing_velocities(motion, of->phases_of_rotation(), state, dt).cwiseProduct(of->angle);
    }
    state.surface_velocity = ramp * (state.pose.turn * motion.surface_velocity);
    state.surface_spin = ramp * (state.pose.turn * motion.surface_spin);
  }
}

std::string Walls::fallen_behind() const {
  std::string words;
  for (std::size_t wall = 0; wall < size(); ++wall) {
    const int axis = drives_[wall].servo_axis;
    const WallState& state = states_[wall];
    if (axis < 0 || state.contacts == 0) continue;  // without contact it is still approaching
    const ServoDescription& servo = *setups_[wall].motion.servo;
    const double kept = servo.force ? *servo.force : *servo.pressure,
                 pressed = -state.force[axis] / (servo.force ? 1 : area(wall) * facing(setups_[wall], state.pose));
    if (std::abs(state.velocity[axis]) < (1 - 1e-9) * servo.max_velocity ||
        std::abs(pressed - kept) <= most_behind * std::abs(kept))
      continue;
    words +=
        fmt::format("{}servo of wall \"{}\" is limited by its max_velocity of {:g} m/s: {:.4g} {}, target {:.4g}",
                    words.empty() ? "" : "; ", name(wall), servo.max_velocity, pressed, servo.force ? "N" : "Pa", kept);
  }
  return words;
}

Demand Walls::demand() const {
  Demand most;
  for (std::size_t wall = 0; wall < size(); ++wall) {
    const MotionDescription& motion = setups_[wall].motion;
    const WallState& state = states_[wall];
    Demand own;
    if (motion.free) own = {state.spring / motion.free->mass, state.dashpot / motion.free->mass};
    if (const auto& rotation = motion.free_rotation)
      own.spring += state.turning_spring / rotation->inertia, own.dashpot += state.turning_dashpot / rotation->inertia;
    most = larger(most, own);
  }
  return most;
}

void Walls::move(double dt) {
  for (WallState& state : states_) {
    state.pose = moved(state.pose, {state.velocity, state.spin}, dt);
    state.stage_time += dt;
    if (state.swing_frequency > 0) state.swing_time += dt;
  }
}

void Walls::view(std::vector<WallView>& views) const {
  views.resize(size());
  for (std::size_t wall = 0; wall < size(); ++wall) {
    const WallState& state = states_[wall];
    const Geometry& geometry = *setups_[wall].geometry;
    WallView& view = views[wall];
    view.name = setups_[wall].name;
    view.position = state.pose.shift;
    view.stage_position = state.pose.shift - state.stage_start;
    view.velocity = state.velocity;
    view.spin = state.spin;
    view.force = state.force;
    view.moment = state.moment;
    view.area = area(wall), view.flat = geometry.flat();
    view.normal = state.pose.turn * geometry.normal();
    view.pressure = view.area > 0 ? -state.force.dot(view.normal) / view.area : 0;
    view.contacts = state.contacts;
    view.pose = state.pose, view.geometry = &geometry;
  }
}

void Walls::serialize(Archive& archive) {
  const std::size_t walls = states_.size();
  archive(states_);
  if (states_.size() != walls)
    throw Error("the checkpoint has " + std::to_string(states_.size()) + " walls, but the description has " +
                std::to_string(walls) + "; continue with the description that wrote it");
}

}  // namespace grit
