#include "stl.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string_view>

namespace grit {
namespace {

constexpr std::size_t longest_word = 20;                                // in a message
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
      if (!same_word(word, "solid")) throw misplaced(word, "solid");
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
    std::string_view word = words_.next();
    const std::string_view found = word;
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) throw misplaced(found, "a number");
    return value;
  }
  void expect(std::string_view wanted) {
    const std::string_view word = words_.next();
    if (!same_word(word, wanted)) throw misplaced(word, wanted);
  }
  Defect misplaced(std::string_view found, std::string_view wanted) const {
    const std::string what = found.empty() ? "the end of the file" : '"' + std::string(found.substr(0, 40)) + '"';
    return {what + " in line " + std::to_string(words_.line()) + ", after " + std::to_string(facets_.size()) +
                " complete facets, where " + std::string(wanted) + " should be",
            facet_syntax};
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

/// Whether bytes are an ASCII file. A binary header may also begin with "solid"; file size then decides.
bool is_text(std::string_view bytes) {
  if (bytes.size() >= preamble && bytes.size() == size_with(count_of(bytes))) return false;
  Words words(bytes);
  return same_word(words.next(), "solid") && bytes.substr(0, 1024).find('\0') == bytes.npos;
}

Vec3 read_floats(const char* bytes) {
  std::array<float, 3> values;
  std::memcpy(values.data(), bytes, sizeof values);
  return {values[0], values[1], values[2]};
}

void read_binary(std::string_view bytes, std::vector<Stl::Facet>& facets) {
  constexpr std::size_t vector = 12;
  if (bytes.size() < preamble)
    throw Defect{std::to_string(bytes.size()) + " bytes, neither \"solid\" at their beginning nor a binary header",
                 "STL, ASCII or binary"};
  const std::uint32_t count = count_of(bytes);
  const auto is_print = [](unsigned char c) { return c >= ' ' || (c >= '\t' && c <= '\r'); };
  if (bytes.size() != size_with(count) && std::ranges::all_of(bytes.substr(0, preamble), is_print))
    throw Defect{"a text that begins with \"" + std::string(Words(bytes).next().substr(0, longest_word)) +
                     "\" instead of \"solid\"",
                 "STL, ASCII or binary; convert other formats"};
  if (bytes.size() != size_with(count))
    throw Defect{"a binary file of " + std::to_string(bytes.size()) + " bytes whose header gives " +
                     std::to_string(count) + " facets, that is " + std::to_string(size_with(count)) + " bytes",
                 "a complete STL file, ASCII or binary; export or copy the file again"};
  for (std::uint32_t i = 0; i < count; ++i) {
    const char* at = bytes.data() + size_with(i);
    facets.push_back(
        {{read_floats(at + vector), read_floats(at + 2 * vector), read_floats(at + 3 * vector)}, read_floats(at)});
  }
}

std::string whole_file(const std::filesystem::path& path) {
  const auto unreadable = [&](int reason) {
    return Defect{path.string() + ", which cannot be read: " + std::strerror(reason), "the path of an STL file"};
  };
  if (std::filesystem::is_directory(path)) throw unreadable(EISDIR);
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw unreadable(errno);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return std::move(bytes).str();
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
    const std::string bytes = whole_file(path);
    if (bytes.empty()) throw Defect{"an empty file", "STL, ASCII or binary"};
    if (is_text(bytes)) Text(bytes, stl.facets).read();
    else read_binary(bytes, stl.facets);
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
