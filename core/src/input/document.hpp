// A description as JSON, merged from its files, with the origin of each value.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "grit/description.hpp"
#include "grit/error.hpp"

namespace grit {

/// A source of values.
struct Source {
  std::string name;                 ///< a file's path as given, "--set", or another name for messages
  std::filesystem::path directory;  ///< base of its relative paths; empty: the working directory
};

/// Position at which a value was written.
struct Origin {
  std::shared_ptr<const Source> source;
  int line = 0;         ///< from 1; 0 if the source has no lines
  std::string pointer;  ///< within its source
};

/// Keys "//" are comments: they are dropped everywhere.
class Document {
 public:
  /// An empty object.
  Document() = default;
  /// From JSON made by a program; all values have the same source and no line.
  Document(Description json, const std::string& source_name);

  /// Reads a file and the file it extends: the value of its key "extends" is the path of another description, relative
  /// to the file's folder, onto which this one is merged (RFC 7396: objects are merged, everything else is replaced,
  /// null removes). Throws FileError as read_text() does, DescriptionError with every syntax error, duplicate key,
  /// and extended file that does not exist or extends itself.
  static Document load(const std::filesystem::path& path);

  /// The same for a text instead of a file; `name` identifies it in messages. Relative paths start in the working
  /// directory.
  static Document parse(const std::string& text, const std::string& name);

  const Description& json() const { return json_; }
  /// Origin of the value at a pointer; if it does not exist, origin of its nearest parent, with the rest of the pointer
  /// appended.
  Origin origin(const std::string& pointer) const;
  /// Names of the sources of its values: files as given, "--set" and others.
  std::set<std::string> sources() const;
  /// A problem with the value at a pointer.
  Problem problem(const std::string& pointer, std::string message) const;

  /// Applies "/pointer=value": the value is read as JSON, otherwise as a text. Missing parents are created as objects;
  /// null removes. `by`: the source in messages. Throws DescriptionError.
  void set(const std::string& assignment, const std::string& by = "--set");
  /// Sets the value at a pointer as if it had been written at `origin`. Missing parents are created as objects. Returns
  /// the problem with the pointer; empty if there is none.
  std::string set(const std::string& pointer, Description value, const Origin& origin);
  /// Merges the value at `from` of a document onto the root of this one (RFC 7396). Objects whose keys are indices of a
  /// list are merged onto its entries. Throws DescriptionError for an index that does not exist.
  void merge(const Document& other, const std::string& from = "");
  /// Only the value at a pointer, with its origins; an empty object if it does not exist.
  Document excerpt(const std::string& pointer) const;
  /// Removes a value.
  void erase(const std::string& pointer);
  /// Merges this document onto `base`, and keeps the result. Keys that null removed here, by extending or set(), are
  /// removed from `base` too, even if they did not exist here.
  void extend(Document base);

 private:
  struct Parser;
  static Document load(const std::filesystem::path& path, std::vector<std::filesystem::path>& open);
  static Document read(const std::string& text, const Source& source, std::vector<std::filesystem::path>& open);
  void merge(Description& target, const std::string& at, const Description& patch, const Document& other,
             const std::string& from);
  void forget(const std::string& pointer);

  Description json_ = Description::object();
  std::set<std::string> removed_;          // pointers that null removed, whether or not they existed
  std::map<std::string, Origin> origins_;  // by pointer; values without an entry have the origin of their parent
};

/// A key as a part of a JSON pointer (RFC 6901).
std::string pointer_token(const std::string& key);
/// The JSON pointer of these keys from the root.
std::string pointer_of(const std::vector<std::string>& keys);

/// A JSON value in messages: `the text "abc"`, `the number 5`, "a list".
std::string describe_value(const Description& value);

}  // namespace grit
