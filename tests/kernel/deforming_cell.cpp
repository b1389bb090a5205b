#include "domain/deforming_cell.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "contact/search.hpp"

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

DeformingCell sheared(double dt) {
  DeformingCell cell({{0, 0, 0}, {4, 3, 2}, {true, true, true}});
  cell.set_rates({0.1, -0.2, 0.3}, {1, 2, 3}, 0);
  cell.advance(dt);
  return cell;
}

TEST(DeformingCell, ImagesMoveWithTheMeanFlow) {
  const double dt = 1e-3;
  DeformingCell cell = sheared(dt);
  for (int step = 0; step < 10; ++step) {
    const Cell before = cell.cell();
    cell.advance(dt);
    for (int k = 0; k < 3; ++k) {
      const Vec3 from = before.period(k), flow = cell.mean_flow(cell.centre() + from);
      EXPECT_LT((cell.cell().period(k) - from - dt * flow).norm(), 1e-14) << k;
      EXPECT_LT((cell.image_velocities(dt).col(k) - flow).norm(), 1e-11) << k;
    }
  }
  cell.update_images(dt);
  const ImageShift& corner = cell.images()[image_with({-2, 1, -1})];
  const Vec3 expected = -2 * cell.cell().period(0) + cell.cell().period(1) - cell.cell().period(2);
  EXPECT_LT((xyz(corner.position) - expected).norm(), 1e-14);
  EXPECT_LT((xyz(corner.velocity) - cell.image_velocities(dt) * Vec3(-2, 1, -1)).norm(), 1e-14);
}

TEST(DeformingCell, ReplacesImagesThatAreFarOffByNearerOnes) {
  DeformingCell cell = sheared(1.2);
  const Cell before = cell.cell();
  const Mat3 velocities = cell.image_velocities(1.2);
  ASSERT_GT(before.tilt[0], 0.5 * (before.high - before.low).x());
  ASSERT_GT(before.tilt[2], 0.5 * (before.high - before.low).y());
  const Eigen::Matrix3i moved = cell.reduce_tilt();
  const Cell& now = cell.cell();
  for (int k = 0; k < 3; ++k) {
    Vec3 old = Vec3::Zero(), flow = Vec3::Zero();
    for (int j = 0; j < 3; ++j)
      old += moved(j, k) * now.period(j), flow += moved(j, k) * cell.image_velocities(1.2).col(j);
    EXPECT_LT((old - before.period(k)).norm(), 1e-13) << k;
    EXPECT_LT((flow - velocities.col(k)).norm(), 1e-13) << k;
  }
  EXPECT_LE(std::abs(now.tilt[0]), 0.5 * (now.high - now.low).x());
  EXPECT_LE(std::abs(now.tilt[1]), 0.5 * (now.high - now.low).x());
  EXPECT_LE(std::abs(now.tilt[2]), 0.5 * (now.high - now.low).y());
  EXPECT_TRUE(cell.reduce_tilt().isIdentity()) << "once";
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
