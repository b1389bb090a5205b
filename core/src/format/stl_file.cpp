#include "grit/toolkit/stl_file.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "format/resources.hpp"
#include "grit/toolkit/text_file.hpp"

namespace grit {
namespace {

constexpr std::size_t longest_word = 20;                                // of another format, in a message
constexpr std::size_t header = 80, preamble = header + 4, record = 50;  // bytes of a binary file
constexpr const char* facet_syntax =
    "facets as \"facet normal x y z, outer loop, vertex x y z (three times), endloop, endfacet\", then \"endsolid\"; "
    "export the file again";

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }
bool is_blank(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }
bool same_word(std::string_view a, std::string_view b) { return std::ranges::equal(a, b, {}, lower, lower); }

/// Words of a text with their line numbers.
class Words {
 public:
  explicit Words(std::string_view text) : rest_(text) {}
  int line() const { return line_; }
  /// Empty at the end.
  std::string_view next() {
    const auto start = std::ranges::find_if_not(rest_, is_blank);
    line_ += static_cast<int>(std::count(rest_.begin(), start, '\n'));
    rest_ = {start, rest_.end()};
    const auto end = std::ranges::find_if(rest_, is_blank);
    const std::string_view word(rest_.begin(), end);
    rest_ = {end, rest_.end()};
    return word;
  }
  void skip_line() { rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size())); }

 private:
  std::string_view rest_;
  int line_ = 1;
};

/// Reads an ASCII file; throws the Defect that ends it.
class Text {
 public:
  Text(std::string_view text, std::vector<Stl::Facet>& facets) : words_(text), facets_(facets) {}

  void read() {
    for (std::string_view word = words_.next(); !word.empty(); word = words_.next()) {
      if (!same_word(word, "solid")) throw misplaced(word, "solid or the end of the file");
      words_.skip_line();
      while (!same_word(word = words_.next(), "endsolid")) {
        if (!same_word(word, "facet")) throw misplaced(word, "facet");
        facets_.push_back(facet());
      }
      words_.skip_line();
    }
  }

 private:
  Stl::Facet facet() {
    Stl::Facet facet;
    expect("normal"), facet.normal = vector();
    expect("outer"), expect("loop");
    for (Vec3& corner : facet.corners) expect("vertex"), corner = vector();
    expect("endloop"), expect("endfacet");
    return facet;
  }
  Vec3 vector() { return Vec3{number(), number(), number()}; }  // braces: in this order
  double number() {
    const std::string_view word = words_.next();
    if (word.empty()) throw misplaced(word, "a number");
    const auto [value, fault] = parse_number(word);
    if (!fault.empty()) throw Defect{quoted_excerpt(word) + place() + ": " + std::string(fault), facet_syntax};
    return value;
  }
  void expect(std::string_view wanted) {
    const std::string_view word = words_.next();
    if (!same_word(word, wanted)) throw misplaced(word, wanted);
  }
  Defect misplaced(std::string_view found, std::string_view wanted) const {
    return {(found.empty() ? "the end of the file" : quoted_excerpt(found)) + place() + ", where " +
                std::string(wanted) + " should be",
            facet_syntax};
  }

  std::string place() const {
    return " in line " + std::to_string(words_.line()) + ", after " + std::to_string(facets_.size()) +
           " complete facets";
  }

  Words words_;
  std::vector<Stl::Facet>& facets_;
};

std::uint32_t count_of(std::string_view bytes) {
  std::uint32_t count;
  std::memcpy(&count, bytes.data() + header, sizeof count);
  return count;
}

std::size_t size_with(std::uint32_t facets) { return preamble + record * std::size_t{facets}; }

bool is_binary(std::string_view bytes) {
  return bytes.size() >= preamble && bytes.size() == size_with(count_of(bytes));
}

bool begins_printable(std::string_view text) {
  return std::ranges::all_of(text.substr(0, preamble),
                             [](unsigned char c) { return c >= ' ' || is_blank(static_cast<char>(c)); });
}

/// Whether a file that is not a complete binary one is an ASCII file, going by its beginning.
bool is_ascii(std::string_view beginning) {
  constexpr std::string_view keyword = "vertex";
  if (!same_word(Words(beginning).next(), "solid")) return false;
  // A binary header may begin with "solid" too, but control characters follow. In text they may follow a name.
  return begins_printable(beginning) || !std::ranges::search(beginning, keyword, {}, lower, lower).empty();
}

