// Files of comma-separated values.
#pragma once

#include <string>
#include <vector>

namespace grit {

/// Columns of a CSV file by name, read from a line of names and lines of numbers. Lines that begin with # are comments;
/// a byte order mark and line ends of other systems are accepted. Throws FileError with file and line: not readable, no
/// such column, not a number.
std::vector<std::vector<double>> read_columns(const std::string& file, const std::vector<std::string>& names);

/// A cell in quotation marks.
std::string quoted_cell(const std::string& text);

}  // namespace grit
