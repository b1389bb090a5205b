// The interface shear test from one end to the other, in a box of some 600 grains on a flat surface.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "support/curves.hpp"

namespace grit::test::interface_shear_tests {
namespace {

TEST(InterfaceShear, OnAFlatSurfaceSlidesAtItsFrictionAngle) {
  Curves curves;
  run_to_the_end("sims/interface-shear/quick-rn-001.json",
                 {"/scenario/surface=\"flat\"", "/scenario/width=6e-3", "/scenario/height=5e-3",
                  "/scenario/surface_friction_angle=\"16 deg\"", "/scenario/shear_displacement=0.5e-3",
                  "/scenario/inertial_number=2e-3"},
                 curves);
  const double ratio = std::tan(16 * std::numbers::pi / 180);
  EXPECT_NEAR(curves.mean("stress_ratio", 0.3, 1), ratio, 0.01 * ratio);
  EXPECT_NEAR(curves.mean("friction_angle", 0.3, 1), 16, 0.2);
  EXPECT_NEAR(curves.mean("wall_contact_factor", 0.3, 1), 1, 0.01);
  EXPECT_NEAR(curves.mean("normal_stress", 0, 1), 100e3, 0.01 * 100e3);
  EXPECT_GT(curves.mean("slip/share", 0.8, 1), 0.6);  // before it slides the sand is sheared by some 0.15 mm
  EXPECT_NEAR(curves.mean("volumetric_strain", 0.8, 1), 0, 3e-3);
}

}  // namespace
}  // namespace grit::test::interface_shear_tests
