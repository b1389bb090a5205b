// Saves a state that ranks share, as one process would save it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <type_traits>

#include "grit/archive.hpp"
#include "ranks/ranks.hpp"
#include "threads/chunks.hpp"

namespace grit {

/// The archive of the first rank gets values that are alike on all ranks, and those of chunks one chunk after the other
/// from their owners. No rank collects more than Archive::piece bytes of others. Archives of other ranks get only what
/// is alike. All ranks must save the same. Each rank restores the whole state.
class SharedArchive {
 public:
  SharedArchive(Archive& archive, Ranks& ranks) : archive_(archive), ranks_(ranks) {}

  bool restoring() const { return archive_.restoring(); }
  const Ranks& ranks() const { return ranks_; }
  /// Members that are alike on all ranks.
  template <class... Members>
  void operator()(Members&... members) {
    archive_(members...);
  }
  /// Saves or restores the length of a list that is alike on all ranks; see Archive.
  std::size_t length(std::size_t now, std::size_t least) { return archive_.length(now, least); }

  /// Calls one(archive, chunk) for all chunks, in order; saving, each rank does so for its own ones.
  template <class One>
  void each_chunk(std::size_t chunks, One one) {
    if (restoring() || !ranks_.several()) {
      for (std::size_t chunk = 0; chunk < chunks; ++chunk) one(archive_, chunk);
      return;
    }
    const std::size_t first = std::min(ranks_.first(), chunks), last = std::min(ranks_.last(), chunks);
    if (ranks_.rank() == 0) {
      for (std::size_t chunk = first; chunk < last; ++chunk) one(archive_, chunk);
      for (unsigned rank = 1; rank < ranks_.count(); ++rank)
        ranks_.receive_pieces(rank, [this](std::span<const std::byte> piece) { archive_.append(piece); });
    } else {
      Archive own([this](std::span<const std::byte> piece) { ranks_.send_piece(0, piece); });
      for (std::size_t chunk = first; chunk < last; ++chunk) one(own, chunk);
      own.flush();
      ranks_.send_piece(0, {});
    }
  }
  /// Lists with an entry for each of some bodies; they are as long on all ranks. Restoring, they have their length.
  template <class... Lists>
  void each_body(std::size_t bodies, Lists&... lists) {
    each_chunk(chunks_of(bodies), [&](Archive& archive, std::size_t chunk) {
      const ChunkRange range(chunk, bodies);
      (entries(archive, lists, range.first, range.last), ...);
    });
  }

 private:
  /// None of an empty list.
  template <class List>
  static void entries(Archive& archive, List& list, std::size_t first, std::size_t last) {
    if (!list.empty()) archive.values(std::span(list).subspan(first, last - first));
  }

  Archive& archive_;
  Ranks& ranks_;
};

}  // namespace grit
