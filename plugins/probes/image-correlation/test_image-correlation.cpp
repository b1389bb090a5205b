#include "image-correlation.hpp"

#include <gmock/gmock.h>

#include <numbers>
#include <random>

#include "grit/testing/probe.hpp"

namespace grit {
namespace {

using testing::HasSubstr;
using Vec2 = Eigen::Vector2d;
using Mat2 = Eigen::Matrix2d;

/// Waves of all directions, six pixels long and more: a pattern that is known everywhere.
class Waves {
 public:
  Waves() {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> draw(0, 1);
    for (int k = 0; k < 60; ++k) {
      const double angle = 2 * std::numbers::pi * draw(random), number = 2 * std::numbers::pi / (6 + 14 * draw(random));
      waves_.push_back({number * Vec2(std::cos(angle), std::sin(angle)), 2 * std::numbers::pi * draw(random)});
    }
  }
  double operator()(const Vec2& place) const {
    double sum = 0.5;
    for (const auto& [number, phase] : waves_) sum += 0.03 * std::cos(number.dot(place) + phase);
    return sum;
  }

 private:
  std::vector<std::pair<Vec2, double>> waves_;
};

constexpr int picture_size = 160;

/// The pattern moved by x = X + shift + gradient (X − middle), brighter by `light` and of another contrast.
Image moved_waves(const Mat2& gradient, const Vec2& shift, double light = 0) {
  const Waves waves;
  const Vec2 middle = Vec2::Constant(0.5 * picture_size);
  const Mat2 back = (Mat2::Identity() + gradient).inverse();
  Image image(picture_size, picture_size);
  for (int j = 0; j < picture_size; ++j)
    for (int i = 0; i < picture_size; ++i)
      image.row(j)[i] = static_cast<float>(light + (1 + light) * waves(middle + back * (Vec2(i, j) - middle - shift)));
  return image;
}

/// The largest error of any square's displacement [pixels]; all must be found.
double worst_error(const Mat2& gradient, const Vec2& shift, double light = 0, int half = 15) {
  const ReferenceImage before(moved_waves(Mat2::Zero(), Vec2::Zero()));
  const Correlation pictures(before, DeformedImage(moved_waves(gradient, shift, light)), half);
  const SquareGrid grid{.columns = 6, .rows = 6, .left = 35, .bottom = 35, .apart = 18};
  const MatchGrid found = matches(pictures, grid, 6, 20, 0.9);
  double worst = 0;
  for (std::size_t n = 0; n < found.match.size(); ++n) {
    EXPECT_TRUE(found.match[n].has_value()) << n;
    if (!found.match[n]) return 1;
    const Vec2 place(35 + 18 * static_cast<int>(n % 6), 35 + 18 * static_cast<int>(n / 6));
    const Vec2 moved = shift + gradient * (place - Vec2::Constant(0.5 * picture_size));
    worst = std::max(worst, (found.match[n]->moved - moved).lpNorm<Eigen::Infinity>());
    EXPECT_LT((found.match[n]->gradient - gradient).lpNorm<Eigen::Infinity>(), 2e-3) << n;
  }
  return worst;
}

TEST(Correlation, FindsShiftsOfAPartOfAPixel) {
  for (int tenths = 1; tenths < 10; ++tenths) {
    EXPECT_LT(worst_error(Mat2::Zero(), {0.1 * tenths, -0.1 * tenths}), 0.005) << tenths;
  }
}

// Pixels are taken by registers full, and a row need not fill them.
TEST(Correlation, TakesSquaresOfAnySide) {
  for (const int half : {12, 15, 16, 20, 23}) EXPECT_LT(worst_error(Mat2::Zero(), {0.3, -0.6}, 0, half), 0.005) << half;
}

TEST(Correlation, FindsUniformStrain) {
  Mat2 gradient;
  gradient << 0.03, 0.06, 0.01, -0.04;
  EXPECT_LT(worst_error(gradient, {3.3, -7.8}), 0.005);
}

TEST(Correlation, FindsTurnsInAnyLight) {
  const Mat2 turn = Eigen::Rotation2Dd(0.1).toRotationMatrix() - Mat2::Identity();
  EXPECT_LT(worst_error(turn, {0.25, 0.4}, 0.3), 0.005);
}

TEST(Correlation, FindsNothingWhereThereIsNothingToSee) {
  const Image grey(picture_size, picture_size), waves = moved_waves(Mat2::Zero(), Vec2::Zero());
  for (const auto& [before, after] : {std::pair(grey, waves), std::pair(waves, grey)}) {
    const ReferenceImage reference(before);
    const Correlation pictures(reference, DeformedImage(after), 15);
    EXPECT_FALSE(pictures.search(80, 80, 20).has_value());
    EXPECT_FALSE(pictures.refined(80, 80, {}).has_value());
  }
}

TEST(Correlation, LosesWhatLeavesThePicture) {
  const Image waves = moved_waves(Mat2::Zero(), Vec2::Zero());
  const ReferenceImage reference(waves);
  const Correlation pictures(reference, DeformedImage(waves), 15);
  EXPECT_TRUE(pictures.has(16, 16) && !pictures.has(15, 16) && !pictures.has(16, 144) && pictures.has(143, 143));
  EXPECT_TRUE(pictures.refined(20, 20, {}).has_value());
  EXPECT_FALSE(pictures.refined(20, 20, {.moved = {-4, 0}}).has_value());
}

/// Light's sum, and where its middle is.
struct Light {
  double sum = 0;
  Vec2 middle = Vec2::Zero();
};
Light light_of(const Image& image) {
  Light light;
  for (int j = 0; j < image.height; ++j)
    for (int i = 0; i < image.width; ++i) light.sum += image.row(j)[i], light.middle += image.row(j)[i] * Vec2(i, j);
  light.middle /= light.sum;
  return light;
}

Disc disc(double x, double y, double depth = 12, double radius = 12, double angle = 0, std::uint32_t id = 7) {
  return {.x = x, .y = y, .depth = depth, .radius = radius, .angle = angle, .id = id};
}
Image seen(const std::vector<Disc>& discs) { return Camera(1, 25).picture(discs, 60, 50); }

TEST(Camera, MovesGreyValuesWithPartsOfAPixel) {
  const Light still = light_of(seen({disc(30, 25)}));
  for (int tenths = 1; tenths < 10; ++tenths) {
    const Light moved = light_of(seen({disc(30 + 0.1 * tenths, 25 - 0.1 * tenths)}));
    EXPECT_NEAR((moved.middle - still.middle).x(), 0.1 * tenths, 0.01);
    EXPECT_NEAR((moved.middle - still.middle).y(), -0.1 * tenths, 0.01);
    EXPECT_NEAR(moved.sum / still.sum, 1, 2e-3);
  }
}

TEST(Camera, TurnsSpecklesAnticlockwise) {
  // By a right angle, pixel (x, y) goes to (−y, x) about the middle of the disc.
  const Image still = seen({disc(30, 25)}), turned = seen({disc(30, 25, 12, 12, 0.5 * std::numbers::pi)});
  double difference = 0, contrast = 0;
  for (int j = -8; j <= 8; ++j)
    for (int i = -8; i <= 8; ++i) {
      difference = std::max(difference, double(std::abs(turned.row(25 + i)[30 - j] - still.row(25 + j)[30 + i])));
      contrast = std::max(contrast, double(std::abs(turned.row(25 + j)[30 + i] - still.row(25 + j)[30 + i])));
    }
  EXPECT_LT(difference, 1e-4);
  EXPECT_GT(contrast, 0.1);
}

TEST(Camera, ShowsTheNearerOfTwo) {
  const Disc near = disc(30, 25, 12, 12, 0, 1), far = disc(32, 24, 40, 12, 0, 2);
  const Image both = seen({far, near}), again = seen({near, far}), alone = seen({near}), behind = seen({far});
  EXPECT_EQ(both.grey, again.grey);
  EXPECT_EQ(both.row(25)[30], alone.row(25)[30]);
  EXPECT_EQ(both.row(21)[43], behind.row(21)[43]);
  EXPECT_GT(behind.row(21)[43], 0.05f);
  EXPECT_EQ(alone.row(21)[43], 0);
  // Spheres that reach into each other: each is seen where it is in front.
  const Disc left = disc(25, 25, 12, 12, 0, 1), right = disc(37, 25, 12, 12, 0, 2);
  const Image pair = seen({left, right});
  EXPECT_EQ(pair.row(25)[29], seen({left}).row(25)[29]);
  EXPECT_EQ(pair.row(25)[33], seen({right}).row(25)[33]);
}

TEST(Camera, SeesWhatIsCutByThePicturesSides) {
  const Image corner = seen({disc(-5, -5), disc(62, 52, 12, 12, 0, 8), disc(-200, 0), disc(20, 900)});
  EXPECT_GT(corner.row(0)[0], 0.05f);
  EXPECT_GT(corner.row(49)[59], 0.05f);
  EXPECT_EQ(corner.row(25)[30], 0);
}

/// Spheres near the places of a lattice, three deep, at rest.
FakeWorld packing(int columns = 16, int rows = 12, int depth_axis = 1) {
  FakeWorld world;
  std::mt19937 random(9);
  std::uniform_real_distribution<double> draw(-1, 1);
  const int right = depth_axis == 0 ? 1 : 0, up = depth_axis == 2 ? 1 : 2;
  for (int i = 0; i < columns; ++i)
    for (int k = 0; k < rows; ++k)
      for (int j = 0; j < 3; ++j) {
        Vec3 place;
        place[right] = (i + 0.5 + 0.15 * draw(random)) * 1e-3, place[up] = (k + 0.5 + 0.15 * draw(random)) * 1e-3;
        place[depth_axis] = (0.5 + 0.9 * j + 0.1 * draw(random)) * 1e-3;
        world.add(place, 0.5e-3 * (1.05 + 0.25 * draw(random)));
      }
  world.rotation.assign(world.position.size(), Vec3::Zero());
  world.displacement.assign(world.position.size(), Vec3::Zero());
  world.whole.low.setZero(), world.whole.high.setConstant(3e-3);
  world.whole.high[right] = columns * 1e-3, world.whole.high[up] = rows * 1e-3;
  return world;
}

/// Some steps later: centres at F X + shift, all turned by `turn`.
FakeWorld moved(FakeWorld world, const Mat3& gradient, const Vec3& shift, const Vec3& turn = Vec3::Zero()) {
  for (std::size_t i = 0; i < world.position.size(); ++i) {
    Row& row = world.position[i];
    const Vec3 to = gradient * xyz(row) + shift;
    world.displacement[i] += to - xyz(row);
    row = {to.x(), to.y(), to.z(), row.w};
    world.rotation[i] += turn;
  }
  world.steps += 100;
  return world;
}

struct Errors {
  double bias = 0, deviation = 0, worst = 0, found = 0;  ///< pixels; share
};

/// Of the displacements that the probe finds between two worlds, against those of the places where its subsets were.
Errors errors(ImageCorrelation& probe, const FakeWorld& before, const FakeWorld& after, const Mat3& gradient,
              const Vec3& shift) {
  probe.prepare(before);
  const auto start = probe.fields(before);
  const auto now = probe.fields(after);
  const int depth = probe.depth_axis[0] - 'x', right = depth == 0 ? 1 : 0, up = depth == 2 ? 1 : 2;
  const double pixel = before.mean_diameter() / probe.pixels_per_diameter;
  Errors errors;
  double count = 0;
  Vec2 bias = Vec2::Zero();
  const std::size_t subsets = now[4].values.size();
  for (std::size_t s = 0; s < subsets; ++s) {
    if (std::isnan(now[4].values[s])) continue;
    Vec3 place(start[0].values[3 * s], start[0].values[3 * s + 1], start[0].values[3 * s + 2]);
    const Vec3 whole = gradient * place + shift - place;
    const Vec2 error = (Vec2(now[2].values[2 * s], now[2].values[2 * s + 1]) - Vec2(whole[right], whole[up])) / pixel;
    bias += error, errors.deviation += 0.5 * error.squaredNorm(), ++count;
    errors.worst = std::max(errors.worst, error.lpNorm<Eigen::Infinity>());
  }
  errors.bias = bias.lpNorm<Eigen::Infinity>() / count;
  errors.deviation = std::sqrt(errors.deviation / count);
  errors.found = count / static_cast<double>(subsets);
  return errors;
}

TEST(ImageCorrelation, FindsShiftsOfAPartOfAPixel) {
  const FakeWorld before = packing();
  ImageCorrelation probe;
  const double pixel = before.mean_diameter() / probe.pixels_per_diameter;
  for (int tenths = 1; tenths < 10; ++tenths) {
    const Vec3 shift(0.1 * tenths * pixel, 0, -0.1 * tenths * pixel);
    const Errors found = errors(probe, before, moved(before, Mat3::Identity(), shift), Mat3::Identity(), shift);
    EXPECT_EQ(found.found, 1) << tenths;
    EXPECT_LT(found.worst, 0.02) << tenths;
  }
}

TEST(ImageCorrelation, FindsTurnsAlongEachAxis) {
  for (const int axis : {0, 1, 2}) {
    const Vec3 about = Vec3::Unit(axis);
    const Mat3 turn = Eigen::AngleAxisd(0.1, about).toRotationMatrix();
    const FakeWorld before = packing(16, 12, axis);
    Vec3 centre(8e-3, 8e-3, 6e-3);
    centre[axis] = 0;
    const Vec3 shift = centre - turn * centre;
    ImageCorrelation probe;
    probe.depth_axis = std::string(1, "xyz"[axis]);
    const Errors found = errors(probe, before, moved(before, turn, shift, 0.1 * about), turn, shift);
    EXPECT_EQ(found.found, 1) << axis;
    EXPECT_LT(found.worst, 0.02) << axis;
  }
}

TEST(ImageCorrelation, AgreesWithGrainsOnUniformStrain) {
  Mat3 gradient = Mat3::Identity();
  gradient(0, 0) = 1.01, gradient(2, 2) = 0.99, gradient(0, 2) = 0.04;
  const FakeWorld before = packing(24, 16), after = moved(before, gradient, Vec3::Zero());
  ImageCorrelation pictures;
  const Errors found = errors(pictures, before, after, gradient, Vec3::Zero());
  const auto seen = channel_values(pictures, after, "strain");
  const Mat3 green = 0.5 * (gradient.transpose() * gradient - Mat3::Identity());
  const std::array<double, 3> known{green(0, 0), green(2, 2), green(0, 2)};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(seen[k], known[k], 5e-4) << k;
  }
  EXPECT_LT(found.bias, 0.02);
}

// Grains do not strain: of a uniform strain a subset sees what the few grains in it do. Off the uniform field it is
// by a share of its strain, whatever the pictures are good for: below 0.02 pixel each where strain is small (0.018 at
// 0.3 %, 0.16 at 4 %).
TEST(ImageCorrelation, FindsEachSubsetOfAUniformStrain) {
  const FakeWorld before = packing(24, 16);
  for (const auto& [strain, bound] : {std::pair(0.003, 0.02), std::pair(0.04, 0.2)}) {
    Mat3 gradient = Mat3::Identity();
    gradient(0, 0) += 0.25 * strain, gradient(2, 2) -= 0.25 * strain, gradient(0, 2) = strain;
    ImageCorrelation probe;
    const Errors found = errors(probe, before, moved(before, gradient, Vec3::Zero()), gradient, Vec3::Zero());
    EXPECT_EQ(found.found, 1) << strain;
    EXPECT_LT(found.worst, bound) << strain;
  }
}

/// By pixel of the picture of a packing, index of the sphere that is seen there; -1 of none.
std::vector<int> seen_at(const FakeWorld& world, const Image& image, const Vec2& corner, double pixel) {
  std::vector<int> who(image.grey.size(), -1);
  std::vector<double> depth(who.size(), std::numeric_limits<double>::infinity());
  for (std::size_t n = 0; n < world.position.size(); ++n) {
    const Row& sphere = world.position[n];
    const Vec2 middle = (Vec2(sphere.x, sphere.z) - corner) / pixel;
    const auto reach = [&](double from, std::ptrdiff_t size) {
      const double radius = sphere.w / pixel;
      return std::pair(static_cast<std::ptrdiff_t>(std::max(0.0, std::floor(from - radius))),
                       static_cast<std::ptrdiff_t>(std::min(static_cast<double>(size - 1), from + radius)));
    };
    const auto [low, high] = reach(middle.y(), image.height);
    const auto [first, last] = reach(middle.x(), image.width);
    for (std::ptrdiff_t j = low; j <= high; ++j)
      for (std::ptrdiff_t i = first; i <= last; ++i) {
        const Vec2 off = pixel * (Vec2(static_cast<double>(i), static_cast<double>(j)) - middle);
        const double square = sphere.w * sphere.w - off.squaredNorm();
        const auto at = static_cast<std::size_t>(j * image.width + i);
        if (square <= 0 || sphere.y - std::sqrt(square) >= depth[at]) continue;
        depth[at] = sphere.y - std::sqrt(square), who[at] = static_cast<int>(n);
      }
  }
  return who;
}

// To first order, a square settles where the motion of the grains that it shows, pixel by pixel, is fitted best in
// sight of the picture's slopes, with the light free: worked out here from grains, without correlating anything.
TEST(ImageCorrelation, FindsWhatTheGrainsInEachSubsetDo) {
  Mat3 gradient = Mat3::Identity();
  gradient(0, 0) = 1.0025, gradient(2, 2) = 0.9975, gradient(0, 2) = 0.01;
  const FakeWorld before = packing(), after = moved(before, gradient, Vec3::Zero());
  ImageCorrelation probe;
  probe.prepare(before);
  const Image image = probe.picture(before);
  const double pixel = before.mean_diameter() / probe.pixels_per_diameter;
  const int half = 15;
  const auto margin = [&](std::ptrdiff_t size, double length) {
    return 0.5 * (static_cast<double>(size) - std::ceil(length / pixel));
  };
  const Vec2 corner(-(margin(image.width, before.whole.high.x()) - 0.5) * pixel,
                    -(margin(image.height, before.whole.high.z()) - 0.5) * pixel);
  const std::vector<int> who = seen_at(before, image, corner, pixel);
  const auto start = probe.fields(before), now = probe.fields(after);
  double worst = 0, off_uniform = 0;
  for (std::size_t s = 0; s < start[4].values.size(); ++s) {
    const Vec2 place(start[0].values[3 * s], start[0].values[3 * s + 2]), middle = (place - corner) / pixel;
    const std::ptrdiff_t column = std::lround(middle.x()), row = std::lround(middle.y());
    ASSERT_NEAR(middle.x(), static_cast<double>(column), 1e-6);
    Eigen::Matrix<double, 8, 8> normal = Eigen::Matrix<double, 8, 8>::Zero();
    Eigen::Matrix<double, 8, 1> right = Eigen::Matrix<double, 8, 1>::Zero();
    for (int y = -half; y <= half; ++y)
      for (int x = -half; x <= half; ++x) {
        const std::ptrdiff_t i = column + x, j = row + y;
        const int n = who[static_cast<std::size_t>(j * image.width + i)];
        if (n < 0) continue;
        const Vec3& gone = after.displacement[static_cast<std::size_t>(n)];
        const double across = 0.5 * (image.row(j)[i + 1] - image.row(j)[i - 1]),
                     up = 0.5 * (image.row(j + 1)[i] - image.row(j - 1)[i]);
        Eigen::Matrix<double, 8, 1> steepest;
        steepest << across, across * x, across * y, up, up * x, up * y, 1, image.row(j)[i];
        normal += steepest * steepest.transpose();
        right += (across * gone.x() + up * gone.z()) / pixel * steepest;
      }
    const Eigen::Matrix<double, 8, 1> fitted = normal.ldlt().solve(right);
    const Vec2 found = Vec2(now[2].values[2 * s], now[2].values[2 * s + 1]) / pixel,
               uniform = Vec2((gradient(0, 0) - 1) * place.x() + gradient(0, 2) * place.y(),
                              (gradient(2, 2) - 1) * place.y()) /
                         pixel;
    ASSERT_TRUE(found.allFinite()) << s;
    worst = std::max(worst, (found - Vec2(fitted[0], fitted[3])).lpNorm<Eigen::Infinity>());
    off_uniform = std::max(off_uniform, (found - uniform).lpNorm<Eigen::Infinity>());
  }
  EXPECT_LT(worst, 0.02);
  EXPECT_GT(off_uniform, 1.5 * worst) << "the rest is that grains are rigid";
}

TEST(ImageCorrelation, LooksAsFarAsItIsTold) {
  const FakeWorld before = packing();
  const double diameter = before.mean_diameter();
  const Vec3 shift(2.6 * diameter, 0, -1.3 * diameter);
  const FakeWorld after = moved(before, Mat3::Identity(), shift);
  ImageCorrelation far;
  const Errors found = errors(far, before, after, Mat3::Identity(), shift);
  EXPECT_EQ(found.found, 1);
  EXPECT_LT(found.worst, 0.02);
  ImageCorrelation near;
  near.search_range = 2;
  EXPECT_EQ(errors(near, before, after, Mat3::Identity(), shift).found, 0);
  EXPECT_TRUE(std::isnan(channel_values(near, after, "strain").at(0)));
  EXPECT_TRUE(std::isnan(channel_value(near, after, "correlation")));
  EXPECT_EQ(channel_value(near, after, "found"), 0);
  EXPECT_EQ(channel_value(near, after, "largest_shear"), 0);
}

TEST(ImageCorrelation, LosesGrainsThatTurnApart) {
  const FakeWorld before = packing();
  FakeWorld after = moved(before, Mat3::Identity(), Vec3::Zero());
  for (std::size_t i = 0; i < after.position.size(); ++i)
    if (before.position[i].x > 8e-3) after.rotation[i].y() = i % 2 == 0 ? 1.5 : -1.5;
  ImageCorrelation probe;
  probe.prepare(before);
  const auto start = probe.fields(before).at(0).values;
  const auto correlation = probe.fields(after).at(4).values;
  int still = 0, turned = 0, found = 0;
  for (std::size_t s = 0; s < correlation.size(); ++s) {
    const double x = start[3 * s];
    if (x < 6.5e-3) {
      ++still;
      EXPECT_GT(correlation[s], 0.999) << s;
    }
    if (x > 9.5e-3) {
      ++turned;
      if (!std::isnan(correlation[s])) ++found;
    }
  }
  EXPECT_GT(still, 100);
  EXPECT_GT(turned, 100);
  // Some, by their outlines and greys.
  EXPECT_LT(found, 0.2 * turned);
}

TEST(ImageCorrelation, IsLocal) {
  // Two blocks, the upper one slid along the lower one.
  const FakeWorld before = packing(16, 16);
  FakeWorld after = before;
  ++after.steps;
  for (Row& row : after.position)
    if (row.z > 8e-3) row.x += 0.4e-3;
  ImageCorrelation probe;
  probe.prepare(before);
  const auto start = probe.fields(before).at(0).values;
  const auto strain = probe.fields(after).at(3).values;
  int off = 0, across = 0;
  for (std::size_t s = 0; s < start.size() / 3; ++s) {
    const double z = start[3 * s + 2] - 8e-3;
    // Off by half a window, half a subset and half a grain.
    if (std::abs(z) > 3e-3) {
      ++off;
      EXPECT_NEAR(strain[3 * s + 2], 0, 1e-3) << s;
    }
    if (std::abs(z) < 0.4e-3) {
      ++across;
      EXPECT_GT(strain[3 * s + 2], 0.05) << s;
    }
  }
  EXPECT_GT(off, 100);
  EXPECT_GT(across, 10);
  EXPECT_GT(channel_value(probe, after, "largest_shear"), 0.05);
}

TEST(ImageCorrelation, TellsSlidingFromShearAsGrainsDo) {
  FakeWorld before = packing(24, 12);
  for (const double sign : {1.0, -1.0}) {
    WallView wall;
    wall.name = sign > 0 ? "low" : "high", wall.normal = sign * Vec3::UnitZ();
    wall.position = wall.stage_position = Vec3(sign > 0 ? 7e-3 : 8e-3, 0, 0);  // before the first look
    before.wall.push_back(wall);
  }
  // Then the wall below goes back by 0.6 diameters, with what lies on the right of it.
  const double way = 0.6 * before.mean_diameter(), edge = 0.4 * before.whole.high.x();
  FakeWorld after = before;
  after.steps = 1, after.wall[0].stage_position.x() -= way;
  for (std::size_t i = 0; i < after.position.size(); ++i) {
    const bool stuck = after.position[i].z < 3 * before.mean_diameter() && after.position[i].x > edge;
    after.position[i].x -= stuck ? way : 0;
  }
  ImageCorrelation probe;
  probe.sliding.emplace();
  probe.sliding->wall = "low", probe.sliding->driven_by = "high", probe.sliding->max_distance = 1.5;
  probe.prepare(before);
  EXPECT_TRUE(std::isnan(channel_value(probe, before, "contact_factor")));
  EXPECT_NEAR(channel_value(probe, after, "contact_factor"), 0.4, 0.06);
  EXPECT_NEAR(channel_value(probe, after, "surface_length") + channel_value(probe, after, "internal_length"),
              before.whole.high.x(), 3 * before.mean_diameter())
      << "few strips are lost";
}

TEST(ImageCorrelation, BeginsAnewWithEachStage) {
  const FakeWorld before = packing();
  FakeWorld after = moved(before, Mat3::Identity(), {1e-4, 0, 0});
  ImageCorrelation probe;
  probe.prepare(before);
  probe.fields(before);
  EXPECT_GT(probe.fields(after).at(2).values.at(0), 0.9e-4);
  after.stage_name = "next";
  const auto fields = probe.fields(after);
  for (const double moved : fields.at(2).values) EXPECT_NEAR(moved, 0, 1e-10);
}

TEST(ImageCorrelation, SeesTheSpecimenGoOnBeyondAPeriodicSide) {
  FakeWorld before = packing();
  before.box = {Vec3::Zero(), {16e-3, 3e-3, 12e-3}, {true, false, false}};
  const Vec3 shift(2e-3, 0, 0);
  FakeWorld after = moved(before, Mat3::Identity(), shift);
  for (Row& row : after.position)
    if (row.x > 16e-3) row.x -= 16e-3;
  ImageCorrelation probe;
  const Errors found = errors(probe, before, after, Mat3::Identity(), shift);
  EXPECT_EQ(found.found, 1);
  EXPECT_LT(found.worst, 0.02);
}

// A picture reaches over a search and a subset beyond the specimen: here over five periods.
TEST(ImageCorrelation, SeesAsManyPeriodsAsThePictureReachesOver) {
  FakeWorld world = packing(4, 4);
  world.box = {Vec3::Zero(), {4e-3, 3e-3, 4e-3}, {true, false, true}};
  ImageCorrelation probe;
  probe.search_range = 8;
  probe.prepare(world);
  const Image image = probe.picture(world);
  ASSERT_GT(image.width, 5 * 4 * 23);
  const auto dark = [&](std::ptrdiff_t first, std::ptrdiff_t last, bool columns) {
    std::ptrdiff_t count = 0;
    for (std::ptrdiff_t j = columns ? 0 : first; j < (columns ? image.height : last); ++j)
      for (std::ptrdiff_t i = columns ? first : 0; i < (columns ? last : image.width); ++i)
        count += image.row(j)[i] == 0;
    return static_cast<double>(count) / static_cast<double>(columns ? image.height : image.width) /
           static_cast<double>(last - first);
  };
  for (const bool columns : {true, false}) {
    const std::ptrdiff_t size = columns ? image.width : image.height;
    for (const std::ptrdiff_t first : {std::ptrdiff_t{0}, size / 2, size - 50})
      EXPECT_LT(dark(first, first + 50, columns), 0.05) << columns << ' ' << first;
  }
}

TEST(ImageCorrelation, NamesTheComponentsOfItsPlane) {
  ImageCorrelation probe;
  probe.depth_axis = "x";
  const FakeWorld world = packing(6, 5, 0);
  probe.prepare(world);
  EXPECT_THAT(probe.channels().front().components, testing::ElementsAre("yy", "zz", "yz"));
  const auto fields = probe.fields(world);
  EXPECT_THAT(fields.at(2).components, testing::ElementsAre("y", "z"));
  EXPECT_THAT(fields.at(3).components, testing::ElementsAre("yy", "zz", "yz"));
}

TEST(ImageCorrelation, HasNoPictureOfASpecimenThatHasGrownTooLarge) {
  FakeWorld world = packing(6, 5);
  ImageCorrelation probe;
  probe.prepare(world);
  world.whole.high = {16, 3e-3, 12}, world.stage_name = "next";
  for (const auto& channel : {"found", "correlation", "strain"})
    EXPECT_TRUE(std::isnan(channel_values(probe, world, channel).at(0))) << channel;
  for (const Field& field : probe.fields(world)) EXPECT_TRUE(field.values.empty()) << field.name;
}

TEST(ImageCorrelation, IsTheSameStrainWithOtherSpecklesAndMorePixels) {
  Mat3 gradient = Mat3::Identity();
  gradient(0, 2) = 0.02;
  const FakeWorld before = packing(), after = moved(before, gradient, Vec3::Zero());
  std::vector<std::vector<float>> greys;
  for (const auto& [seed, pixels] : {std::pair(1, 25.0), std::pair(2, 25.0), std::pair(1, 36.0)}) {
    ImageCorrelation probe;
    probe.search_range = 1;
    probe.seed = seed, probe.pixels_per_diameter = pixels;
    probe.prepare(before);
    greys.push_back(probe.picture(before).grey);
    EXPECT_NEAR(channel_values(probe, after, "strain").at(2), 0.01, 3e-4) << seed << ' ' << pixels;
  }
  EXPECT_NE(greys[0], greys[1]);
  EXPECT_GT(greys[2].size(), 2 * greys[0].size());
}

TEST(ImageCorrelation, ToleratesASpecimenSmallerThanASubset) {
  FakeWorld world = packing(1, 1);
  ImageCorrelation probe;
  probe.subset = 3;
  probe.prepare(world);
  EXPECT_TRUE(std::isnan(channel_value(probe, world, "found")));
  EXPECT_TRUE(probe.fields(world).at(0).values.empty());
}

std::string refusal(ImageCorrelation& probe, const FakeWorld& world) {
  try {
    probe.prepare(world);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(ImageCorrelation, RefusesWhatHasNoFaceOrIsTooLarge) {
  FakeWorld world = packing();
  ImageCorrelation probe;
  world.box = {Vec3::Zero(), {16e-3, 3e-3, 12e-3}, {false, true, false}};
  EXPECT_EQ(refusal(probe, world),
            "depth_axis: found y, along which the domain is periodic and has no face; allowed is an axis that is "
            "not periodic");
  world.box.periodic = {true, false, true};
  EXPECT_EQ(refusal(probe, world), "");
  world.whole.high = {16, 3e-3, 12};
  EXPECT_THAT(refusal(probe, world),
              HasSubstr("pixels_per_diameter: found 25.000000, with which a picture of the specimen "
                        "has "));
  EXPECT_THAT(refusal(probe, world), HasSubstr(" million pixels; allowed is at most 67.108864 million pixels; use "
                                               "fewer per diameter, or a smaller search_range"));
}

TEST(ImageCorrelation, RefusesWindowsWithoutNeighboursAndSubsetsOfFewPixels) {
  ImageCorrelation probe;
  probe.step = 1, probe.window = 1.9;
  EXPECT_EQ(complaints(probe),
            "window: found 1.900000, allowed: at least two steps, 2.000000, so that subsets on both sides count\n");
  probe.window = 2;
  EXPECT_EQ(complaints(probe), "");
  probe.pixels_per_diameter = 8;
  EXPECT_EQ(complaints(probe),
            "subset: found 9.600000 pixels, allowed: at least 10 pixels: larger, or with more pixels_per_diameter\n");
}

INSTANTIATE_TEST_SUITE_P(ImageCorrelation, ProbeContract,
                         testing::Values(ProbeCase{"packing", [] { return std::make_shared<ImageCorrelation>(); },
                                                   [] { return packing(6, 5); }}),
                         probe_case_name);

}  // namespace
}  // namespace grit
