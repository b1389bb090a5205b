// Reference curves of a description, from CSV files.
#pragma once

#include <vector>

#include "description/description.hpp"

namespace grit {

/// A curve with rising abscissa, in the units of its file.
struct ReferencePoints {
  std::vector<double> x, y;
};

/// The finite points of the file whose abscissa exceeds those of all before. Throws FileError for a file that
/// read_columns() refuses, or with fewer than two such points.
ReferencePoints read_reference(const ReferenceCurve& curve);

}  // namespace grit
