#include "input/document.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <optional>

#include "format/number.hpp"
#include "grit/toolkit/text_file.hpp"

namespace grit {
namespace {

namespace fs = std::filesystem;

/// Passes characters on and counts line ends.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  struct Count {
    int line = 1;
    char last = 0;
  };
  CountingIterator(const char* at, Count* count) : at_(at), count_(count) {}

  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    count_->last = *at_++;
    count_->line += count_->last == '\n';
    return *this;
  }
  CountingIterator operator++(int) {
    auto before = *this;
    ++*this;
    return before;
  }
  friend bool operator==(const CountingIterator& a, const CountingIterator& b) { return a.at_ == b.at_; }
  friend bool operator!=(const CountingIterator& a, const CountingIterator& b) { return !(a == b); }

 private:
  const char* at_;
  Count* count_;
};

std::optional<std::vector<std::string>> split_pointer(const std::string& pointer) {
  if (!pointer.empty() && pointer.front() != '/') return std::nullopt;
  std::vector<std::string> tokens;
  for (std::size_t i = 0; i < pointer.size(); ++i) {
    if (pointer[i] == '/') {
      tokens.emplace_back();
    } else if (pointer[i] != '~') {
      tokens.back() += pointer[i];
    } else if (++i < pointer.size() && (pointer[i] == '0' || pointer[i] == '1')) {
      tokens.back() += pointer[i] == '0' ? '~' : '/';
    } else {
      return std::nullopt;
    }
  }
  return tokens;
}

std::optional<std::size_t> index_in(const Description& list, const std::string& token) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), index);
  if (error != std::errc() || end != token.data() + token.size() || index >= list.size()) return std::nullopt;
  if (token.size() > 1 && token.front() == '0') return std::nullopt;
  return index;
}

std::string no_entry(const std::string& token, const std::string& list, std::size_t size) {
  return "there is no entry \"" + token + "\" in " + list + ", which has " + counted(size, "entry", "entries") +
         ", counted from 0";
}

/// Whether all keys of a patch are indices of entries of the list.
bool is_of_entries(const Description& patch, const Description& list) {
  return patch.is_object() && !patch.empty() && list.is_array() &&
         std::ranges::all_of(patch.items(), [&](const auto& one) {
           return index_in(list, one.key()).has_value() && !one.value().is_null();
         });
}

/// The first key of a patch that is an index beyond the list.
std::optional<std::string> missing_entry(const Description& patch, const Description& list) {
  if (!patch.is_object() || !list.is_array()) return std::nullopt;
  for (const auto& [key, value] : patch.items())
    if (!key.empty() && key.find_first_not_of("0123456789") == std::string::npos && !index_in(list, key)) return key;
  return std::nullopt;
}

bool is_below(const std::string& pointer, const std::string& parent) {
  return pointer.size() > parent.size() && pointer[parent.size()] == '/' &&
         pointer.compare(0, parent.size(), parent) == 0;
}

}  // namespace

std::string pointer_token(const std::string& key) {
  std::string token;
  for (const char c : key) token += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return token;
}

std::string pointer_of(const std::vector<std::string>& keys) {
  std::string pointer;
  for (const std::string& key : keys) pointer += '/' + pointer_token(key);
  return pointer;
}

std::string describe_value(const Description& value) {
  switch (value.type()) {
    case Description::value_t::object:
      return "an object";
    case Description::value_t::array:
      return "a list";
    case Description::value_t::null:
      return "null";
    case Description::value_t::boolean:
      return value.get<bool>() ? "true" : "false";
    case Description::value_t::string:
      return "the text " + quoted_excerpt(value.get_ref<const std::string&>(), 60);
    default:
      return "the number " + value.dump();
  }
}

/// Builds a document from the events of nlohmann's parser.
struct Document::Parser : nlohmann::json_sax<Description> {
  Parser(Document& document, std::shared_ptr<const Source> source) : document_(document), source_(std::move(source)) {}

  /// Whether the text is JSON; problems are collected in `problems`.
  bool parse(const std::string& text) {
    const char *begin = text.data(), *end = begin + text.size();
    return Description::sax_parse(CountingIterator(begin, &count_), CountingIterator(end, &count_), this);
  }

