// The part of HDF5 that the results need. Only hdf5.cpp includes the library's header.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace grit::hdf5 {

/// Lengths of the dimensions, slowest first; empty for a scalar.
using Shape = std::vector<std::size_t>;

/// An owned identifier of the library.
class Handle {
 public:
  using Close = int (*)(std::int64_t);
  Handle() = default;
  Handle(std::int64_t id, Close close) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  std::int64_t id() const { return id_; }
  std::int64_t release() { return std::exchange(id_, -1); }

 private:
  std::int64_t id_ = -1;
  Close close_ = nullptr;
};

enum class Number { float64, float32, int64, int32, uint64, uint32, uint8 };

template <class T>
constexpr Number number_of() {
  if constexpr (std::same_as<T, double>) return Number::float64;
  else if constexpr (std::same_as<T, float>) return Number::float32;
  else if constexpr (std::same_as<T, std::int64_t>) return Number::int64;
  else if constexpr (std::same_as<T, std::int32_t>) return Number::int32;
  else if constexpr (std::same_as<T, std::uint64_t>) return Number::uint64;
  else if constexpr (std::same_as<T, std::uint32_t>) return Number::uint32;
  else {
    static_assert(std::same_as<T, std::uint8_t>);
    return Number::uint8;
  }
}

inline std::size_t product(std::span<const std::size_t> shape) {
  return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies());
}

// T below is one of the types of Number; reading converts. Everything throws FileError with the file, the object and
// the library's innermost message. What is read may come from a stranger: objects that grit does not write, such as
// links to other files, texts of variable length and shapes that the file is too short for, are refused before they are
// used.

/// An object with attributes.
class Object {
 public:
  void set_attribute(const std::string& name, std::string_view text);
  template <class T>
  void set_attribute(const std::string& name, const T& number) requires std::is_arithmetic_v<T> {
    set_number(name, number_of<T>(), &number);
  }
  bool has_attribute(const std::string& name) const;
  /// UTF-8.
  std::string text(const std::string& name) const;
  /// Space-separated words of a text; none if there is no such attribute.
  std::vector<std::string> words(const std::string& name) const;
  template <class T>
  T number(const std::string& name) const {
    T value{};
    get_number(name, number_of<T>(), &value);
    return value;
  }

  /// The file and the object's path in it, for messages.
  const std::string& where() const { return where_; }

 protected:
  Object(Handle handle, std::string where) : handle_(std::move(handle)), where_(std::move(where)) {}
  Handle handle_;
  std::string where_;

 private:
  void set_number(const std::string& name, Number type, const void* value);
  void get_number(const std::string& name, Number type, void* value) const;
};

class Dataset : public Object {
 public:
  Shape shape() const;
  /// The first dimension; 1 for a scalar.
  std::size_t rows() const;
  /// All numbers, or those of rows [first, first + count).
  template <class T>
  std::vector<T> read() const {
    std::vector<T> values(product(readable_shape()));
    if (!values.empty()) get(number_of<T>(), values.data());
    return values;
  }
  template <class T>
  std::vector<T> read(std::size_t first, std::size_t count) const {
    std::vector<T> values(product(readable_rows(first, count)));
    if (!values.empty()) get(number_of<T>(), first, count, values.data());
    return values;
  }
  /// Appends whole rows to a growing dataset.
  template <class T>
  void append(std::span<const T> values) {
    append(number_of<T>(), values.size(), values.data());
  }
  std::vector<std::byte> read_bytes() const;
  /// Removes the rows from `rows` on.
  void truncate(std::size_t rows);

 private:
  friend class Group;
  using Object::Object;
  /// The shape, if it is of numbers that the file is long enough for.
  Shape readable_shape() const;
  /// The same of some rows.
  Shape readable_rows(std::size_t first, std::size_t count) const;
  void get(Number type, void* values) const;
  void get(Number type, std::size_t first, std::size_t count, void* values) const;
  void append(Number type, std::size_t size, const void* values);
};

class Group : public Object {
 public:
  Group create_group(const std::string& name);
  Group group(const std::string& name) const;
  Dataset dataset(const std::string& name) const;
  bool has(const std::string& name) const;
  std::vector<std::string> names() const;  ///< of groups and datasets, sorted

  /// A dataset of fixed size, written at once, with checksums: reading fails if its numbers are damaged.
  template <class T>
  Dataset write(const std::string& name, const Shape& shape, std::span<const T> values) {
    return write(name, shape, number_of<T>(), values.size(), values.data());
  }
  Dataset write(const std::string& name, std::span<const std::byte> bytes) {
    return write(name, {bytes.size()}, Number::uint8, bytes.size(), bytes.data());
  }
  /// A dataset whose first dimension grows; `row` is the shape of one row. With checksums, append whole chunks, except
  /// the last.
  template <class T>
  Dataset create_growing(const std::string& name, const Shape& row, std::size_t rows_per_chunk,
                         bool checksums = false) {
    return create_growing(name, row, rows_per_chunk, number_of<T>(), checksums);
  }

 protected:
  using Object::Object;

 private:
  Dataset write(const std::string& name, const Shape& shape, Number type, std::size_t size, const void* values);
  Dataset create_growing(const std::string& name, const Shape& row, std::size_t rows_per_chunk, Number type,
                         bool checksums);
};

enum class Mode {
  read,
  read_whole,  ///< the same, but refuses files that were not written with `write_whole`
  copy,        ///< reads the whole file into memory when it is opened
  change,      ///< of `replace`; removes the seal, see storage/seal.hpp
  replace,
  /// Writes a file that is read only when it is complete: under another name until then, see publish(). All of its
  /// metadata has checksums, so that the library never follows damaged metadata.
  write_whole
};

/// An open file. It is not locked, so that it can be read while it is being written. Files that are read while they
/// grow (`replace`) use the oldest format. It has neither checksums of metadata, which a writer that is killed within a
/// write would leave wrong, nor an "open for writing" mark, which it would leave behind. Data may be on disk only after
/// flush() or close(); metadata is written only then. Groups and datasets are closed with the file.
class File : public Group {
 public:
  File(const std::filesystem::path& path, Mode mode);
  void flush();
  /// Flushes and closes; the destructor does so too, but cannot report errors.
  void close();
};

}  // namespace grit::hdf5
