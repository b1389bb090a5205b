// Reference curves of a description, from CSV files.
#pragma once

#include <vector>

#include "description/description.hpp"

namespace grit {

/// A curve with rising abscissa, in the units of its file.
struct ReferencePoints {
  std::vector<double> x, y;
};

/// The finite points of the file whose abscissae exceed all before. Throws FileError as read_columns() does, or if
/// there are fewer than two such points, or more than a quarter of the finite points would be omitted.
ReferencePoints read_reference(const ReferenceCurve& curve);

/// Reads the reference curves of a description before its run. Throws PlacedError with every file at fault. Returns
/// {"x": […], "y": […]} by name, as run.json keeps them; of long curves up to 2000 points at even intervals.
Description check_references(const OutputDescription& output);

/// The points of a curve in a run.json. Throws Description::exception for anything else.
ReferencePoints kept_reference(const Description& kept);

}  // namespace grit