  bool null() override { return value(nullptr, line()); }
  bool boolean(bool v) override { return value(v, line()); }
  bool number_integer(number_integer_t v) override { return value(v, line_of_number()); }
  bool number_unsigned(number_unsigned_t v) override { return value(v, line_of_number()); }
  bool number_float(number_float_t v, const string_t&) override { return value(v, line_of_number()); }
  bool string(string_t& v) override { return value(v, line()); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return start(Description::object()); }
  bool start_array(std::size_t) override { return start(Description::array()); }
  bool end_object() override { return end(); }
  bool end_array() override { return end(); }
  bool key(string_t& key) override {
    if (skipped_ > 0) return true;
    key_ = key;
    if (key == "//") return comment_ = true;
    if (open_.back().value->contains(key)) {
      const std::string at = open_.back().pointer + '/' + pointer_token(key);
      problems.push_back({source_->name, line(), visible_text(at),
                          "the key " + quoted_excerpt(key) + " appears twice, first in line " +
                              std::to_string(document_.origin(at).line) + "; keep one of them"});
    }
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& error) override {
    std::string text = error.what();
    for (const char* start : {"syntax error", "number overflow"})
      if (const auto at = text.find(start); at != std::string::npos) text.erase(0, at);
    problems.push_back({source_->name, line_of_number(), open_.empty() ? "" : visible_text(open_.back().pointer),
                        "not JSON: " + visible_text(text)});
    return false;
  }

  std::vector<Problem> problems;
  /// Whether the text was refused for its depth, so that it may be JSON.
  bool is_too_deep() const { return too_deep_; }

 private:
  // Pointers of all values are kept, and documents are copied by recursion.
  static constexpr std::size_t most_levels = 100, longest_pointer = 2000;
  struct Open {
    Description* value;
    std::string pointer;
  };

  int line() const { return count_.line; }
  /// The parser reads one character past the end of a number.
  int line_of_number() const { return count_.line - (count_.last == '\n'); }

  /// Stores a value and returns it; null for a comment.
  Description* put(Description v, int line, std::string& pointer) {
    if (comment_ || skipped_ > 0) return nullptr;
    Description* target = &document_.json_;
    if (!open_.empty()) {
      Open& parent = open_.back();
      const bool list = parent.value->is_array();
      pointer = parent.pointer + '/' + (list ? std::to_string(parent.value->size()) : pointer_token(key_));
      if (list) parent.value->push_back(nullptr);
      target = list ? &parent.value->back() : &(*parent.value)[key_];
    }
    *target = std::move(v);
    document_.forget(pointer);
    document_.origins_[pointer] = {source_, line, pointer};
    return target;
  }
  /// Refuses a text that is nested too deeply: returns false, which ends the parser.
  bool refuse_depth(const std::string& found, const std::string& allowed) {
    constexpr std::size_t shown = 80;
    const std::string at = open_.empty() ? "" : open_.back().pointer;
    problems.push_back({source_->name, line(), visible_text(at.substr(0, shown)) + (at.size() > shown ? "…" : ""),
                        fault_text(found, allowed)});
    too_deep_ = true;
    return false;
  }
  bool value(Description v, int line) {
    if (is_too_long()) return refuse_pointer();
    std::string pointer;
    put(std::move(v), line, pointer);
    comment_ = false;
    return true;
  }
  /// Whether the pointer of the next value is too long.
  bool is_too_long() const {
    if (open_.empty()) return false;
    const auto& [parent, pointer] = open_.back();
    return pointer.size() + (parent->is_array() ? 0 : key_.size()) > longest_pointer;
  }
  bool refuse_pointer() {
    return refuse_depth("keys of more than " + std::to_string(longest_pointer) + " characters in all",
                        "shorter keys, or fewer levels");
  }
  bool start(Description v) {
    if (open_.size() + static_cast<std::size_t>(skipped_) >= most_levels)
      return refuse_depth("lists and objects inside each other at more than " + std::to_string(most_levels) + " levels",
                          "up to " + std::to_string(most_levels) + " levels");
    if (is_too_long()) return refuse_pointer();
    std::string pointer;
    if (Description* target = put(std::move(v), line(), pointer)) open_.push_back({target, pointer});
    else ++skipped_;
    comment_ = false;
    return true;
  }
  bool end() {
    if (skipped_ > 0) --skipped_;
    else open_.pop_back();
    return true;
  }

  Document& document_;
  std::shared_ptr<const Source> source_;
  CountingIterator::Count count_;
  std::vector<Open> open_;
  std::string key_;
  bool comment_ = false;  // the next value belongs to a key "//"
  int skipped_ = 0;       // depth within a comment
  bool too_deep_ = false;
};

