// Files of comma-separated values.
#pragma once

#include <string>
#include <vector>

namespace grit {

/// Columns of a CSV file by name, read from a line of names and lines of numbers. Lines that begin with # are comments.
/// Throws FileError as read_text() does, and with file and line if a column is missing, a cell is not a number or a
/// line has more cells than there are names.
std::vector<std::vector<double>> read_columns(const std::string& file, const std::vector<std::string>& names);

/// A cell in quotation marks.
std::string quoted_cell(const std::string& text);

}  // namespace grit
