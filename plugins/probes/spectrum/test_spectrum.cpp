#include "spectrum.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <numbers>
#include <numeric>
#include <random>

#include "grit/testing/probe.hpp"

namespace grit {
namespace {

using testing::HasSubstr;

constexpr double turn = 2 * std::numbers::pi;

/// A tone of this many periods a window of n points.
std::vector<double> tone(std::size_t n, double periods, double amplitude, double mean = 0) {
  std::vector<double> values(n);
  for (std::size_t i = 0; i < n; ++i)
    values[i] = mean + amplitude * std::sin(turn * periods * static_cast<double>(i) / static_cast<double>(n) + 0.7);
  return values;
}

/// What a spectrum says of a tone: the mean frequency and the amplitude of what lies within two bins of the peak.
struct Tone {
  double frequency, amplitude;
};
Tone loudest(const std::vector<double>& density, double step) {
  const auto peak = std::ranges::max_element(density) - density.begin();
  double power = 0, moment = 0;
  for (auto k = std::max<std::ptrdiff_t>(peak - 2, 0); k <= peak + 2; ++k)
    power += density.at(static_cast<std::size_t>(k)), moment += density[static_cast<std::size_t>(k)] * double(k);
  return {step * moment / power, std::sqrt(2 * power * step)};
}

// Parseval: the densities add up to the mean square of the weighted values over that of the weights.
TEST(Welch, KeepsThePowerOfAWindow) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (const std::size_t n : {8u, 10u, 256u, 1000u}) {
    std::vector<double> values(n);
    for (double& value : values) value = 5 + normal(random);
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / double(n);
    double power = 0, weights = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double weight = std::pow(std::sin(turn / 2 * double(i) / double(n)), 2);
      power += std::pow(weight * (values[i] - mean), 2), weights += weight * weight;
    }
    const auto density = power_density(values, 1e-3);
    ASSERT_EQ(density.size(), n / 2 + 1);
    const double step = 1 / (double(n) * 1e-3);
    EXPECT_NEAR(std::accumulate(density.begin(), density.end(), 0.0) * step, power / weights, 1e-13 * power / weights);
  }
}

TEST(Welch, GivesAToneOnABinItsWholePowerInThree) {
  const auto density = power_density(tone(256, 20, 3, 100), 0.01);
  const double step = 1 / 2.56, power = 0.5 * 3 * 3;
  EXPECT_NEAR(density[20] * step, power * 2 / 3, 1e-12);
  EXPECT_NEAR(density[19] * step, power / 6, 1e-12);
  EXPECT_NEAR(density[21] * step, power / 6, 1e-12);
  for (std::size_t k = 0; k < density.size(); ++k)
    if (k < 19 || k > 21) {
      EXPECT_NEAR(density[k], 0, 1e-12) << k;
    }
}

TEST(Welch, FindsAToneBetweenBins) {
  for (const double periods : {20.1, 20.3, 20.5, 60.75}) {
    const Tone found = loudest(power_density(tone(256, periods, 3), 0.01), 1 / 2.56);
    EXPECT_NEAR(found.frequency * 2.56, periods, 0.05) << periods;
    EXPECT_NEAR(found.amplitude, 3, 0.01 * 3) << periods;
  }
}

// Of white noise the density is 2 σ² interval at all frequencies; the mean over N windows that overlap by half scatters
// by about sqrt(11 / 9 N) (Welch 1967).
TEST(Welch, GivesWhiteNoiseAFlatSpectrum) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 2);
  Welch welch(64, 0.5, 4000);
  EXPECT_TRUE(std::isnan(welch.mean()[3]));
  for (int i = 0; i < 64 + 3999 * 32; ++i) welch.add(normal(random));
  EXPECT_EQ(welch.windows(), 4000u);
  const auto density = welch.mean();
  for (std::size_t k = 2; k < 31; ++k) EXPECT_NEAR(density[k] / (2 * 4 * 0.5), 1, 4 * std::sqrt(11.0 / 9 / 4000)) << k;
}

