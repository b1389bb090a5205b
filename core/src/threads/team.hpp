// Threads that share the chunks of one pass. Results do not depend on which thread takes which chunk.
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <memory>
#include <thread>
#include <type_traits>
#include <vector>

#include "threads/chunks.hpp"
#include "threads/stopwatch.hpp"

namespace grit {

/// A few threads that sleep without work and never wait for a thread that has no chunk, so that another process on one
/// core does not delay the others. Each starts with its own range of chunks, the same in every pass, so that
/// neighbouring chunks share the cache of a core; a thread that is done takes chunks of others.
class Team {
 public:
  /// Total number of threads, including the caller; at least 1. Throws FileError if the system does not start them.
  explicit Team(unsigned threads);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  unsigned threads() const { return static_cast<unsigned>(workers_.size()) + 1; }
  /// Computing time of passes that several threads can share, whether or not there are several [s].
  double parallel_seconds() const { return parallel_seconds_; }

  /// Calls work(i) for i = 0 … count − 1, chunk by chunk of bodies.
  template <class Work>
  void each_body(std::size_t count, Work work) {
    each(chunks_of(count), [&](std::size_t chunk) {
      const ChunkRange range(chunk, count);
      for (std::size_t i = range.first; i < range.last; ++i) work(i);
    });
  }

  /// Calls work(chunk) for chunk = 0 … chunks − 1, from any thread, and returns when all are done. One single thread
  /// takes them in order; several take fewer than 2²⁰ and throw Error for more. If `work` throws, one of its exceptions
  /// is rethrown at the end. Not reentrant.
  template <class Work>
  void each(std::size_t chunks, Work&& work) {
    if (chunks < 2) {
      for (std::size_t i = 0; i < chunks; ++i) work(i);
      return;
    }
    const Stopwatch watch(parallel_seconds_);
    if (workers_.empty()) {
      for (std::size_t i = 0; i < chunks; ++i) work(i);
      return;
    }
    run(
        chunks, [](void* context, std::size_t i) { (*static_cast<std::remove_reference_t<Work>*>(context))(i); },
        &work);
  }

 private:
  using Call = void (*)(void*, std::size_t);
  // Everything is in one word, so that a late thread cannot take a chunk of a finished job:
  // generation (24 bits), end of the stretch (20), next chunk (20).
  struct alignas(64) Stretch {
    std::atomic<std::uint64_t> ticket{0};
  };

  void run(std::size_t chunks, Call call, void* context);
  void work_loop(unsigned thread);
  /// Ends the threads that were started.
  void stop();
  /// Takes chunks of the present job until none is left, first those of the thread's own range.
  void take_chunks(std::uint32_t generation, unsigned thread);

  std::unique_ptr<Stretch[]> stretch_;  // by thread
  std::atomic<std::uint32_t> generation_{0}, left_{0};
  std::atomic<bool> stop_{false};
  Call call_ = nullptr;
  void* context_ = nullptr;
  std::atomic<bool> failed_{false};
  std::exception_ptr failure_;
  double parallel_seconds_ = 0;
  std::vector<std::thread> workers_;
};

}  // namespace grit
