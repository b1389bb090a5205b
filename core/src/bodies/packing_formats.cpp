#include "bodies/packing_formats.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include "format/number.hpp"
#include "grit/toolkit/text_file.hpp"

namespace grit {
namespace {

constexpr std::size_t longest_line = 60;  // in a message
constexpr const char* usual_line = "write one line per grain: x y z radius, in m";
const std::vector<Column> usual_columns{Column::x, Column::y, Column::z, Column::radius};

std::vector<std::string_view> words(std::string_view line, char separator = ' ') {
  std::vector<std::string_view> all;
  split(line, separator, all);
  return all;
}

/// A number of lines or a time step.
std::optional<std::int64_t> parse_integer(std::string_view word) {
  constexpr double most = 9e15;  // above it, double skips integers
  const WrittenNumber written = parse_number(word);
  if (!written.fault.empty() || written.value != std::floor(written.value) || std::abs(written.value) > most)
    return std::nullopt;
  return static_cast<std::int64_t>(written.value);
}

std::string joined(std::span<const std::string_view> names) {
  std::string text;
  for (const std::string_view name : names) text += (text.empty() ? "" : " ") + std::string(name);
  return visible_text(text, 2 * longest_line);
}

std::string snapshot_of(std::int64_t step) { return "the snapshot of time step " + std::to_string(step); }

bool begins_with_letter(std::string_view line) {
  const auto first = line.find_first_not_of(" \t");
  if (first == line.npos) return false;
  const char c = line[first];
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

/// Reads one text in one format.
class Packing {
 public:
  Packing(std::string_view text, const FileSource& source) : text_(text), source_(source), faults_(source.path) {}

  std::vector<PackedBody> plain();
  std::vector<PackedBody> with_header();
  std::vector<PackedBody> yade();
  std::vector<PackedBody> lammps_data();
  std::vector<PackedBody> lammps_dump();
  std::vector<PackedBody> xyz();

 private:
  /// Where the rows of a snapshot begin.
  struct Snapshot {
    std::int64_t step = 0, count = 0;
    std::vector<std::string_view> names;
    TextLines rows{""};  // at the line of names
  };

  std::vector<Column> columns_of(std::span<const std::string_view> names, int line);
  void check_columns(const std::vector<Column>& columns, const std::string& found, int line);
  void add(RowReader& reader, std::string_view line, int number);
  /// `count` rows after the present line.
  void add_rows(RowReader& reader, TextLines lines, std::int64_t count, const std::string& of);
  [[noreturn]] void raise_cut(int line, const std::string& of, std::int64_t rows, std::int64_t count);
  std::vector<Snapshot> snapshots();
  void add_velocity(std::string_view line, int number, std::size_t columns);
  std::vector<PackedBody> finish(RowReader* reader = nullptr, const std::string& advice = "");
  std::vector<Column> given_columns() const;

  std::string_view text_;
  const FileSource& source_;
  PackingFaults faults_;
  std::vector<PackedBody> bodies_;
  static constexpr std::size_t no_body = static_cast<std::size_t>(-1);
  /// A body with an id: its line, that of its velocity, and its index; no_body if it is of a type that is not read.
  struct Identified {
    int line = 0, velocity_line = 0;
    std::size_t body = no_body;
  };
  std::unordered_map<std::string_view, Identified> by_id_;
};

std::vector<Column> Packing::given_columns() const {
  std::vector<Column> columns;
  for (const std::string& name : source_.columns) columns.push_back(*column_of_description(name));
  return columns;
}

void Packing::check_columns(const std::vector<Column>& columns, const std::string& found, int line) {
  if (const std::string missing = lacking(columns); !missing.empty())
    faults_.raise(line, "the columns " + found + " lack " + missing);
}

std::vector<Column> Packing::columns_of(std::span<const std::string_view> names, int line) {
  std::vector<Column> columns = columns_of_header(names);
  check_columns(columns, joined(names), line);
  return columns;
}

void Packing::add(RowReader& reader, std::string_view line, int number) {
  const auto body = reader.read(line, number);
  if (const std::string_view id = reader.id(); !id.empty()) {
    const auto [at, is_new] = by_id_.try_emplace(id, Identified{number, 0, body ? bodies_.size() : no_body});
    if (!is_new)
      return faults_.add(number, "id is " + quoted_excerpt(id) + ", as in line " + std::to_string(at->second.line) +
                                     "; each body has an id of its own");
  }
  if (body) bodies_.push_back(*body);
}

std::vector<PackedBody> Packing::finish(RowReader* reader, const std::string& advice) {
  if (reader != nullptr) reader->check_types();
  if (bodies_.empty() && !faults_.any()) faults_.add(0, "contains no grains" + (advice.empty() ? "" : "; " + advice));
  faults_.raise();
  return std::move(bodies_);
}

/// Rows of numbers, perhaps below a line of names.
std::vector<PackedBody> Packing::plain() {
  std::optional<RowReader> reader;
  TextLines lines(text_);
  for (std::int64_t skipped = 0; skipped < source_.header_lines && lines.next(); ++skipped) continue;
  while (lines.next()) {
    const std::string_view line = without_comment(lines.line());
    if (is_blank(line)) continue;
    if (!reader) {
      const char separator = separator_of(line);
      std::vector<Column> columns = source_.columns.empty() ? usual_columns : given_columns();
      const auto cells = words(line, separator);
      const auto is_name = [](std::string_view cell) { return column_of_header(cell) != Column::skip; };
      if (source_.columns.empty() && std::ranges::count_if(cells, is_name) >= 3) {
        columns = columns_of(cells, lines.number());
        reader.emplace(source_, faults_, std::move(columns), separator);
        continue;
      }
      if (source_.columns.empty() && cells.size() > columns.size())
        faults_.raise(lines.number(), "found " + counted(cells.size(), "column", "columns") + " in " +
                                          quoted_excerpt(line, longest_line) +
                                          "; expected 4: x y z radius; name others in `columns`");
      reader.emplace(source_, faults_, std::move(columns), separator);
    }
    add(*reader, line, lines.number());
  }
  return finish(reader ? &*reader : nullptr, source_.columns.empty() ? usual_line : "");
}

/// Cells separated by commas below a line of names, as DEM-Engine writes its spheres.
std::vector<PackedBody> Packing::with_header() {
  std::optional<RowReader> reader;
  for (TextLines lines(text_); lines.next();) {
    if (is_blank(lines.line())) continue;
    if (reader) {
      add(*reader, lines.line(), lines.number());
      continue;
    }
    const char separator = separator_of(lines.line());
    reader.emplace(source_, faults_, columns_of(words(lines.line(), separator), lines.number()), separator);
  }
  return finish(reader ? &*reader : nullptr);
}

/// "x y z r" with the order of the columns in a line "#format x_y_z_r".
std::vector<PackedBody> Packing::yade() {
  static const std::map<std::string, std::pair<std::vector<Column>, bool>, std::less<>> forms{
      {"x_y_z_r", {usual_columns, false}},
      {"x_y_z_r_matId", {{Column::x, Column::y, Column::z, Column::radius, Column::type}, false}},
      {"id_x_y_z_r_matId", {{Column::id, Column::x, Column::y, Column::z, Column::radius, Column::type}, false}},
      {"x_y_z_r_attrs", {usual_columns, true}}};
  std::optional<RowReader> reader(std::in_place, source_, faults_, usual_columns);
  for (TextLines lines(text_); lines.next();) {
    const auto cells = words(lines.line());
    if (cells.empty()) continue;
    if (cells[0] == "#format") {
      const auto form = cells.size() > 1 ? forms.find(cells[1]) : forms.end();
      if (form == forms.end()) {
        std::string all;
        for (const auto& [name, _] : forms) all += (all.empty() ? "" : ", ") + name;
        faults_.raise(lines.number(), "the format of YADE is " + quoted_excerpt(cells.size() > 1 ? cells[1] : "") +
                                          "; allowed is one of " + all);
      }
      reader.emplace(source_, faults_, form->second.first, ' ', form->second.second);
    } else if (const std::string_view line = without_comment(lines.line()); !is_blank(line)) {
      add(*reader, line, lines.number());
    }
  }
  return finish(&*reader);
}

/// What read_data of LAMMPS and LIGGGHTS reads: a header, then sections with titles.
std::vector<PackedBody> Packing::lammps_data() {
  std::vector<Column> columns{Column::id, Column::type, Column::diameter, Column::skip,
                              Column::x,  Column::y,    Column::z};
  if (!source_.columns.empty()) columns = given_columns();
  RowReader reader(source_, faults_, columns, ' ', true);
  std::optional<std::int64_t> expected;
  std::string section;                  // empty: the header
  std::map<std::string, int> sections;  // lines of their titles
  std::vector<std::pair<int, std::string_view>> velocities;
  std::int64_t rows = 0;
  TextLines lines(text_);
  lines.next();  // a title
  while (lines.next()) {
    const std::string_view line = without_comment(lines.line());
    if (is_blank(line)) continue;
    const auto cells = words(line);
    if (begins_with_letter(line)) {
      section = joined(cells);
      if (const auto [first, is_new] = sections.try_emplace(section, lines.number()); !is_new)
        faults_.raise(lines.number(), "found a second section " + section + "; the first is in line " +
                                          std::to_string(first->second) + "; allowed is one");
      if (section != "Atoms" || !source_.columns.empty()) continue;
      const auto note = lines.line().find('#');
      const auto style =
          note == std::string_view::npos ? std::vector<std::string_view>{} : words(lines.line().substr(note + 1));
      if (!style.empty() && style[0] != "sphere" && style[0] != "granular")
        faults_.raise(lines.number(), "the atom style is " + quoted_excerpt(joined(style)) +
                                          "; allowed is sphere or granular; of others, name the columns in `columns`");
    } else if (section.empty()) {
      if (cells.size() == 2 && cells[1] == "atoms") expected = parse_integer(cells[0]);
    } else if (section == "Atoms") {
      ++rows;
      add(reader, line, lines.number());
    } else if (section == "Velocities") {
      velocities.emplace_back(lines.number(), line);
    }
  }
  const auto expect_rows = [&](const std::string& title, std::int64_t found) {
    if (found != *expected && !faults_.any())
      faults_.add(0, "has " + std::to_string(found) + " lines in the section " + title + "; the header gives " +
                         std::to_string(*expected) + "; the file ends in line " + std::to_string(lines.number()) +
                         (section.empty() ? ", in the header"
                                          : ", in the section of line " + std::to_string(sections.at(section))));
  };
  if (!expected) faults_.add(0, "the header has no line \"N atoms\", with which LAMMPS gives their number");
  else expect_rows("Atoms", rows);
  if (!faults_.any())
    for (const auto& [number, line] : velocities) add_velocity(line, number, words(velocities.front().second).size());
  if (expected && sections.contains("Velocities")) expect_rows("Velocities", std::ssize(velocities));
  return finish(&reader);
}

/// A row of the section Velocities, with as many columns as its first row: id vx vy vz, of spheres also wx wy wz.
void Packing::add_velocity(std::string_view line, int number, std::size_t columns) {
  const auto cells = words(line);
  if (cells.size() != 4 && cells.size() != 7)
    return faults_.add(number, "found " + counted(cells.size(), "column", "columns") +
                                   "; expected 7: id vx vy vz wx wy wz, or the first 4");
  if (cells.size() != columns)
    return faults_.add(number, "found " + counted(cells.size(), "column", "columns") + "; the first row has " +
                                   std::to_string(columns));
  const auto at = by_id_.find(cells[0]);
  if (at == by_id_.end())
    return faults_.add(number, "id is " + quoted_excerpt(cells[0]) + ", which the section Atoms does not have");
  auto& [_, velocity_line, body] = at->second;
  if (velocity_line != 0)
    return faults_.add(number, "id is " + quoted_excerpt(cells[0]) + ", as in line " + std::to_string(velocity_line) +
                                   "; each body has one velocity");
  velocity_line = number;
  double values[6] = {};
  for (std::size_t k = 1; k < cells.size(); ++k) {
    auto [value, fault] = parse_number(cells[k]);
    if (fault.empty() && !std::isfinite(value)) fault = "not finite";
    constexpr const char* names[] = {"vx", "vy", "vz", "wx", "wy", "wz"};
    if (!fault.empty())
      return faults_.add(number,
                         std::string(names[k - 1]) + " is " + quoted_excerpt(cells[k]) + ": " + std::string(fault));
    values[k - 1] = value;
  }
  if (body == no_body) return;
  bodies_[body].velocity = source_.scale * Vec3(values[0], values[1], values[2]);
  bodies_[body].spin = Vec3(values[3], values[4], values[5]);
}

std::vector<Packing::Snapshot> Packing::snapshots() {
  std::vector<Snapshot> all;
  std::optional<std::int64_t> step, count;
  int begin = 0;  // line of the first item of a snapshot
  TextLines lines(text_);
  const auto integer_below = [&](const char* what) {
    const auto value = lines.next() ? parse_integer(joined(words(lines.line()))) : std::nullopt;
    if (!value || *value < 0)
      faults_.raise(lines.number(), "found " + quoted_excerpt(lines.line(), longest_line) + "; expected " + what);
    return value;
  };
  while (lines.next()) {
    const std::string_view line = lines.line();
    if (is_blank(line)) continue;
    if (!line.starts_with("ITEM:"))
      faults_.raise(lines.number(), "found " + quoted_excerpt(line, longest_line) +
                                        "; expected ITEM: TIMESTEP, with which each snapshot of a LAMMPS dump begins");
    if (begin == 0) begin = lines.number();
    auto names = words(line.substr(5));
    const std::string item = joined(names);
    if (item == "TIMESTEP") {
      step = integer_below("a time step");
    } else if (item == "NUMBER OF ATOMS") {
      count = integer_below("a number of atoms");
    } else if (item.starts_with("ATOMS")) {
      if (!step || !count)
        faults_.raise(lines.number(), "ITEM: ATOMS comes before ITEM: TIMESTEP and ITEM: NUMBER OF ATOMS");
      names.erase(names.begin());
      all.push_back({*step, *count, std::move(names), lines});
      for (std::int64_t row = 0; row < *count && lines.next(); ++row)
        if (lines.line().starts_with("ITEM:")) raise_cut(lines.number(), snapshot_of(*step), row, *count);
      step.reset(), count.reset(), begin = 0;
    } else {
      const int below = item.starts_with("BOX BOUNDS") ? 3 : 1;  // of UNITS and TIME one line
      for (int k = 0; k < below; ++k) lines.next();
    }
  }
  if (begin != 0 && (source_.time_step < 0 || source_.time_step == step))
    faults_.raise(begin,
                  "the snapshot that begins here is cut off: it has no line ITEM: ATOMS; the file ends in line " +
                      std::to_string(lines.number()) + "; choose another snapshot by time_step");
  return all;
}

std::vector<PackedBody> Packing::lammps_dump() {
  const std::vector<Snapshot> all = snapshots();
  if (all.empty()) faults_.raise(0, "contains no snapshot: there is no line ITEM: ATOMS");
  const auto wanted =
      source_.time_step < 0 ? std::prev(all.end()) : std::ranges::find(all, source_.time_step, &Snapshot::step);
  if (wanted == all.end()) {
    std::string steps = std::to_string(all.front().step);
    if (all.size() > 1)
      steps += " … " + std::to_string(all.back().step) + ", " + std::to_string(all.size()) + " of them";
    faults_.raise(
        0, "has no snapshot of time step " + std::to_string(source_.time_step) + "; its time steps are " + steps);
  }
  const int line = wanted->rows.number();
  const auto is_scaled = [](std::string_view name) { return name == "xs" || name == "xsu"; };
  if (std::ranges::any_of(wanted->names, is_scaled) &&
      std::ranges::find(wanted->names, std::string_view("x")) == wanted->names.end())
    faults_.raise(line, "the columns " + joined(wanted->names) +
                            " have scaled coordinates; write x y z, as with dump custom id type x y z radius");
  RowReader reader(source_, faults_, columns_of(wanted->names, line));
  add_rows(reader, wanted->rows, wanted->count, snapshot_of(wanted->step));
  return finish(&reader);
}

void Packing::raise_cut(int line, const std::string& of, std::int64_t rows, std::int64_t count) {
  faults_.raise(line, of + " is cut off: it has " + std::to_string(rows) + " of " +
                          counted(static_cast<std::size_t>(count), "body", "bodies"));
}

void Packing::add_rows(RowReader& reader, TextLines lines, std::int64_t count, const std::string& of) {
  for (std::int64_t row = 0; row < count; ++row) {
    if (!lines.next() || lines.line().starts_with("ITEM:")) raise_cut(lines.number(), of, row, count);
    add(reader, lines.line(), lines.number());
  }
}

/// The columns of "Properties=species:S:1:pos:R:3:radius:R:1".
std::vector<Column> columns_of_properties(std::string_view comment) {
  static const std::map<std::string, std::vector<Column>, std::less<>> known{
      {"pos", {Column::x, Column::y, Column::z}},
      {"position", {Column::x, Column::y, Column::z}},
      {"velo", {Column::vx, Column::vy, Column::vz}},
      {"vel", {Column::vx, Column::vy, Column::vz}},
      {"velocity", {Column::vx, Column::vy, Column::vz}},
      {"ang_velo", {Column::wx, Column::wy, Column::wz}},
      {"omega", {Column::wx, Column::wy, Column::wz}},
      {"angular_velocity", {Column::wx, Column::wy, Column::wz}},
      {"radius", {Column::radius}},
      {"diameter", {Column::diameter}},
      {"species", {Column::type}},
      {"type", {Column::type}},
      {"particle type", {Column::type}},
      {"id", {Column::id}}};
  constexpr std::string_view key = "properties=";
  const auto at = lower_case(comment).find(key);
  if (at == std::string::npos) return {};
  std::string_view list = comment.substr(at + key.size());
  const bool quoted = list.starts_with('"');
  if (quoted) list.remove_prefix(1);
  list = list.substr(0, list.find_first_of(quoted ? "\"" : " \t"));
  const auto fields = words(list, ':');
  std::vector<Column> columns;
  for (std::size_t k = 0; k + 2 < fields.size(); k += 3) {
    const auto size = parse_integer(fields[k + 2]);
    if (!size || *size < 1 || *size > 1000) return {};
    const auto found = known.find(lower_case(fields[k]));
    const bool fits = found != known.end() && found->second.size() == static_cast<std::size_t>(*size);
    for (std::size_t n = 0; n < static_cast<std::size_t>(*size); ++n) {
      const Column column = fits ? found->second[n] : Column::skip;
      const bool again = std::ranges::find(columns, column) != columns.end();
      columns.push_back(again ? Column::skip : column);
    }
  }
  if (std::ranges::find(columns, Column::radius) != columns.end())
    std::ranges::replace(columns, Column::diameter, Column::skip);
  return columns;
}

/// The last frame.
std::vector<PackedBody> Packing::xyz() {
  std::optional<Snapshot> last;
  std::string_view comment;
  for (TextLines lines(text_); lines.next();) {
    if (is_blank(lines.line())) continue;
    const auto count = parse_integer(joined(words(lines.line())));
    if (!count || *count < 0)
      faults_.raise(lines.number(), "found " + quoted_excerpt(lines.line(), longest_line) +
                                        "; expected the number of bodies, with which each frame of an xyz file begins");
    lines.next();
    comment = lines.line();
    last = Snapshot{0, *count, {}, lines};
    for (std::int64_t row = 0; row < *count && lines.next(); ++row) continue;
  }
  if (!last) return finish();
  const std::vector<Column> columns = columns_of_properties(comment);
  if (columns.empty())
    faults_.raise(last->rows.number(), "found " + quoted_excerpt(comment, longest_line) +
                                           "; expected Properties=species:S:1:pos:R:3:radius:R:1 or the like, which "
                                           "names the columns");
  check_columns(columns, "in " + quoted_excerpt(comment, 2 * longest_line), last->rows.number());
  RowReader reader(source_, faults_, columns);
  add_rows(reader, last->rows, last->count, "the last frame");
  return finish(&reader);
}

}  // namespace

std::string recognised_format(std::string_view text, const std::filesystem::path& path) {
  using namespace std::string_view_literals;
  PackingFaults faults(path);
  constexpr const char* readable =
      "; allowed is text, or a file of LAMMPS, LIGGGHTS, YADE or DEM-Engine, or extended xyz";
  for (const auto& [magic, name] :
       {std::pair("\x1f\x8b"sv, "a gzip file, which is compressed; unpack it"),
        std::pair("\x28\xb5\x2f\xfd"sv, "a zstd file, which is compressed; unpack it"),
        std::pair("PK\x03\x04"sv, "a zip file, which is compressed; unpack it"), std::pair("\x89HDF"sv, "an HDF5 file"),
        std::pair("# vtk DataFile"sv, "a VTK file"), std::pair("<"sv, "an XML file"), std::pair("{"sv, "a JSON file")})
    if (text.starts_with(magic)) faults.raise(1, std::string("found ") + name + readable);

  constexpr int header = 100;  // lines
  TextLines lines(text);
  std::string_view first;  // that is not blank
  std::string_view first_row;
  while (lines.next() && lines.number() <= header) {
    const std::string_view line = lines.line();
    if (is_blank(line)) continue;
    if (first.empty()) {
      first = line;
      if (line.starts_with("ITEM:")) return "lammps-dump";
    } else if (lower_case(line).find("properties=") != std::string::npos && parse_integer(joined(words(first)))) {
      return "xyz";
    }
    const auto cells = words(line);
    if (cells[0] == "#format") return "yade";
    if (cells.size() >= 2 && cells[1] == "atoms" && parse_integer(cells[0])) return "lammps-data";
    if (first_row.empty() && !is_blank(without_comment(line))) first_row = line;
  }
  if (path.extension() == ".xyz" && parse_integer(joined(words(first)))) return "xyz";
  const auto columns = columns_of_header(words(first_row, ','));
  const auto is_centre = [](Column column) { return column <= Column::z; };
  if (first == first_row && std::ranges::count_if(columns, is_centre) == 3) return "dem-engine";
  return "text";
}

std::vector<PackedBody> bodies_of_text(std::string_view text, const std::string& format, const FileSource& source) {
  Packing packing(text, source);
  if (format == "lammps-data") return packing.lammps_data();
  if (format == "lammps-dump") return packing.lammps_dump();
  if (format == "yade") return packing.yade();
  if (format == "xyz") return packing.xyz();
  if (format == "dem-engine") return packing.with_header();
  return packing.plain();
}

}  // namespace grit