Document::Document(Description json, const std::string& source_name) : json_(std::move(json)) {
  origins_[""] = {std::make_shared<const Source>(Source{source_name, {}}), 0, ""};
}

namespace {

/// The same for all names of a file; a pipe has only this one.
fs::path whole_path(const fs::path& path) {
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(path, error);
  return error ? path : whole;
}

}  // namespace

Document Document::load(const fs::path& path) {
  std::vector<fs::path> open;
  return load(path, open);
}

Document Document::load(const fs::path& path, std::vector<fs::path>& open) {
  const std::string text = read_text(path);
  open.push_back(whole_path(path));
  Document document = read(text, {path.string(), path.parent_path()}, open);
  open.pop_back();
  return document;
}

Document Document::parse(const std::string& text, const std::string& name) {
  std::vector<fs::path> open;
  return read(plain_text(text, name), {name, {}}, open);
}

Document Document::read(const std::string& text, const Source& source, std::vector<fs::path>& open) {
  Document document;
  Parser parser(document, std::make_shared<const Source>(source));
  parser.parse(text);
  if (!parser.problems.empty()) throw DescriptionError(std::move(parser.problems));
  if (!document.json_.is_object())
    throw DescriptionError(
        {document.problem("", "found " + describe_value(document.json_) + "; a description is an object")});

  const auto extends = document.json_.find("extends");
  if (extends == document.json_.end()) return document;
  const auto refuse = [&](const std::string& message) {
    throw DescriptionError({document.problem("/extends", message)});
  };
  if (!extends->is_string())
    refuse("found " + describe_value(*extends) + "; allowed is the path of a description, from the folder of this one");
  const fs::path base_path = (source.directory / extends->get<std::string>()).lexically_normal();
  if (std::ranges::find(open, whole_path(base_path)) != open.end())
    refuse(base_path.string() + " extends itself, directly or through other files; break the cycle");
  std::error_code none;
  if (!fs::is_regular_file(base_path, none)) refuse("there is no file " + base_path.string() + " to extend");
  Document base = load(base_path, open);
  document.erase("/extends");
  base.merge(document);
  return base;
}

Origin Document::origin(const std::string& pointer) const {
  for (std::string at = pointer;; at.erase(at.rfind('/'))) {
    if (const auto found = origins_.find(at); found != origins_.end()) {
      Origin origin = found->second;
      origin.pointer += pointer.substr(at.size());
      return origin;
    }
    if (at.empty()) return {std::make_shared<const Source>(), 0, pointer};
  }
}

std::set<std::string> Document::sources() const {
  std::set<std::string> names;
  for (const auto& [pointer, origin] : origins_)
    if (origin.source) names.insert(origin.source->name);
  return names;
}

Problem Document::problem(const std::string& pointer, std::string message) const {
  const Origin written = origin(pointer);
  return {written.source->name, written.line, visible_text(written.pointer), visible_text(message)};
}

void Document::set(const std::string& assignment, const std::string& by) {
  const auto source = std::make_shared<const Source>(Source{by, {}});
  const auto equals = assignment.find('=');
  const std::string pointer = assignment.substr(0, equals);
  const auto refuse = [&](const std::string& message) { throw DescriptionError({{by, 0, pointer, message}}); };
  if (equals == std::string::npos || pointer.empty())
    refuse("found \"" + assignment + "\"; allowed is /pointer=value, e.g. /stages/0/limit=0.1");
  const std::string text = assignment.substr(equals + 1);

  Document value;
  Parser parser(value, source);
  const bool is_json = parser.parse(text);
  if (!is_json && !parser.is_too_deep()) value.json_ = text;
  else if (!parser.problems.empty()) throw DescriptionError(std::move(parser.problems));
  if (value.json_.is_null()) {
    removed_.insert(pointer);
    return erase(pointer);
  }
  if (const auto problem = set(pointer, std::move(value.json_), {source, 0, pointer}); !problem.empty())
    refuse(problem);
}