TEST(Welch, ForgetsAllButTheLastWindows) {
  Welch welch(16, 1, 3);
  for (int i = 0; i < 16; ++i) welch.add(i % 2 == 0 ? 1 : -1);
  EXPECT_GT(welch.mean()[8], 1);
  for (int i = 0; i < 16; ++i) welch.add(0);
  EXPECT_EQ(welch.windows(), 3u);
  EXPECT_GT(welch.mean()[8], 0.1) << "the first is one of the three";
  for (int i = 0; i < 8; ++i) welch.add(0);
  EXPECT_GT(welch.mean()[8], 0) << "the second had half of it";
  for (int i = 0; i < 8; ++i) welch.add(0);
  EXPECT_EQ(welch.mean()[8], 0);
}

/// A world at an instant.
using At = std::function<FakeWorld(double time)>;

/// Samples at these times; what the last one has.
ChannelValues listened(Spectrum& probe, const At& world, const std::vector<double>& times) {
  probe.prepare(world(times.front()));
  ChannelValues last("the probe", probe.channels());
  for (const double time : times) {
    FakeWorld now = world(time);
    now.now = time;
    last = sampled(probe, now);
  }
  return last;
}
std::vector<double> evenly(double step, int count) {
  std::vector<double> times;
  for (int i = 0; i < count; ++i) times.push_back(step * i);
  return times;
}

constexpr double pitch = 440, loudness = 30;  // Hz, Pa

/// A wall that swings along z and is pressed, at the same pitch.
FakeWorld swinging(double time) {
  FakeWorld world;
  world.wall = {still_wall("still"), still_wall("wall")};
  world.wall[1].velocity.z() = 0.1 * std::cos(turn * pitch * time);
  world.wall[1].pressure = 1000 + loudness * std::sin(turn * pitch * time);
  return world;
}
Spectrum at_wall() {
  Spectrum probe;
  probe.wall = "wall";
  return probe;
}
std::vector<double> listed(const ChannelValues& heard, const std::string& channel) {
  const auto list = heard.list(channel);
  return {list.begin(), list.end()};
}
std::vector<double> along(const ChannelValues& heard, char axis) {
  return listed(heard, std::string("acceleration_density_") + axis);
}
std::vector<double> pressed(const ChannelValues& heard) { return listed(heard, "pressure_density"); }
/// Between two frequencies [Hz].
double step_of(const ChannelValues& heard) { return heard.list("frequency")[1]; }

TEST(Spectrum, FindsThePitchOfAWall) {
  Spectrum probe = at_wall();
  const auto heard = listened(probe, swinging, evenly(1e-4, 2000));
  const double step = step_of(heard);
  EXPECT_NEAR(step, 1 / 0.0256, 1e-12);
  EXPECT_NEAR(heard.list("frequency").back(), 5000, 1e-9);
  const Tone pressure = loudest(pressed(heard), step);
  EXPECT_NEAR(pressure.frequency, pitch, 0.05 * step);
  EXPECT_NEAR(pressure.amplitude, loudness, 0.01 * loudness);
  // A difference over h has sin(πfh) / πfh of the derivative.
  const Tone acceleration = loudest(along(heard, 'z'), step);
  const double less = std::sin(turn / 2 * pitch * 1e-4) / (turn / 2 * pitch * 1e-4);
  EXPECT_NEAR(acceleration.frequency, pitch, 0.05 * step);
  EXPECT_NEAR(acceleration.amplitude, 0.1 * turn * pitch * less, 0.01 * 0.1 * turn * pitch);
  for (const double density : along(heard, 'x')) EXPECT_EQ(density, 0);
  EXPECT_EQ(heard["windows"], 8);
}

TEST(Spectrum, BringsSamplesToEqualTimes) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> step(0.1e-4, 0.4e-4);
  std::vector<double> times{0};
  while (times.back() < 0.2) times.push_back(times.back() + step(random));
  Spectrum probe = at_wall();
  const auto heard = listened(probe, swinging, times);
  const Tone pressure = loudest(pressed(heard), step_of(heard));
  EXPECT_NEAR(pressure.frequency, pitch, 0.05 * step_of(heard));
  EXPECT_NEAR(pressure.amplitude, loudness, 0.01 * loudness);
}

