#include "study/figures.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "grit/error.hpp"
#include "output/read_results.hpp"

namespace grit {
namespace {

/// What is finite of both.
Figure finite(const std::vector<double>& x, const std::vector<double>& y, const std::string& unit,
              const std::string& x_unit) {
  Figure all{{}, {}, unit, x_unit};
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i)
    if (std::isfinite(x[i]) && std::isfinite(y[i])) all.x.push_back(x[i]), all.y.push_back(y[i]);
  return all;
}

/// What an abscissa passes for the first time; noise to and fro is left out.
Figure rising(const Figure& all) {
  Figure curve{{}, {}, all.unit, all.x_unit};
  for (std::size_t i = 0; i < all.x.size(); ++i)
    if (curve.x.empty() || all.x[i] > curve.x.back()) curve.x.push_back(all.x[i]), curve.y.push_back(all.y[i]);
  return curve;
}

/// The numbers of the last sample.
std::vector<double> last_row(const SampledChannel& channel) {
  const std::size_t row = channel.samples > 0 ? channel.values.size() / channel.samples : 0;
  return {channel.values.end() - static_cast<std::ptrdiff_t>(row), channel.values.end()};
}

/// The channel of the instants at which a channel was sampled.
std::string time_of(const std::string& channel) { return channel.substr(0, channel.find('/')) + "/time"; }

/// What stands below each number of a figure's channel: another channel, or time, or the place in a profile.
SampledChannel abscissa_of(const FigureDescription& figure, const SampledChannel& of,
                           const std::filesystem::path& folder, const std::string& where) {
  const std::string time = time_of(figure.of);
  if (figure.against.empty() && !std::holds_alternative<ProfileFigure>(figure.what.value()))
    return read_channel(folder, time);
  if (figure.against.empty()) {
    SampledChannel place{.unit = "1", .doc = "place", .samples = 1, .values = std::vector<double>(last_row(of).size())};
    std::iota(place.values.begin(), place.values.end(), 0.0);
    return place;
  }
  SampledChannel against = read_channel(folder, figure.against);
  if (against.samples != of.samples ||
      (time_of(figure.against) != time &&
       read_channel(folder, time_of(figure.against)).values != read_channel(folder, time).values))
    throw FileError(where + " and " + figure.against +
                    " are not of the same instants; give both probes the same cadence and stages");
  if (against.values.size() != of.values.size())
    throw FileError(where + " and " + figure.against + " do not have as many numbers a sample");
  return against;
}

/// Of a curve between two abscissae, by the trapezoidal rule.
double mean(const Figure& curve, double from, double to) {
  if (curve.x.size() == 1) return curve.y.front();
  std::vector<double> x{from}, y{at(curve, from)};
  for (std::size_t i = 0; i < curve.x.size(); ++i)
    if (curve.x[i] > from && curve.x[i] <= to) x.push_back(curve.x[i]), y.push_back(curve.y[i]);
  double area = 0;
  for (std::size_t i = 1; i < x.size(); ++i) area += 0.5 * (y[i] + y[i - 1]) * (x[i] - x[i - 1]);
  return area / (to - from);
}

/// One value of a curve.
Figure value_of(const FigureDescription& figure, const Figure& all) {
  const auto one = [](double value, const std::string& unit) { return Figure{{}, {value}, unit, ""}; };
  const auto& what = figure.what.value();
  const auto largest = std::ranges::max_element(all.y);
  if (std::holds_alternative<MaximumFigure>(what)) return one(*largest, all.unit);
  if (std::holds_alternative<PlaceOfMaximumFigure>(what))
    return one(all.x[static_cast<std::size_t>(largest - all.y.begin())], all.x_unit);
  if (std::holds_alternative<MinimumFigure>(what)) return one(std::ranges::min(all.y), all.unit);
  const Figure curve = rising(all);
  if (const auto* m = std::get_if<MeanFigure>(&what)) {
    const double to = curve.x.back();
    return one(mean(curve, std::max(curve.x.front(), to - m->share * (to - curve.x.front())), to), all.unit);
  }
  if (const auto* v = std::get_if<ValueFigure>(&what)) {
    const double value = at(curve, v->at);
    if (std::isnan(value))
      throw NumericsError(fmt::format("{} is of abscissae from {:g} to {:g}, but wanted at {:g}", figure.of,
                                      curve.x.front(), curve.x.back(), v->at));
    return one(value, all.unit);
  }
  return one(all.y.back(), all.unit);
}

}  // namespace

double at(const Figure& curve, double x) {
  const auto above = std::ranges::lower_bound(curve.x, x);
  if (above == curve.x.end() || (above == curve.x.begin() && *above != x))
    return std::numeric_limits<double>::quiet_NaN();
  const auto i = static_cast<std::size_t>(above - curve.x.begin());
  if (curve.x[i] == x) return curve.y[i];
  const double share = (x - curve.x[i - 1]) / (curve.x[i] - curve.x[i - 1]);
  return curve.y[i - 1] + share * (curve.y[i] - curve.y[i - 1]);
}

Figure take_figure(const FigureDescription& figure, const std::filesystem::path& folder) {
  const SampledChannel of = read_channel(folder, figure.of);
  const std::string where = (folder / "series.h5").string() + ": " + figure.of;
  if (of.samples == 0) throw NumericsError(figure.of + " has no sample");
  const bool profile = std::holds_alternative<ProfileFigure>(figure.what.value());
  if (!profile && of.values.size() != of.samples)
    throw FileError(where + " has several numbers a sample, which only a profile takes");
  const SampledChannel against = abscissa_of(figure, of, folder, where);
  const Figure all =
      finite(profile ? last_row(against) : against.values, profile ? last_row(of) : of.values, of.unit, against.unit);
  if (all.x.empty()) throw NumericsError(figure.of + " has no finite number");
  return figure.is_curve() ? rising(all) : value_of(figure, all);
}

}  // namespace grit
