#include "bodies/sizes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bodies/normal.hpp"
#include "bodies/same_bits.hpp"
#include "grit/error.hpp"

namespace grit {

namespace {

/// `quantile` gives the diameter below which a fraction of the number lies.
template <class Quantile>
std::vector<double> stratified(std::size_t count, Random& random, const Quantile& quantile) {
  std::vector<double> diameters(count);
  for (std::size_t i = 0; i < count; ++i)
    diameters[i] = quantile((static_cast<double>(i) + 0.5) / static_cast<double>(count));
  random.shuffle(diameters);
  return diameters;
}

/// For mass distributed uniformly over the diameters a … b, numbers are proportional to 1/d³ and their fraction below d
/// is (1/a² − 1/d²) / (1/a² − 1/b²); solved for d.
double even_mass_quantile(double a, double b, double share) {
  const double ratio = a / b;
  return std::clamp(a / std::sqrt(1 - share * (1 - ratio * ratio)), a, b);
}

void check(const SieveSizes& sieve) {
  const auto& [d, passing] = sieve;
  const bool curve = d.size() >= 2 && passing.size() == d.size() && d.front() > 0 &&
                     std::is_sorted(d.begin(), d.end(), std::less_equal<>()) && passing.front() == 0 &&
                     passing.back() == 1 && std::is_sorted(passing.begin(), passing.end());
  if (!curve)
    throw Error(
        "sieve sizes: `diameters` must be positive and increase, `passing` must not decrease from 0 to 1, and both "
        "need "
        "the same number of entries, 2 or more; found " +
        std::to_string(d.size()) + " diameters and " + std::to_string(passing.size()) + " fractions");
}

}  // namespace

std::vector<double> draw_diameters(const UniformSizes& sizes, std::size_t count, Random& random) {
  return stratified(count, random,
                    [&](double share) { return sizes.smallest + share * (sizes.largest - sizes.smallest); });
}

std::vector<double> draw_diameters(const LinearSizes& sizes, std::size_t count, Random& random) {
  return stratified(count, random,
                    [&](double share) { return even_mass_quantile(sizes.smallest, sizes.largest, share); });
}

std::vector<double> draw_diameters(const LogNormalSizes& sizes, std::size_t count, Random& random) {
  const auto score = [&](double d) { return same_bits::log(d / sizes.median) / sizes.log_standard_deviation; };
  const double low = score(sizes.smallest), high = score(sizes.largest);
  // Fractions are computed from the nearer tail, where they are more accurate.
  const double sign = low + high > 0 ? -1 : 1;
  const double first = normal_fraction(sign * low), last = normal_fraction(sign * high);
  return stratified(count, random, [&](double share) {
    const double z = sign * normal_quantile(first + share * (last - first));
    return std::clamp(sizes.median * same_bits::exp(sizes.log_standard_deviation * z), sizes.smallest, sizes.largest);
  });
}

std::vector<double> draw_diameters(const SieveSizes& sizes, std::size_t count, Random& random) {
  check(sizes);
  const std::vector<double>&d = sizes.diameters, &passing = sizes.passing;
  std::vector<double> numbers(d.size(), 0.0);  // of grains below each diameter, per mass
  for (std::size_t i = 1; i < d.size(); ++i)
    numbers[i] =
        numbers[i - 1] + (passing[i] - passing[i - 1]) * (d[i - 1] + d[i]) / (2 * d[i - 1] * d[i - 1] * d[i] * d[i]);
  return stratified(count, random, [&](double share) {
    const double wanted = share * numbers.back();
    const std::size_t above =
        as_index(std::upper_bound(numbers.begin() + 1, numbers.end() - 1, wanted) - numbers.begin());
    const double within = (wanted - numbers[above - 1]) / (numbers[above] - numbers[above - 1]);
    return even_mass_quantile(d[above - 1], d[above], within);
  });
}

std::vector<double> draw_diameters(const ListSizes& sizes, std::size_t count, Random&) {
  if (sizes.diameters.empty()) throw Error("list of sizes: found no diameters; give one or more");
  std::vector<double> diameters(count);
  for (std::size_t i = 0; i < count; ++i) diameters[i] = sizes.diameters[i % sizes.diameters.size()];
  return diameters;
}

double largest_diameter(const Sizes& sizes, std::optional<double> shape_diameter) {
  Random random(0);
  return std::visit(
      [&]<class S>(const S& chosen) {
        if constexpr (requires { chosen.largest; }) return chosen.largest;
        else if constexpr (requires { chosen.diameters; }) return std::ranges::max(chosen.diameters);
        else return draw_diameters(sizes, 1, random, shape_diameter).front();
      },
      sizes.value());
}

std::vector<double> draw_diameters(const Sizes& sizes, std::size_t count, Random& random,
                                   std::optional<double> shape_diameter) {
  return std::visit(
      [&]<class S>(const S& chosen) -> std::vector<double> {
        if constexpr (std::same_as<S, std::monostate>) {
          throw Error("sizes of grains: no size distribution was chosen");
        } else if constexpr (std::same_as<S, ShapeSizes>) {
          if (!shape_diameter)
            throw Error(
                "sizes of type shape: these bodies have no size of their own; use a clump whose shape is a list or a "
                "file, or other sizes");
          return std::vector<double>(count, *shape_diameter);
        } else {
          return draw_diameters(chosen, count, random);
        }
      },
      sizes.value());
}

}  // namespace grit
