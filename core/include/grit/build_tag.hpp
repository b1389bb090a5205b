// How a translation unit was built. The loader compares this tag before it uses anything else of a plugin.
#pragma once

#include <cstddef>
#include <cstdint>

#include "grit/contact/batch.hpp"
#include "grit/vec.hpp"

namespace grit {

/// Incremented with every change of an interface between grit and plugins.
inline constexpr std::uint32_t sdk_version = 30;

/// Size and alignment of a struct on the hot path.
struct Layout {
  std::uint32_t size, alignment;
  friend bool operator==(const Layout&, const Layout&) = default;
};

/// How a plugin was built. The layout of this struct never changes; new entries go into `reserved`.
struct BuildTag {
  char magic[8];
  std::uint32_t tag_size;
  std::uint32_t sdk_version;
  char compiler[48];         ///< e.g. "gcc 12"
  char library_abi[48];      ///< e.g. "libstdc++ cxx11 20220819"
  char instruction_set[64];  ///< e.g. "x86-64-v3", "x86-64-v2 avx"
  Layout row, contact_row, body_sum, pair_batch, wall_batch;
  char reserved[256];
};

// Internal linkage, also for every function that build_tag() calls: the dynamic linker merges inline functions of
// shared libraries whose symbols are visible. A merged build_tag() would give every plugin the tag of grit itself.
namespace {
namespace tag_text {

template <std::size_t N>
constexpr void put(char (&target)[N], const char* text) {
  std::size_t i = 0;
  while (i + 1 < N && target[i] != 0) ++i;
  while (i + 1 < N && *text != 0) target[i++] = *text++;
}

template <std::size_t N>
constexpr void put(char (&target)[N], long number) {
  char digits[24] = {};
  int last = 23;
  do digits[--last] = static_cast<char>('0' + number % 10);
  while ((number /= 10) > 0);
  put(target, digits + last);
}

/// The highest x86-64 level, 1 to 4, whose instructions the compiler may use; 0 for another architecture.
constexpr long x86_64_level() {
#if !defined(__x86_64__)
  return 0;
#elif !defined(__SSE4_2__) || !defined(__POPCNT__)
  return 1;
#elif !defined(__AVX2__) || !defined(__BMI__) || !defined(__BMI2__) || !defined(__F16C__) || !defined(__FMA__) || \
    !defined(__LZCNT__) || !defined(__MOVBE__)
  return 2;
#elif !defined(__AVX512F__) || !defined(__AVX512BW__) || !defined(__AVX512CD__) || !defined(__AVX512DQ__) || \
    !defined(__AVX512VL__)
  return 3;
#else
  return 4;
#endif
}

template <class T>
constexpr Layout layout_of() {
  return {sizeof(T), alignof(T)};
}

}  // namespace tag_text

/// The tag of the translation unit that calls this.
constexpr BuildTag build_tag() {
  BuildTag tag{};
  tag_text::put(tag.magic, "gritplg");
  tag.tag_size = sizeof(BuildTag);
  tag.sdk_version = sdk_version;
#if defined(__clang__)
  tag_text::put(tag.compiler, "clang ");
  tag_text::put(tag.compiler, long{__clang_major__});
#elif defined(__GNUC__)
  tag_text::put(tag.compiler, "gcc ");
  tag_text::put(tag.compiler, long{__GNUC__});
#else
  tag_text::put(tag.compiler, "unknown");
#endif
#if defined(_GLIBCXX_USE_CXX11_ABI)
  tag_text::put(tag.library_abi, _GLIBCXX_USE_CXX11_ABI ? "libstdc++ cxx11 " : "libstdc++ old ");
  tag_text::put(tag.library_abi, long{__GLIBCXX__});
#else
  tag_text::put(tag.library_abi, "unknown");
#endif
#if defined(__x86_64__)
  tag_text::put(tag.instruction_set, "x86-64");
#elif defined(__aarch64__)
  tag_text::put(tag.instruction_set, "aarch64");
#else
  tag_text::put(tag.instruction_set, "unknown");
#endif
  const long level = tag_text::x86_64_level();
  if (level > 1) {
    tag_text::put(tag.instruction_set, "-v");
    tag_text::put(tag.instruction_set, level);
  }
  // Vector instructions beyond the level.
#if defined(__AVX__)
  if (level < 3) tag_text::put(tag.instruction_set, " avx");
#endif
#if defined(__AVX2__)
  if (level < 3) tag_text::put(tag.instruction_set, " avx2");
#endif
#if defined(__FMA__)
  if (level < 3) tag_text::put(tag.instruction_set, " fma");
#endif
#if defined(__AVX512F__)
  if (level < 4) tag_text::put(tag.instruction_set, " avx512f");
#endif
  tag.row = tag_text::layout_of<Row>();
  tag.contact_row = tag_text::layout_of<ContactRow>();
  tag.body_sum = tag_text::layout_of<BodySum>();
  tag.pair_batch = tag_text::layout_of<PairBatch>();
  tag.wall_batch = tag_text::layout_of<WallBatch>();
  return tag;
}

}  // namespace

}  // namespace grit
