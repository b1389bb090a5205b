// What a component remembers from one step to the next: named once, for saving in a checkpoint and for going on from
// it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "grit/error.hpp"
#include "grit/vec.hpp"

namespace grit {

/// Whether the bytes of a type are all that there is to it. A struct of numbers, without pointers, texts and lists, may
/// say so: `template <> inline constexpr bool grit::plain_numbers<Mine> = true;`
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

/// Saves members that it is given, or restores them: one function of a component serves both,
///
///     void remember(Memory& memory) override { memory(last_, count_, windows_); }
///
/// Members are numbers, enums, vectors of grit/vec.hpp, texts, `std::optional`, `vector`, `deque`, `array`, `map` and
/// `unordered_map` of such, and whatever has a `remember(Memory&)` of its own. What can be worked out again from the
/// others need not be saved; then restoring() says when.
class Memory {
 public:
  /// To save into.
  Memory() = default;
  /// To restore from what was saved.
  explicit Memory(std::vector<std::byte> saved) : bytes_(std::move(saved)), restoring_(true) {}

  bool restoring() const { return restoring_; }
  /// Throws Error if less was saved than is to be restored.
  template <class... Members>
  void operator()(Members&... members) {
    (one(members), ...);
  }

  /// All that was saved.
  const std::vector<std::byte>& bytes() const { return bytes_; }
  /// Whether all has been restored.
  bool at_end() const { return next_ == bytes_.size(); }

 private:
  template <class T>
  void one(T& member) {
    static_assert(!std::is_const_v<T>, "what is restored cannot be const");
    if constexpr (plain_numbers<T>) {
      raw(&member, 1);
    } else {
      static_assert(
          requires(Memory & memory) { member.remember(memory); },
          "give the type a function remember(Memory&), or say that it is plain_numbers");
      member.remember(*this);
    }
  }
  template <class T, class Allocator>
  void one(std::vector<T, Allocator>& list) {
    list.resize(length<T>(list.size()));
    if constexpr (plain_numbers<T>) raw(list.data(), list.size());
    else
      for (T& entry : list) one(entry);
  }
  template <class T>
  void one(std::deque<T>& list) {
    list.resize(length<T>(list.size()));
    for (T& entry : list) one(entry);
  }
  void one(std::string& text) {
    text.resize(length<char>(text.size()));
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
  /// By rising key, so that what is saved does not depend on how it came about.
  template <class Key, class T>
  void one(std::unordered_map<Key, T>& map) {
    std::map<Key, T> sorted(map.begin(), map.end());
    entries(sorted, map);
  }
  template <class From, class To>
  void entries(From& from, To& to) {
    const std::size_t count = length<typename From::key_type>(from.size());
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

  /// Of a list: saved or restored. Every entry takes a byte at least.
  template <class T>
  std::size_t length(std::size_t now) {
    std::uint64_t count = now;
    one(count);
    if (restoring_) need(plain_numbers<T> ? sizeof(T) : 1, count);
    return count;
  }
  template <class T>
  void raw(T* values, std::size_t count) {
    if (count == 0) return;
    if (!restoring_) {
      const auto* const from = reinterpret_cast<const std::byte*>(values);
      bytes_.insert(bytes_.end(), from, from + count * sizeof(T));
      return;
    }
    need(sizeof(T), count);
    std::memcpy(static_cast<void*>(values), bytes_.data() + next_, count * sizeof(T));
    next_ += count * sizeof(T);
  }
  void need(std::size_t size, std::size_t count) const {
    if (count > (bytes_.size() - next_) / size) throw Error("more is to be remembered than was saved");
  }

  std::vector<std::byte> bytes_;
  std::size_t next_ = 0;
  bool restoring_ = false;
};

/// What a component remembers now.
template <class Component>
std::vector<std::byte> saved_memory(Component& component) {
  Memory memory;
  component.remember(memory);
  return memory.bytes();
}

/// Has it remember what was saved of its like. Throws Error unless that is all that it remembers.
template <class Component>
void restore_memory(Component& component, std::vector<std::byte> saved) {
  Memory memory(std::move(saved));
  component.remember(memory);
  if (!memory.at_end()) throw Error("less is to be remembered than was saved");
}

}  // namespace grit