std::string Document::set(const std::string& pointer, Description value, const Origin& origin) {
  const auto tokens = split_pointer(pointer);
  if (!tokens) return "found \"" + pointer + "\"; allowed is a JSON pointer, e.g. /stages/0/limit";
  std::string at;
  Description* place = &json_;
  for (const auto& token : *tokens) {
    const std::string parent = at;
    at += '/' + pointer_token(token);
    const bool last = at.size() == pointer.size();
    if (place->is_array()) {
      if (last && token == "-") {
        at = parent + '/' + std::to_string(place->size());
        place->push_back(nullptr);
        place = &place->back();
        continue;
      }
      const auto index = index_in(*place, token);
      if (!index) return no_entry(token, parent, place->size());
      place = &(*place)[*index];
    } else if (place->is_object()) {
      const bool is_new = !place->contains(token);
      place = &(*place)[token];
      if (is_new && !last) {
        *place = Description::object();
        origins_[at] = {origin.source, origin.line, origin.pointer == pointer ? at : origin.pointer};
      }
    } else {
      return "there is nothing below " + parent + ", which is " + describe_value(*place);
    }
  }
  *place = std::move(value);
  forget(at);
  origins_[at] = origin;
  return {};
}

void Document::merge(const Document& other, const std::string& from) {
  merge(json_, "", other.json_.at(Description::json_pointer(from)), other, from);
}

void Document::merge(Description& target, const std::string& at, const Description& patch, const Document& other,
                     const std::string& from) {
  if (is_of_entries(patch, target)) {
    for (const auto& [key, value] : patch.items())
      merge(target[*index_in(target, key)], at + '/' + key, value, other, from + '/' + key);
    return;
  }
  if (const auto key = missing_entry(patch, target))
    throw DescriptionError({other.problem(from + '/' + *key, no_entry(*key, at, target.size()))});
  // An object that is merged into keeps its origin, for values without an origin of their own.
  if (!patch.is_object() || !target.is_object()) {
    forget(at);
    origins_[at] = other.origin(from);
  }
  if (!patch.is_object()) {
    for (auto entry = other.origins_.lower_bound(from + '/');
         entry != other.origins_.end() && is_below(entry->first, from); ++entry)
      origins_[at + entry->first.substr(from.size())] = entry->second;
    target = patch;
    return;
  }
  if (!target.is_object()) target = Description::object();
  for (const auto& [key, value] : patch.items()) {
    const std::string token = '/' + pointer_token(key);
    if (value.is_null()) {
      target.erase(key);
      forget(at + token);
      removed_.insert(at + token);
    } else {
      if (target.contains(key) && target[key].is_null()) removed_.insert(at + token);  // it was meant to remove a key
      merge(target[key], at + token, value, other, from + token);
    }
  }
}

void Document::extend(Document base) {
  // A removed key may have been written again later; merging then restores it.
  for (const std::string& pointer : removed_) base.erase(pointer);
  base.merge(*this);
  *this = std::move(base);
}

Document Document::excerpt(const std::string& pointer) const {
  Document part;
  for (std::string at = pointer;; at.erase(at.rfind('/'))) {
    if (const auto found = origins_.find(at); found != origins_.end()) part.origins_.insert(*found);
    if (at.empty()) break;
  }
  const Description::json_pointer place(pointer);
  const auto tokens = split_pointer(pointer);
  if (!tokens || !json_.contains(place)) return part;
  for (auto entry = origins_.lower_bound(pointer + '/'); entry != origins_.end() && is_below(entry->first, pointer);
       ++entry)
    part.origins_.insert(*entry);
  Description* value = &part.json_;
  for (const std::string& token : *tokens) {
    if (value->is_null()) *value = Description::object();
    value = &(*value)[token];
  }
  *value = json_.at(place);
  return part;
}

void Document::erase(const std::string& pointer) {
  const auto tokens = split_pointer(pointer);
  if (!tokens || tokens->empty()) return;
  Description* parent = &json_;
  for (std::size_t i = 0; i + 1 < tokens->size(); ++i) {
    const auto& token = (*tokens)[i];
    if (parent->is_array()) {
      const auto index = index_in(*parent, token);
      if (!index) return;
      parent = &(*parent)[*index];
    } else {
      if (!parent->is_object() || !parent->contains(token)) return;
      parent = &(*parent)[token];
    }
  }
  if (!parent->is_object()) return;
  parent->erase(tokens->back());
  forget(pointer);
}

void Document::forget(const std::string& pointer) {
  origins_.erase(pointer);
  const auto first = origins_.lower_bound(pointer + '/');
  auto last = first;
  while (last != origins_.end() && is_below(last->first, pointer)) ++last;
  origins_.erase(first, last);
}

}  // namespace grit
