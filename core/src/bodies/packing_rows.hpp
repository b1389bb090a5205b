// Rows of text files of packings: one line per body, with any columns.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "description/description.hpp"
#include "grit/error.hpp"
#include "grit/vec.hpp"

namespace grit {

/// A body of a file: centre [m], w: radius [m]; velocity [m/s]; spin [rad/s].
struct PackedBody {
  Row sphere{};
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
};

/// What a column holds. Those before `type` are numbers.
enum class Column : std::uint8_t { x, y, z, radius, diameter, vx, vy, vz, wx, wy, wz, type, id, skip };

/// By the name of a column in a description ("r", "vx", "-").
std::optional<Column> column_of_description(std::string_view name);
/// By a name that another code writes, in any case ("radius", "v_x", "omegax"); skip if it is unknown.
Column column_of_header(std::string_view name);
/// Of all names of a header. Of two columns with the same quantity the second is skipped, and a diameter beside a
/// radius.
std::vector<Column> columns_of_header(std::span<const std::string_view> names);
/// The quantities that a body needs and that these columns lack, e.g. "z, radius or diameter"; empty if there are none.
std::string lacking(std::span<const Column> columns);

/// Lines of a text, one after the other.
class TextLines {
 public:
  explicit TextLines(std::string_view text) : rest_(text) {}
  /// Goes to the next line; false at the end.
  bool next();
  std::string_view line() const { return line_; }
  int number() const { return number_; }  ///< of the line, from 1

 private:
  std::string_view rest_, line_;
  int number_ = 0;
};

std::string lower_case(std::string_view text);
std::string_view without_comment(std::string_view line);
bool is_blank(std::string_view line);

/// Cells of a line. Separator ' ': words between blanks. Otherwise cells lose blanks and quotation marks around them,
/// and an empty cell at the end is dropped.
void split(std::string_view line, char separator, std::vector<std::string_view>& cells);
/// ';', ',' or ' ', whichever separates the cells of this line.
char separator_of(std::string_view line);

/// Faults of a file, of which a DescriptionError lists the first ones.
class PackingFaults {
 public:
  explicit PackingFaults(const std::filesystem::path& path) : path_(path.string()) {}
  void add(int line, std::string message);
  bool any() const { return !problems_.empty(); }
  /// Throws if there are any.
  void raise();
  [[noreturn]] void raise(int line, std::string message);

 private:
  std::string path_;
  std::vector<Problem> problems_;
  std::size_t left_out_ = 0;
};

/// Reads rows of the same form.
class RowReader {
 public:
  /// `more`: whether further cells may follow the columns, as many in each row.
  RowReader(const FileSource& source, PackingFaults& faults, std::vector<Column> columns, char separator = ' ',
            bool more = false);
  /// The body of a row; none if it is at fault or if its type is not the one to read.
  std::optional<PackedBody> read(std::string_view line, int number);
  /// The cell with the id of the last row; empty without such a column, and for a row with other columns.
  std::string_view id() const { return id_; }
  /// Reports a particle type that no row has.
  void check_types();

 private:
  bool is_wanted(std::string_view type);
  std::string problem(PackedBody& body) const;

  const FileSource& source_;
  PackingFaults& faults_;
  std::vector<Column> columns_;
  char separator_;
  bool more_;
  std::size_t width_ = 0;  ///< cells of the first row
  std::optional<std::size_t> type_at_, id_at_;
  std::vector<std::string_view> cells_;
  std::string_view id_;
  std::set<std::string> types_;
  bool found_type_ = false;
};

}  // namespace grit
