#include "domain/deforming_cell.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace grit::test::deforming_cell_tests {
namespace {

Cell periodic_x() { return {Vec3(0, 0, 0), Vec3(2, 4, 6), {true, false, false}}; }

TEST(DeformingCell, StrainsItsPeriodicAxesAboutItsCentre) {
  DeformingCell cell(periodic_x());
  cell.set_strain_rate({-0.5, 0, 0}, 0);
  cell.advance(0.1);
  EXPECT_NEAR(cell.cell().low.x(), 0.05, 1e-15);
  EXPECT_DOUBLE_EQ(cell.cell().high.x(), 1.95);
  EXPECT_EQ(cell.cell().high.y(), 4);
  EXPECT_EQ(cell.periods(), Vec3(cell.lengths().x(), 0, 0));
}

TEST(DeformingCell, GrowthOfPeriodsIsThatOfTheLastStep) {
  DeformingCell cell(periodic_x());
  cell.set_strain_rate({0.5, 0, 0}, 0);
  EXPECT_EQ(cell.period_growth(0), Vec3(1, 0, 0)) << "before the first step: from the strain rate";
  cell.advance(0.1);
  EXPECT_NEAR(cell.period_growth(0.1).x(), 1, 1e-14) << "not 0.5 times the present 2.1";
  cell.set_strain_rate({1.5, 0, 0}, 0.1);
  EXPECT_NEAR(cell.period_growth(0.1).x(), 1 + 1 * 2.1, 1e-14) << "images change their velocity as bodies do";
}

TEST(DeformingCell, MeanFlowIsLinearAboutTheCentre) {
  DeformingCell cell(periodic_x());
  EXPECT_EQ(cell.mean_flow({2, 0, 0}), Vec3::Zero());
  cell.set_strain_rate({0.5, 0, 0}, 0);
  EXPECT_EQ(cell.mean_flow({2, 0, 0}), Vec3(0.5, 0, 0));
  EXPECT_EQ(cell.mean_flow({1, 3, 3}), Vec3::Zero());
}

TEST(DeformingCell, ImagesAreWholePeriodsAway) {
  DeformingCell cell(periodic_x());
  cell.set_strain_rate({0.5, 0, 0}, 0);
  cell.update_images(0);
  EXPECT_EQ(cell.images()[0].position.x, 0);
  EXPECT_EQ(cell.images()[1].position.x, 2);
  EXPECT_EQ(cell.images()[2].position.x, -2);
  EXPECT_EQ(cell.images()[2].velocity.x, -1);
  EXPECT_EQ(cell.images()[1].position.y, 0);
}

TEST(DeformingCell, AnOpenCellDoesNotDeform) {
  const double infinity = std::numeric_limits<double>::infinity();
  DeformingCell cell({Vec3::Constant(-infinity), Vec3::Constant(infinity)});
  EXPECT_FALSE(cell.periodic());
  cell.advance(1);
  EXPECT_EQ(cell.mean_flow({1, 1, 1}), Vec3::Zero());
  EXPECT_EQ(cell.flow_centre(), Vec3::Zero());
}

}  // namespace
}  // namespace grit::test::deforming_cell_tests