Vec3 read_floats(const char* bytes) {
  std::array<float, 3> values;
  std::memcpy(values.data(), bytes, sizeof values);
  return {values[0], values[1], values[2]};
}

void read_binary(std::string_view bytes, std::vector<Stl::Facet>& facets) {
  constexpr std::size_t vector = 12;
  for (std::uint32_t i = 0; i < count_of(bytes); ++i) {
    const char* at = bytes.data() + size_with(i);
    facets.push_back(
        {{read_floats(at + vector), read_floats(at + 2 * vector), read_floats(at + 3 * vector)}, read_floats(at)});
  }
}

/// Why a file is neither ASCII nor binary.
Defect other_format(std::string_view bytes, std::string_view beginning) {
  if (bytes.size() < preamble)
    return {std::to_string(bytes.size()) + " bytes, neither \"solid\" at their beginning nor a binary header",
            "STL, ASCII or binary"};
  if (begins_printable(beginning))
    return {
        "a text that begins with " + quoted_excerpt(Words(beginning).next(), longest_word) + " instead of \"solid\"",
        "STL, ASCII or binary; convert other formats"};
  const std::uint32_t count = count_of(bytes);
  return {"a binary file of " + std::to_string(bytes.size()) + " bytes whose header gives " + std::to_string(count) +
              " facets, that is " + std::to_string(size_with(count)) + " bytes",
          "a complete STL file, ASCII or binary; export or copy the file again"};
}

/// Refuses more facets than indices or the memory can hold. A wall keeps edges and neighbours of a facet, too.
void check_number(double facets) {
  constexpr double bytes_per_facet = 550, most = 5e8;
  const double available = available_memory();
  const std::string found = std::to_string(static_cast<std::uint64_t>(facets)) + " facets";
  if (facets > most) throw Defect{found, "up to 500 million; simplify the mesh"};
  if (bytes_per_facet * facets > available)
    throw Defect{found + ", which need about " + bytes_text(bytes_per_facet * facets) + " of memory",
                 "as many as fit into the " + bytes_text(available) + " that are available; simplify the mesh"};
}

void read(const std::filesystem::path& path, std::vector<Stl::Facet>& facets) {
  std::string fault;
  std::string bytes = read_bytes(path, fault);
  if (!fault.empty()) throw Defect{path.string() + ", which cannot be read: " + fault, "the path of an STL file"};
  if (bytes.empty()) throw Defect{"an empty file", "STL, ASCII or binary"};
  if (is_binary(bytes)) return check_number(count_of(bytes)), read_binary(bytes, facets);
  if (is_utf16(bytes)) throw Defect{"UTF-16 text", "STL, ASCII or binary; save the file as UTF-8"};
  const std::string beginning = plain_text(bytes.substr(0, 1024), path.string());
  if (!is_ascii(beginning)) throw other_format(bytes, beginning);
  constexpr double characters_per_facet = 250;
  check_number(std::floor(static_cast<double>(bytes.size()) / characters_per_facet));
  const std::string text = plain_text(std::move(bytes), path.string());
  Text(text, facets).read();
}

}  // namespace

std::string facet_numbers(const std::vector<std::size_t>& facets) {
  constexpr std::size_t most = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, facets.size()); ++i)
    text += (text.empty() ? "" : ", ") + std::to_string(facets[i] + 1);
  return facets.size() > most ? text + " and " + std::to_string(facets.size() - most) + " more" : text;
}

Stl read_stl(const std::filesystem::path& path) {
  Stl stl;
  try {
    read(path, stl.facets);
    if (stl.facets.empty()) throw Defect{"a file without facets", "at least one facet"};
  } catch (const Defect& defect) {
    stl.defects.push_back(defect);
    return stl;
  }
  std::vector<std::size_t> not_finite;
  for (std::size_t i = 0; i < stl.facets.size(); ++i)
    if (!std::ranges::all_of(stl.facets[i].corners, [](const Vec3& corner) { return corner.allFinite(); }))
      not_finite.push_back(i);
  if (!not_finite.empty())
    stl.defects.push_back({"corners that are not finite, of facet " + facet_numbers(not_finite),
                           "finite numbers; export the file again"});
  return stl;
}

}  // namespace grit
