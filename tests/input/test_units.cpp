#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <regex>
#include <thread>

#include "grit/error.hpp"
#include "input/units.hpp"

using namespace grit;

double si(const std::string& text, const std::string& unit) {
  const auto found = parse_quantity(text, unit);
  EXPECT_TRUE(found) << text;
  return found ? found->value : std::nan("");
}

TEST(Units, DecimalFactorsAreExact) {
  EXPECT_EQ(si("200 kPa", "Pa"), 2e5);
  EXPECT_EQ(si("300MPa", "Pa"), 3e8);
  EXPECT_EQ(si("-1.5 bar", "Pa"), -1.5e5);
  EXPECT_EQ(si("2.6 g/cm^3", "kg/m^3"), 2600);
  EXPECT_EQ(si("5 %", "1"), 0.05);
  EXPECT_EQ(si("0.25", "1"), 0.25);
  EXPECT_EQ(si("+1e-3 %/s", "1/s"), 1e-5);
  EXPECT_EQ(si("7 N mm", "N m"), 7e-3);
}

TEST(Units, EveryTenthOfAMillimetreIsTheNearestDouble) {
  for (int i = 1; i < 1000; ++i) {
    const std::string number = std::to_string(i / 10) + '.' + std::to_string(i % 10);
    EXPECT_EQ(si(number + " mm", "m"), std::stod(number + "e-3"));
    EXPECT_EQ(si(number + "e1 um", "m"), std::stod(number + "e-5"));
  }
}

TEST(Units, OtherFactorsAreRoundedToAnUlp) {
  const auto within_ulp = [](double a, double b) { return a == b || std::nextafter(a, b) == b; };
  EXPECT_TRUE(within_ulp(si("18 deg", "rad"), 18 * std::numbers::pi / 180));
  EXPECT_TRUE(within_ulp(si("18 degree", "rad"), 18 * std::numbers::pi / 180));
  EXPECT_TRUE(within_ulp(si("18°", "rad"), 18 * std::numbers::pi / 180));
  EXPECT_TRUE(within_ulp(si("60 rpm", "rad/s"), 2 * std::numbers::pi));
  EXPECT_EQ(si("1.5 min", "s"), 90);
  EXPECT_EQ(si("17 kN/m^3", "N/m^3"), 17e3);
  EXPECT_TRUE(within_ulp(si("1 mm/min", "m/s"), 1e-3 / 60));
}

TEST(Units, UnitsOutsideTheTableAreRefused) {
  for (const char* text : {"200", "200 m", "kPa", "200 kpa", "200 kPa ", " 200 kPa", "2,5 kPa", "0x10 Pa", "1e Pa",
                           "nan Pa", "inf Pa", ""})
    EXPECT_FALSE(parse_quantity(text, "Pa")) << text;
  for (const char* text : {"5 m", "%", "five"}) EXPECT_FALSE(parse_quantity(text, "1")) << text;
  EXPECT_FALSE(parse_quantity(std::string(100000, '1') + " Pa", "Pa"));
}

TEST(Units, TooLargeANumberIsInfinite) {
  EXPECT_EQ(si("1e400 Pa", "Pa"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(si("1e-400 Pa", "Pa"), 0);
}

TEST(Units, EverySpellingConvertsAndMatchesThePattern) {
  for (const char* unit :
       {"1",     "m",     "m^2",   "m^3",   "s",       "kg",    "kg/s", "Pa",     "N",      "N m",
        "rad",   "m/s",   "m/s^2", "rad/s", "1/s",     "Hz",    "1/m",  "kg/m^3", "kg m^2", "J",
        "J/m^2", "J/m^3", "W",     "N/m",   "N m/rad", "N s/m", "Pa s", "Pa/m",   "Pa/s",   "N/m^3"}) {
    const std::regex pattern(quantity_pattern(unit));
    for (const auto& spelling : unit_spellings(unit)) {
      const auto found = parse_quantity("2 " + spelling, unit);
      ASSERT_TRUE(found) << unit << ": " << spelling;
      EXPECT_EQ(found->spelling, spelling);
      EXPECT_GT(found->value, 0);
      EXPECT_TRUE(std::regex_match("2 " + spelling, pattern)) << unit << ": " << spelling;
    }
    EXPECT_FALSE(std::regex_match("2 furlong", pattern));
  }
}

TEST(Units, AUnitOutsideTheTableHasItsOwnSpelling) {
  EXPECT_EQ(si("3 Pa s/m", "Pa s/m"), 3);
  EXPECT_FALSE(parse_quantity("3 kPa s/m", "Pa s/m"));
  EXPECT_THROW(parse_quantity("3 quux", "quux"), PluginError);
}

TEST(Units, FriendlyTextsAreShort) {
  EXPECT_EQ(friendly_text(3e8, "Pa"), "300 MPa");
  EXPECT_EQ(friendly_text(18 * std::numbers::pi / 180, "rad"), "18 deg");
  EXPECT_EQ(friendly_text(2.5e-4, "m"), "250 um");
  EXPECT_EQ(friendly_text(0, "m"), "0 m");
  EXPECT_EQ(friendly_text(0.05, "1"), "0.05");
  EXPECT_EQ(friendly_text(2600, "kg/m^3"), "2600 kg/m^3");
  EXPECT_EQ(quantity_text(0.05, "1", "%"), "5%");
}

TEST(Units, SeveralThreadsMayConvert) {
  std::vector<std::thread> threads;
  std::vector<double> sums(4);
  for (auto& sum : sums)
    threads.emplace_back([&sum] {
      for (int i = 0; i < 200; ++i)
        for (const auto& spelling : unit_spellings("Pa")) sum += parse_quantity("1 " + spelling, "Pa")->value;
    });
  for (auto& thread : threads) thread.join();
  for (const double sum : sums) EXPECT_EQ(sum, sums.front());
}
