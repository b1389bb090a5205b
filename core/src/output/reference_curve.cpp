#include "output/reference_curve.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "description/placed_error.hpp"
#include "format/csv.hpp"
#include "grit/error.hpp"

namespace grit {
namespace {

/// Largest fraction of the points that may be omitted because their abscissae do not rise.
constexpr double most_omitted = 0.25;

ReferencePoints thinned(ReferencePoints points) {
  constexpr std::size_t most = 2000;
  const std::size_t count = points.x.size();
  if (count <= most) return points;
  ReferencePoints some;
  for (std::size_t i = 0; i < most; ++i) {
    const std::size_t at = i * (count - 1) / (most - 1);
    some.x.push_back(points.x[at]), some.y.push_back(points.y[at]);
  }
  return some;
}

}  // namespace

ReferencePoints read_reference(const ReferenceCurve& curve) {
  const auto columns = read_columns(curve.file, {curve.x, curve.y});
  ReferencePoints points;
  std::size_t omitted = 0, first = 0;  // points that do not rise, as with a noisy transducer
  for (std::size_t i = 0; i < columns[0].size(); ++i) {
    const double x = columns[0][i], y = columns[1][i];
    if (!std::isfinite(x) || !std::isfinite(y)) continue;
    if (points.x.empty() || x > points.x.back()) points.x.push_back(x), points.y.push_back(y);
    else if (++omitted == 1) first = i + 1;
  }
  if (points.x.size() < 2) throw FileError(curve.file + ": fewer than two points with rising " + curve.x);
  if (static_cast<double>(omitted) > most_omitted * static_cast<double>(points.x.size() + omitted))
    throw FileError(
        fmt::format("{}: {} of {} points do not exceed all earlier ones in {}, the first in row {}; sort the rows, "
                    "or give one branch of a loop",
                    curve.file, omitted, points.x.size() + omitted, curve.x, first));
  return points;
}

Description check_references(const OutputDescription& output) {
  Description all = Description::object();
  std::vector<PlacedError::Fault> faults;
  for (const auto& [name, reference] : output.references) try {
      if (!reference.curve) continue;
      const ReferencePoints points = thinned(read_reference(*reference.curve));
      all[name] = {{"x", points.x}, {"y", points.y}};
    } catch (const FileError& error) {
      faults.push_back(
          {{"output", "references", name, "curve", "file"}, missing_file_text(error, reference.curve->file)});
    }
  if (!faults.empty()) throw PlacedError(std::move(faults));
  return all;
}

ReferencePoints kept_reference(const Description& kept) {
  ReferencePoints points{kept.at("x").get<std::vector<double>>(), kept.at("y").get<std::vector<double>>()};
  const std::size_t count = std::min(points.x.size(), points.y.size());
  points.x.resize(count), points.y.resize(count);
  return points;
}

}  // namespace grit
