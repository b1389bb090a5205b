// Files of comma-separated values.
#pragma once

#include <string>
#include <vector>

namespace grit {

/// Columns of a CSV file by name, read from a line of names and lines of numbers. Lines that begin with # are comments.
/// A byte order mark and Windows line ends are accepted. Throws FileError with file and line if the file is unreadable,
/// a column is missing, or a cell is not a number.
std::vector<std::vector<double>> read_columns(const std::string& file, const std::vector<std::string>& names);

/// A cell in quotation marks.
std::string quoted_cell(const std::string& text);

}  // namespace grit