TEST(Spectrum, ListensToTheGrainsInABox) {
  const At shaken = [](double time) {
    FakeWorld world;
    const double acceleration = 7 * std::sin(turn * pitch * time);
    for (const double x : {0.2, 0.4, 3.0}) {
      const auto body = world.add({x, 0.5, 0.5}, x == 0.2 ? 0.1 : 0.05);
      world.force[body] = {acceleration / world.velocity[body].w * (x < 1 ? 1 : 50), 0, 0, 0};
    }
    world.add_contact(0, 1, Vec3(0.2, 0, 0), Vec3(10 + 3 * std::sin(turn * pitch * time), 0, 0));
    return world;
  };
  Spectrum probe;
  probe.region_low = Vec3(0, 0, 0), probe.region_high = Vec3(1, 1, 0.8);
  const auto heard = listened(probe, shaken, evenly(1e-4, 2000));
  EXPECT_NEAR(loudest(along(heard, 'x'), step_of(heard)).amplitude, 7, 0.01 * 7);
  EXPECT_NEAR(loudest(pressed(heard), step_of(heard)).amplitude, 3 * 0.2 / 0.8 / 3, 0.01 * 0.25);
  for (const double density : along(heard, 'y')) EXPECT_EQ(density, 0);
}

TEST(Spectrum, KnowsNothingBeforeTheFirstWindowIsFullAndAfterAGap) {
  Spectrum probe = at_wall();
  probe.points = 16;
  auto times = evenly(1e-4, 16);  // the first has no acceleration yet
  auto heard = listened(probe, swinging, times);
  EXPECT_EQ(heard["windows"], 0);
  EXPECT_TRUE(std::isnan(heard.list("pressure_density")[3]));
  times.push_back(16e-4);
  heard = listened(probe, swinging, times);
  EXPECT_EQ(heard["windows"], 1);
  EXPECT_TRUE(std::isfinite(heard.list("pressure_density")[3]));
  for (int i = 0; i < 16; ++i) times.push_back(16e-4 + 1.5e-4 + 1e-4 * i);
  EXPECT_EQ(listened(probe, swinging, times)["windows"], 3) << "bridged by a line";
  for (int i = 17; i < 33; ++i) times[static_cast<std::size_t>(i)] += 1e-4;
  EXPECT_EQ(listened(probe, swinging, times)["windows"], 0) << "begun again";
}

/// A grain just above the lower side and one just below the upper side of a period of 1 along x, that are pushed.
FakeWorld across_a_side(double) {
  FakeWorld world;
  for (const double x : {0.1, 0.9, 0.5}) {
    const auto body = world.add({x, 0.5, 0.5}, 0.05);
    world.force[body] = {(x == 0.1 ? 3 : x == 0.9 ? 5 : 100) / world.velocity[body].w, 0, 0, 0};
  }
  world.box = {{0, -9, -9}, {1, 9, 9}, {true, false, false}};
  return world;
}

/// A box of grains that are pushed now and then: the amplitude of their mean acceleration along x.
double heard(double low, double high) {
  Spectrum probe;
  probe.region_low = Vec3(low, 0, 0), probe.region_high = Vec3(high, 1, 1);
  const At shaken = [](double time) {
    FakeWorld world = across_a_side(time);
    for (Row& force : world.force) force.x *= std::sin(turn * pitch * time);
    return world;
  };
  const auto heard = listened(probe, shaken, evenly(1e-4, 300));
  return loudest(along(heard, 'x'), step_of(heard)).amplitude;
}

TEST(Spectrum, ListensToPeriodicImagesToo) {
  for (const double shift : {-1.0, 0.0, 2.0}) EXPECT_NEAR(heard(shift - 0.2, shift + 0.2), 4, 0.04) << shift;
  EXPECT_NEAR(heard(0, 0.2), 3, 0.03);
  EXPECT_NEAR(heard(0.1, 0.9), 51.5, 0.5) << "the upper side is not of the box";
  EXPECT_NEAR(heard(0.1, 1.1), 36, 0.4) << "all, each once";
}

