// Arrays with huge pages, for random access in the contact loop.
#pragma once

#include <sys/mman.h>

#include <algorithm>
#include <cstddef>
#include <new>
#include <vector>

namespace grit {

/// Requests pages of 2 MiB, so that the TLB covers the whole scene; with pages of 4 KiB a step of 50 000 grains took
/// about a tenth longer.
template <class T>
struct LargePages {
  using value_type = T;
  static constexpr std::size_t page = std::size_t{2} << 20;

  LargePages() = default;
  template <class Other>
  LargePages(const LargePages<Other>&) {}

  T* allocate(std::size_t count) {
    const std::size_t bytes = whole(count * sizeof(T));
    void* const memory = ::operator new(bytes, alignment(bytes));
    if (bytes >= page) ::madvise(memory, bytes, MADV_HUGEPAGE);  // a hint: failure is harmless
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) { ::operator delete(memory, alignment(whole(count * sizeof(T)))); }
  template <class Other>
  bool operator==(const LargePages<Other>&) const {
    return true;
  }

 private:
  /// Rounds up to whole pages, unless most of that would be unused.
  static std::size_t whole(std::size_t bytes) { return bytes < page / 8 ? bytes : (bytes + page - 1) / page * page; }
  static std::align_val_t alignment(std::size_t bytes) {
    return std::align_val_t{bytes >= page ? page : std::max<std::size_t>(64, alignof(T))};
  }
};

template <class T>
using LargeArray = std::vector<T, LargePages<T>>;

}  // namespace grit
