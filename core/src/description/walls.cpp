#include "description/walls.hpp"

#include "description/axes.hpp"

namespace grit {
namespace {

const std::vector<std::string> some_axes{"x", "y", "z", "xy", "xz", "yz", "xyz"};

}  // namespace

void ServoDescription::declare(Parameters& p) {
  p.add("axis", axis).one_of(one_axis).doc("axis of the controlled motion");
  p.add("pressure", pressure).unit("Pa").symbol("p").at_least(0).doc("target pressure, compression positive");
  p.add("force", force)
      .unit("N")
      .symbol("F")
      .doc("target force of the wall on the bodies along the axis, signed; for any geometry");
  p.add("max_velocity", max_velocity).unit("m/s").above(0).required().doc("maximum speed of the wall");
  p.add("gain", gain)
      .above(0)
      .at_most(1)
      .doc("fraction of the force error corrected per step if contacts are elastic; less if they are damped");
  p.add("area", area)
      .one_of({"geometry", "specimen"})
      .doc("area on which the pressure acts: that of the geometry, or the current cross-section of the specimen");
  p.check(
      [this](const Complain& complain) {
        if (!pressure && !force) complain("pressure", "neither a pressure nor a force", "one of them");
        if (pressure && force) complain("force", "a pressure and a force", "one of them");
        if (force && area != "geometry")
          complain("area", "an area together with a force", "an area together with a pressure");
      },
      {"pressure", "force", "area"});
}
void FollowDescription::declare(Parameters& p) {
  p.add("wall", wall).required().doc("name of the wall to follow");
  p.add("axes", axes).one_of(some_axes).doc("axes along which it follows");
}
void FreeDescription::declare(Parameters& p) {
  p.add("axes", axes).one_of(some_axes).doc("axes along which the wall moves freely under the forces on it");
  p.add("mass", mass).unit("kg").symbol("m").above(0).required().doc("mass of the wall");
  p.add("load", load).unit("N").symbol("F").doc("external force on the wall");
}
void FreeRotationDescription::declare(Parameters& p) {
  p.add("axis", axis).required().doc("axis about which the wall rotates freely, through the point `about`");
  p.add("inertia", inertia)
      .unit("kg m^2")
      .symbol("I")
      .above(0)
      .required()
      .doc("moment of inertia of the wall about the axis");
  p.add("moment", moment).unit("N m").symbol("M").doc("external moment on the wall about the axis, right-handed");
  p.check(
      [this](const Complain& complain) {
        if (!(axis.norm() > 0)) complain("axis", "a vector of length 0", "a direction");
      },
      {"axis"});
}
void OscillationDescription::declare(Parameters& p) {
  p.add("amplitude", amplitude)
      .unit("m")
      .symbol("A")
      .doc("amplitude of the displacement, half of the peak-to-peak distance");
  p.add("angle", angle)
      .unit("rad")
      .symbol("alpha")
      .doc("amplitude of the rotation about the point `about`, right-handed");
  p.add("frequency", frequency).unit("Hz").symbol("f").above(0).required().doc("frequency");
  p.add("phase", phase)
      .unit("rad")
      .symbol("phi")
      .doc("phase at the start; 0: at the mean position, 90 deg: at the positive extreme");
  p.add("amplitude_phase", amplitude_phase)
      .unit("rad")
      .doc(
          "phases of the displacement along x, y and z, added to phase; with a difference of 90 deg a point moves on "
          "an ellipse");
  p.add("angle_phase", angle_phase).unit("rad").doc("the same for the components of angle");
  p.check(
      [this](const Complain& complain) {
        if (amplitude.isZero(0.0) && angle.isZero(0.0))
          complain("amplitude", "neither an amplitude nor an angle", "one that is not 0, or no oscillation");
      },
      {"amplitude", "angle"});
}
void MotionDescription::declare(Parameters& p) {
  p.add("velocity", velocity).unit("m/s").symbol("v").doc("velocity");
  p.add("spin", spin).unit("rad/s").symbol("omega").doc("angular velocity, right-handed");
  p.add("surface_velocity", surface_velocity)
      .unit("m/s")
      .doc(
          "velocity of the surface while the wall stays, as of a belt; contacts see its tangential component; it "
          "turns with the wall");
  p.add("surface_spin", surface_spin)
      .unit("rad/s")
      .doc("angular velocity of the surface about the point `about` while the wall stays, as of a turntable");
  p.add("about", about).unit("m").doc("centre of rotation; default: the reference point of the geometry");
  p.add("ramp_time", ramp_time)
      .unit("s")
      .at_least(0)
      .doc("time over which velocity, spin, those of the surface, and oscillation increase linearly from zero");
  p.add("oscillation", oscillation).doc("sinusoidal motion, added to velocity and spin");
  p.add("servo", servo).doc("motion that keeps a pressure or force");
  p.add("follow", follow).doc("motion of another wall");
  p.add("free", free).doc("free motion under the forces on the wall");
  p.add("free_rotation", free_rotation).doc("free rotation under the moments on the wall");
  p.check(
      [this](const Complain& complain) {
        for (int k = 0; k < 3; ++k) {
          std::vector<std::string> claims;
          const auto claim = [&](bool claimed, const char* key) {
            if (claimed) claims.push_back(key);
          };
          const bool swings = oscillation && oscillation->amplitude[k] != 0;
          claim(velocity[k] != 0 && !swings, "velocity");
          claim(swings, "oscillation");
          claim(servo && servo->axis == one_axis[as_index(k)], "servo");
          claim(follow && follow->axes.find(one_axis[as_index(k)]) != std::string::npos, "follow");
          claim(free && free->axes.find(one_axis[as_index(k)]) != std::string::npos, "free");
          if (claims.size() < 2) continue;
          std::string all;
          for (const auto& one : claims) all += (all.empty() ? "" : " and ") + one;
          complain(claims.back(), "the axis " + one_axis[as_index(k)] + " controlled by " + all,
                   "one of them per axis");
        }
      },
      {"velocity", "oscillation", "servo", "follow", "free"});
  p.check(
      [this](const Complain& complain) {
        if (!free_rotation) return;
        const bool swings = oscillation && !oscillation->angle.isZero(0.0);
        if (spin.isZero(0.0) && !swings) return;
        complain("free_rotation",
                 std::string("a rotation controlled by ") + (swings ? "oscillation" : "spin") + " and free_rotation",
                 "one of them");
      },
      {"spin", "oscillation", "free_rotation"});
}
WallDescription::WallDescription(const Registry& registry) : geometry(registry) {}
void WallDescription::declare(Parameters& p) {
  p.choose(geometry);
  p.add("material", material).required().doc("name of the surface material");
  p.add("groups", groups).doc("names of the groups of bodies on which the wall acts; empty: all");
  p.add("motion", motion).doc("motion, axis by axis; default: fixed");
}

}  // namespace grit
