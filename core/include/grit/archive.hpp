// Saves the state that a component keeps between steps to a checkpoint, and restores it. Members are named once for
// both.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "grit/error.hpp"
#include "grit/vec.hpp"

namespace grit {

/// Whether a type can be saved byte by byte. For a struct of numbers, without pointers, strings, containers or gaps
/// between members, specialise it: `template <> inline constexpr bool grit::plain_numbers<Mine> = true;`
template <class T>
inline constexpr bool plain_numbers = std::is_arithmetic_v<T> || std::is_enum_v<T>;
template <>
inline constexpr bool plain_numbers<Row> = true;
template <class S, int Rows, int Columns, int Options, int MostRows, int MostColumns>
inline constexpr bool plain_numbers<Eigen::Matrix<S, Rows, Columns, Options, MostRows, MostColumns>> =
    Rows != Eigen::Dynamic&& Columns != Eigen::Dynamic;
template <class S, int Options>
inline constexpr bool plain_numbers<Eigen::Quaternion<S, Options>> = true;
template <class T, std::size_t N>
inline constexpr bool plain_numbers<std::array<T, N>> = plain_numbers<T>;

/// Saves or restores the members passed to it. One function of a component serves both:
///
///     void serialize(Archive& archive) override { archive(last_, count_, windows_); }
///
/// Members can be numbers, enums, vectors of grit/vec.hpp, strings, `std::optional`, `vector`, `deque`, `array`, `map`
/// and `unordered_map` of these, and any type with its own `serialize(Archive&)`. Members that follow from others need
/// not be saved: recompute them if restoring(). A checkpoint may have been altered: if restoring(), throw Error for
/// members that do not fit together before they are used as indices or lengths.
class Archive {
 public:
  using Take = std::function<void(std::span<const std::byte>)>;

  /// An empty archive, to save into.
  Archive() = default;
  /// The same, but it passes its bytes on instead of keeping them: pieces of `piece` bytes, and the rest in flush().
  explicit Archive(Take take) : take_(std::move(take)) {}
  /// An archive to restore from; `saved` are the bytes() of an earlier one.
  explicit Archive(std::vector<std::byte> saved) : bytes_(std::move(saved)), restoring_(true) {}

  static constexpr std::size_t piece = std::size_t{1} << 20;

  bool restoring() const { return restoring_; }
  /// Saves or restores the members in this order. Throws Error if the archive has too few bytes to restore them.
  template <class... Members>
  void operator()(Members&... members) {
    (one(members), ...);
  }

  /// Saves or restores values without their number, which is known otherwise.
  template <class T>
  void values(std::span<T> all) {
    static_assert(plain_numbers<T>);
    raw(all.data(), all.size());
  }
  /// Appends what another archive has saved.
  void append(std::span<const std::byte> saved) { save(saved); }
  /// Saves or restores the length of a list, whose entries take at least so many bytes each.
  std::size_t length(std::size_t now, std::size_t bytes) {
    std::uint64_t count = now;
    one(count);
    if (restoring_) need(bytes, count);
    return count;
  }
  /// Throws Error if the archive has too few bytes to restore so many entries.
  void expect(std::size_t entries, std::size_t bytes) const { need(bytes, entries); }

  /// Begins a part, such as the state of one component: saves its name and version. Restoring throws Error if another
  /// part, or another version of it, was saved here. Raise the version whenever the members that follow change.
  void part(const std::string& name, std::uint32_t version) {
    std::string found = name;
    std::uint32_t found_version = version;
    one(found), one(found_version);
    if (found != name) {
      const bool is_text =
          found.size() < 100 && std::all_of(found.begin(), found.end(), [](char c) { return c >= ' ' && c <= '~'; });
      throw Error("the saved state holds other parts: \"" + name + "\" is missing" +
                  (is_text ? ", found is \"" + found + "\"" : "") +
                  "; it belongs to another description, component or version");
    }
    if (found_version != version)
      throw Error("the saved state of \"" + name + "\" has version " + std::to_string(found_version) + ", allowed is " +
                  std::to_string(version) + "; it belongs to another version of the component");
  }

  /// The saved bytes, unless they are passed on.
  const std::vector<std::byte>& bytes() const& { return bytes_; }
  std::vector<std::byte> bytes() && { return std::move(bytes_); }
  /// Passes on the last bytes, if it passes them on.
  void flush() {
    if (!take_ || bytes_.empty()) return;
    take_(bytes_);
    bytes_.clear();
  }
  /// Whether all bytes have been restored.
  bool at_end() const { return next_ == bytes_.size(); }

