// Indices of bodies after they have been sorted in space.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace grit {

/// Index that marks a body as removed.
inline constexpr std::uint32_t body_gone = ~0u;

/// The present index of each body by its former one, or body_gone. A rank may know some bodies only.
class Renumbering {
 public:
  /// No index has changed.
  Renumbering() = default;
  /// `order[i]` is the former index, below `before`, of the body that now has index i. Others have left.
  Renumbering(std::span<const std::uint32_t> order, std::size_t before) : Renumbering(before) {
    std::fill_n(now_.get(), before, body_gone);
    for (std::size_t i = 0; i < order.size(); ++i) now_[order[i]] = static_cast<std::uint32_t>(i);
  }
  /// Of `before` bodies, none of which is known yet: each must be set() before it is read.
  explicit Renumbering(std::size_t before) : now_(new std::uint32_t[before]) {}  // pages that are not used cost nothing

  bool changes() const { return now_ != nullptr; }
  std::uint32_t operator()(std::uint32_t former) const { return changes() ? now_[former] : former; }
  void set(std::uint32_t former, std::uint32_t now) { now_[former] = now; }

 private:
  std::unique_ptr<std::uint32_t[]> now_;
};

}  // namespace grit