TEST(Spectrum, RefusesABoxLongerThanThePeriod) {
  Spectrum probe;
  probe.region_low = Vec3(0, -20, 0), probe.region_high = Vec3(1, 20, 1);
  EXPECT_NO_THROW(probe.prepare(across_a_side(0)));
  probe.region_high->x() = 1.25;
  EXPECT_THAT(
      [&] { probe.prepare(across_a_side(0)); },
      testing::ThrowsMessage<ParameterError>(
          "region_high: found a box of 1.250000 m along x; allowed is at most the period of the domain, 1.000000 "
          "m"));
}

/// A wall at rest that is at a bound in no time at `jump` [s], and then speeds up evenly.
At kicked(double jump) {
  return [jump](double time) {
    FakeWorld world = swinging(time);
    world.wall[1].velocity = {0, 0, 7 * time + (time > jump ? 1e3 : 0)};
    return world;
  };
}

TEST(Spectrum, DoesNotTakeTheFirstInstantNorAGapForAcceleration) {
  std::vector<double> times;
  for (int i = 0; i < 60; ++i) times.push_back(1.5e-4 * i + (i < 10 ? 0 : 0.1));  // not a whole number of points apart
  for (const auto& [from, jump] : std::vector<std::pair<std::ptrdiff_t, double>>{{0, 0.05}, {10, -1}}) {
    Spectrum probe = at_wall();
    probe.points = 16;
    const auto heard = listened(probe, kicked(jump), {times.begin() + from, times.end()});
    EXPECT_EQ(heard["windows"], 8) << from;
    for (const double density : along(heard, 'z')) EXPECT_NEAR(density, 0, 1e-12) << from;
  }
}

TEST(Spectrum, SaysWhereEachNumberOfAListIs) {
  for (const Channel& channel : Spectrum().channels())
    EXPECT_EQ(channel.coordinate, channel.shape.empty() || channel.name == "frequency" ? "" : "frequency")
        << channel.name;
}

TEST(Spectrum, RefusesWhatIsNeitherAWallNorABox) {
  Spectrum probe;
  EXPECT_THAT(complaints(probe), HasSubstr("wall: found neither a wall nor a box, allowed: one of them"));
  probe.region_low = Vec3::Zero();
  EXPECT_THAT(
      complaints(probe),
      HasSubstr("region_high: found one corner of a box, allowed: both region_low and region_high, or neither"));
  probe.region_high = Vec3(1, 0, 1);
  EXPECT_THAT(complaints(probe), HasSubstr("region_high: found a corner not above region_low"));
  probe.region_high = Vec3(1, 1, 1);
  EXPECT_EQ(complaints(probe), "");
  probe.wall = "wall";
  EXPECT_THAT(complaints(probe), HasSubstr("wall: found a wall and a box, allowed: one of them"));
  Spectrum odd = at_wall();
  odd.points = 25;
  EXPECT_EQ(complaints(odd), "points: found 25, allowed: an even number\n");
  Spectrum large = at_wall();
  large.points = 100000, large.windows = 1000;
  EXPECT_EQ(complaints(large), "");
  large.windows = 1001;
  EXPECT_EQ(complaints(large),
            "windows: found 1001 of 100000 points, allowed: at most 100000000 points in all windows\n");
  Spectrum nowhere = at_wall();
  nowhere.wall = "well";
  try {
    nowhere.prepare(swinging(0));
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("wall: found \"well\", which is not a wall; did you mean \"wall\"?"));
  }
}

INSTANTIATE_TEST_SUITE_P(Spectrum, ProbeContract,
                         testing::Values(ProbeCase{"wall",
                                                   [] {
                                                     auto probe = std::make_shared<Spectrum>();
                                                     probe->wall = "top-wall";
                                                     return probe;
                                                   }},
                                         ProbeCase{"short_windows",
                                                   [] {
                                                     auto probe = std::make_shared<Spectrum>();
                                                     probe->wall = "top-wall", probe->points = 8, probe->windows = 2;
                                                     return probe;
                                                   }},
                                         ProbeCase{"box",
                                                   [] {
                                                     auto probe = std::make_shared<Spectrum>();
                                                     probe->region_low = Vec3::Zero();
                                                     probe->region_high = Vec3::Constant(2e-3);
                                                     return probe;
                                                   }}),
                         probe_case_name);

}  // namespace
}  // namespace grit