 private:
  template <class T>
  void one(T& member) {
    static_assert(!std::is_const_v<T>, "a member that is restored cannot be const");
    if constexpr (std::same_as<T, bool>) {
      std::uint8_t byte = member ? 1 : 0;
      raw(&byte, 1);
      member = byte != 0;
    } else if constexpr (plain_numbers<T>) {
      raw(&member, 1);
    } else {
      static_assert(
          requires(Archive & archive) { member.serialize(archive); },
          "give the type a function serialize(Archive&), or specialise plain_numbers for it");
      member.serialize(*this);
    }
  }
  template <class T, class Allocator>
  void one(std::vector<T, Allocator>& list) {
    const std::size_t count = length_of<T>(list.size());
    if constexpr (plain_numbers<T>) {
      list.resize(count);
      raw(list.data(), count);
    } else {
      entries_of(list, count);
    }
  }
  template <class T>
  void one(std::deque<T>& list) {
    entries_of(list, length_of<T>(list.size()));
  }
  /// One after the other: an altered length allocates no more than the archive has entries for.
  template <class List>
  void entries_of(List& list, std::size_t count) {
    if (!restoring_) {
      for (auto& entry : list) one(entry);
      return;
    }
    list.clear();
    for (std::size_t i = 0; i < count; ++i) {
      list.emplace_back();
      one(list.back());
    }
  }
  void one(std::string& text) {
    text.resize(length_of<char>(text.size()));
    raw(text.data(), text.size());
  }
  template <class T>
  void one(std::optional<T>& value) {
    bool there = value.has_value();
    one(there);
    if (!there) value.reset();
    else if (!value) value = T{};
    if (there) one(*value);
  }
  template <class Key, class T>
  void one(std::map<Key, T>& map) {
    entries(map, map);
  }
  /// In ascending order of keys, so that the bytes do not depend on the order of insertion.
  template <class Key, class T>
  void one(std::unordered_map<Key, T>& map) {
    std::map<Key, T> sorted(map.begin(), map.end());
    entries(sorted, map);
  }
  template <class From, class To>
  void entries(From& from, To& to) {
    const std::size_t count = length_of<typename From::key_type>(from.size());
    if (!restoring_) {
      for (auto& [key, value] : from) {
        auto copy = key;
        one(copy), one(value);
      }
      return;
    }
    to.clear();
    for (std::size_t i = 0; i < count; ++i) {
      typename From::key_type key{};
      one(key);
      one(to[key]);
    }
  }

  /// Every entry takes at least one byte.
  template <class T>
  std::size_t length_of(std::size_t now) {
    return length(now, plain_numbers<T> ? sizeof(T) : 1);
  }
  template <class T>
  void raw(T* values, std::size_t count) {
    if (count == 0) return;
    if (!restoring_) {
      save(std::as_bytes(std::span(values, count)));
      return;
    }
    need(sizeof(T), count);
    std::memcpy(static_cast<void*>(values), bytes_.data() + next_, count * sizeof(T));
    next_ += count * sizeof(T);
  }
  void save(std::span<const std::byte> from) {
    if (!take_) {
      bytes_.insert(bytes_.end(), from.begin(), from.end());
      return;
    }
    while (!from.empty()) {
      const std::size_t some = std::min(from.size(), piece - bytes_.size());
      bytes_.insert(bytes_.end(), from.begin(), from.begin() + static_cast<std::ptrdiff_t>(some));
      from = from.subspan(some);
      if (bytes_.size() == piece) flush();
    }
  }
  void need(std::size_t size, std::size_t count) const {
    if (count > (bytes_.size() - next_) / size)
      throw Error("the saved state is too short: it belongs to another component or version");
  }

  std::vector<std::byte> bytes_;  // those that were not passed on
  Take take_;
  std::size_t next_ = 0;
  bool restoring_ = false;
};

/// The present state of a component.
template <class Component>
std::vector<std::byte> saved_state(Component& component) {
  Archive archive;
  component.serialize(archive);
  return archive.bytes();
}

/// Restores a component from the saved state of one of the same kind. Throws Error if the sizes differ.
template <class Component>
void restore_state(Component& component, std::vector<std::byte> saved) {
  Archive archive(std::move(saved));
  component.serialize(archive);
  if (!archive.at_end()) throw Error("the saved state is too long: it belongs to another component or version");
}

}  // namespace grit
