#include "study/figures.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numeric>
#include <sstream>

#include "grit/error.hpp"
#include "output/read_results.hpp"

namespace grit {
namespace {

/// What an abscissa passes for the first time; noise to and fro is left out.
Figure rising(const std::vector<double>& x, const std::vector<double>& y) {
  Figure curve;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
    if (!curve.x.empty() && !(x[i] > curve.x.back())) continue;
    curve.x.push_back(x[i]), curve.y.push_back(y[i]);
  }
  return curve;
}

/// The numbers of the last sample.
std::vector<double> last_row(const SampledChannel& channel) {
  const std::size_t row = channel.samples > 0 ? channel.values.size() / channel.samples : 0;
  return {channel.values.end() - static_cast<std::ptrdiff_t>(row), channel.values.end()};
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

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> all;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) {
    const auto first = cell.find_first_not_of(" \t\r\""), last = cell.find_last_not_of(" \t\r\"");
    all.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
  }
  return all;
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
  if (of.samples == 0) throw FileError((folder / "series.h5").string() + ": " + figure.of + " has no sample");
  if (std::holds_alternative<ProfileFigure>(figure.what.value())) {
    Figure profile;
    std::vector<double> place;
    if (figure.against.empty()) {
      place.resize(last_row(of).size());
      std::iota(place.begin(), place.end(), 0.0);
      profile = rising(place, last_row(of));
    } else {
      const SampledChannel against = read_channel(folder, figure.against);
      profile = rising(last_row(against), last_row(of));
      profile.x_unit = against.unit;
    }
    profile.unit = of.unit;
    return profile;
  }
  if (of.values.size() != of.samples)
    throw FileError((folder / "series.h5").string() + ": " + figure.of +
                    " has several numbers a sample, which only a profile takes");
  const SampledChannel against = read_channel(
      folder, figure.against.empty() ? figure.of.substr(0, figure.of.find('/')) + "/time" : figure.against);
  Figure curve = rising(against.values, of.values);
  if (curve.x.empty()) throw FileError((folder / "series.h5").string() + ": " + figure.of + " has no finite sample");
  curve.unit = of.unit, curve.x_unit = against.unit;
  if (figure.is_curve()) return curve;

  const auto one = [&](double value, const std::string& unit) { return Figure{{}, {value}, unit, ""}; };
  const auto& what = figure.what.value();
  const auto largest = std::ranges::max_element(curve.y);
  if (std::holds_alternative<MaximumFigure>(what)) return one(*largest, of.unit);
  if (std::holds_alternative<PlaceOfMaximumFigure>(what))
    return one(curve.x[static_cast<std::size_t>(largest - curve.y.begin())], against.unit);
  if (std::holds_alternative<MinimumFigure>(what)) return one(std::ranges::min(curve.y), of.unit);
  if (const auto* m = std::get_if<MeanFigure>(&what)) {
    const double to = curve.x.back();
    const double from = std::max(curve.x.front(), to - m->share * (to - curve.x.front()));
    return one(mean(curve, from, to), of.unit);
  }
  if (const auto* v = std::get_if<ValueFigure>(&what)) {
    const double value = at(curve, v->at);
    if (std::isnan(value))
      throw FileError((folder / "series.h5").string() + ": " + figure.of + " does not reach the abscissa " +
                      std::to_string(v->at));
    return one(value, of.unit);
  }
  return one(curve.y.back(), of.unit);
}

Figure read_reference(const ReferenceCurve& curve) {
  std::ifstream file(curve.file);
  if (!file) throw FileError(curve.file + ": cannot be read");
  std::string line;
  std::getline(file, line);
  const auto names = cells(line);
  const auto column = [&](const std::string& name) {
    const auto found = std::ranges::find(names, name);
    if (found == names.end())
      throw FileError(curve.file + ":1: there is no column \"" + name + "\" in \"" + line + '"');
    return static_cast<std::size_t>(found - names.begin());
  };
  const std::size_t x = column(curve.x), y = column(curve.y);
  std::vector<double> xs, ys;
  for (int number = 2; std::getline(file, line); ++number) {
    const auto row = cells(line);
    if (row.empty() || row.front().starts_with('#')) continue;
    try {
      xs.push_back(std::stod(row.at(x))), ys.push_back(std::stod(row.at(y)));
    } catch (const std::exception&) {
      throw FileError(curve.file + ':' + std::to_string(number) + ": not two numbers in columns " + curve.x + " and " +
                      curve.y + ": \"" + line + '"');
    }
  }
  Figure found = rising(xs, ys);
  if (found.x.size() < 2) throw FileError(curve.file + ": fewer than two points with rising " + curve.x);
  return found;
}

}  // namespace grit
