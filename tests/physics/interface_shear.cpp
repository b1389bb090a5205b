// Complete interface shear tests in boxes of 600 to 1600 grains.
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
                 {"/scenario/surface=\"flat\"", "/scenario/void_ratio=0.56", "/scenario/width=6e-3",
                  "/scenario/height=5e-3", "/scenario/surface_friction_angle=\"16 deg\"",
                  "/scenario/shear_displacement=0.5e-3", "/scenario/inertial_number=2e-3"},
                 curves);
  const double ratio = std::tan(16 * std::numbers::pi / 180);
  EXPECT_NEAR(curves.mean("stress_ratio", 0.3, 1), ratio, 0.01 * ratio);
  EXPECT_NEAR(curves.mean("friction_angle", 0.3, 1), 16, 0.2);
  EXPECT_NEAR(curves.mean("wall_contact_factor", 0.3, 1), 1, 0.01);
  EXPECT_NEAR(curves.mean("normal_stress", 0, 1), 100e3, 0.01 * 100e3);
  EXPECT_GT(curves.mean("slip/fraction", 0.8, 1), 0.6);  // before sliding, the sand is sheared by about 0.15 mm
  EXPECT_NEAR(curves.mean("volumetric_strain", 0.8, 1), 0, 3e-3);
}

// Grabowski (2024), on R_n = 0.25 and 1: peaks 31° and 49°, dilation 1.8 and 3.9 %, slip 70 and 2 %. Boxes of 16 grains
// scatter by some degrees; the means found are 25.9° and 42.6°, 1.4 and 3.6 %, and 18.2° on R_n = 0.01.
TEST(InterfaceShear, RougherTeethBearMoreDilateMoreAndSlipLess) {
  const auto over = [](const char* roughness) {
    Curves curves;
    run_to_the_end(
        "sims/interface-shear/quick-rn-001.json",
        {std::string("/scenario/roughness=") + roughness, "/scenario/width=8e-3", "/scenario/height=5e-3",
         "/scenario/void_ratio=0.57", "/scenario/shear_displacement=0.8e-3", "/scenario/inertial_number=2e-3"},
        curves);
    return curves;
  };
  const Curves rough = over("0.25"), very_rough = over("1");
  const auto angle = [](const Curves& curves) { return curves.mean("friction_angle", 0.3, 1); };
  EXPECT_GT(angle(rough), 18 + 4) << "that of the surface is 18";
  EXPECT_GT(angle(very_rough), angle(rough) + 8);
  const auto strain = [](const Curves& curves) { return curves.mean("volumetric_strain", 0.9, 1); };
  EXPECT_GT(strain(rough), 0.006);
  EXPECT_GT(strain(very_rough), strain(rough) + 0.01);
  const auto slip = [](const Curves& curves) { return curves.mean("slip/fraction", 0.9, 1); };
  EXPECT_GT(slip(rough), 0.5);
  EXPECT_LT(slip(very_rough), 0.2) << "it shears internally";
  // State after preparation: sampled at the start and at the end of settling.
  const auto& spread = rough.channel.at("prepared-cells/standard_deviation");
  ASSERT_EQ(spread.size(), 2u);
  EXPECT_NEAR(spread.back(), 0.044, 0.02);
  EXPECT_NEAR(rough.channel.at("prepared-cells/mean").back(), 0.587, 0.02) << "0.57 in the interior";
  EXPECT_LT(rough.channel.at("prepared-chains/anisotropy").back(), 0.1) << "isotropic; six seeds gave 0.005 … 0.050";
  EXPECT_NEAR(rough.channel.at("prepared-chains/chains").back(), 46, 20);
}

// Grabowski (2024): 0.29 on the flat surface, 0.80 on a sinusoidal surface of d/l = 0.24, residual 0.69. The mean found
// is 0.73.
TEST(InterfaceShear, WavesBearMoreThanWhatIsFlat) {
  Curves curves;
  run_to_the_end("sims/interface-shear/quick-dl-0240.json",
                 {"/scenario/wavelength=5e-3", "/scenario/width=10e-3", "/scenario/height=6e-3",
                  "/scenario/shear_displacement=1e-3"},
                 curves);
  EXPECT_NEAR(curves.mean("stress_ratio", 0.3, 1), 0.73, 0.1);
}

}  // namespace
}  // namespace grit::test::interface_shear_tests
