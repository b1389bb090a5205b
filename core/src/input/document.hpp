// A description as JSON, merged from its files, with the place that wrote each value.
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

/// What values come from.
struct Source {
  std::string name;                 ///< a file's path as it was given, "--set", or whatever names it in messages
  std::filesystem::path directory;  ///< where relative paths in it start; empty for the working directory
};

/// Where a value was written.
struct Origin {
  std::shared_ptr<const Source> source;
  int line = 0;         ///< from 1; 0 if there are none
  std::string pointer;  ///< within its source
};

/// Keys "//" are comments: they are dropped wherever they stand.
class Document {
 public:
  /// An empty object.
  Document() = default;
  /// Takes JSON that was made by a program; every value has the same source and no line.
  Document(Description json, const std::string& source_name);

  /// Reads a file and what it extends: the value of its key "extends" is the path of another description, from the
  /// file's own folder, onto which this one is merged (RFC 7396: objects are merged, everything else replaced, null
  /// removes). Throws FileError if `path` cannot be read, DescriptionError with every problem of syntax, key that
  /// stands twice, and extended file that is not there or extends itself.
  static Document load(const std::filesystem::path& path);

  /// The same for a text in place of a file; `name` stands for the file in messages. Relative paths start in the
  /// working directory.
  static Document parse(const std::string& text, const std::string& name);

  const Description& json() const { return json_; }
  /// Where the value at a pointer was written; for one that is not there, where its nearest parent was, with the rest
  /// of the pointer added.
  Origin origin(const std::string& pointer) const;
  /// A problem with the value at a pointer.
  Problem problem(const std::string& pointer, std::string message) const;

  /// Applies "/pointer=value": the value is read as JSON, or else taken as a text. Parents that are missing are created
  /// as objects; null removes. Throws DescriptionError.
  void set(const std::string& assignment);
  /// Puts a value at a pointer as if it had been written at `origin`. Parents that are missing are created as objects.
  /// Returns what is wrong with the pointer; empty if nothing is.
  std::string set(const std::string& pointer, Description value, const Origin& origin);
  /// Merges the value at `from` of a document onto the value at the root of this one (RFC 7396), and objects whose keys
  /// are numbers of entries of a list onto these entries. Throws DescriptionError for a number that is of none.
  void merge(const Document& other, const std::string& from = "");
  /// The value at a pointer alone, with where it was written; an empty object if it is not there.
  Document excerpt(const std::string& pointer) const;
  /// Removes a value.
  void erase(const std::string& pointer);
  /// Puts this document in place of `base` merged with it: what null removed here, by extending or set(), is removed
  /// from `base` too, even where nothing was here to remove.
  void extend(Document base);

 private:
  struct Parser;
  static Document load(const std::filesystem::path& path, std::vector<std::filesystem::path>& open);
  static Document read(const std::string& text, const Source& source, std::vector<std::filesystem::path>& open);
  void merge(Description& target, const std::string& at, const Description& patch, const Document& other,
             const std::string& from);
  void forget(const std::string& pointer);

  Description json_ = Description::object();
  std::set<std::string> removed_;          // pointers that null removed, whether or not there was anything
  std::map<std::string, Origin> origins_;  // by pointer; values without an entry were written with their parent
};

/// A key as a part of a JSON pointer (RFC 6901).
std::string pointer_token(const std::string& key);

/// What a JSON value is, for messages: `the text "abc"`, `the number 5`, "a list".
std::string describe_value(const Description& value);

}  // namespace grit
