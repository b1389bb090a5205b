#include "output/reference_curve.hpp"

#include <cmath>
#include <utility>

#include "description/placed_error.hpp"
#include "format/csv.hpp"
#include "grit/error.hpp"

namespace grit {

ReferencePoints read_reference(const ReferenceCurve& curve) {
  const auto columns = read_columns(curve.file, {curve.x, curve.y});
  ReferencePoints points;
  for (std::size_t i = 0; i < columns[0].size(); ++i) {
    const double x = columns[0][i], y = columns[1][i];
    if (std::isfinite(x) && std::isfinite(y) && (points.x.empty() || x > points.x.back()))
      points.x.push_back(x), points.y.push_back(y);
  }
  if (points.x.size() < 2) throw FileError(curve.file + ": fewer than two points with rising " + curve.x);
  return points;
}

void check_references(const OutputDescription& output) {
  std::vector<PlacedError::Fault> faults;
  for (const auto& [name, reference] : output.references) try {
      if (reference.curve) read_reference(*reference.curve);
    } catch (const FileError& error) {
      faults.push_back(
          {{"output", "references", name, "curve", "file"}, missing_file_text(error, reference.curve->file)});
    }
  if (!faults.empty()) throw PlacedError(std::move(faults));
}

}  // namespace grit
