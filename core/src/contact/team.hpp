// Threads that share the chunks of one pass. Who takes which chunk is chance; results never depend on it.
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <memory>
#include <thread>
#include <type_traits>
#include <vector>

namespace grit {

/// A few threads that sleep when there is nothing to do and never wait for a thread that has no chunk in hand, so that
/// a busy neighbour on one core costs no more than its share. Each begins with a stretch of its own, the same in every
/// pass, so that neighbouring chunks meet in one core's cache; who is done helps the others.
class Team {
 public:
  /// `threads` in all, the caller included; at least 1.
  explicit Team(unsigned threads);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  unsigned threads() const { return static_cast<unsigned>(workers_.size()) + 1; }

  /// Calls work(chunk) for chunk = 0 … chunks − 1 (fewer than 2²⁰), from any thread, and returns when all are done. One
  /// thread alone takes them in their order. If `work` throws, one of its exceptions is thrown on then. Not reentrant.
  template <class Work>
  void each(std::size_t chunks, Work&& work) {
    if (workers_.empty() || chunks < 2) {
      for (std::size_t i = 0; i < chunks; ++i) work(i);
      return;
    }
    run(
        chunks, [](void* context, std::size_t i) { (*static_cast<std::remove_reference_t<Work>*>(context))(i); },
        &work);
  }

 private:
  using Call = void (*)(void*, std::size_t);
  // One word says everything, so that a thread that comes late cannot take a chunk of a job that is over:
  // generation (24 bits), end of the stretch (20), next chunk (20).
  struct alignas(64) Stretch {
    std::atomic<std::uint64_t> ticket{0};
  };

  void run(std::size_t chunks, Call call, void* context);
  void work_loop(unsigned thread);
  /// Takes chunks of the present job until none is left, of the thread's own stretch first.
  void take_chunks(std::uint32_t generation, unsigned thread);

  std::unique_ptr<Stretch[]> stretch_;  // by thread
  std::atomic<std::uint32_t> generation_{0}, left_{0};
  std::atomic<bool> stop_{false};
  Call call_ = nullptr;
  void* context_ = nullptr;
  std::atomic<bool> failed_{false};
  std::exception_ptr failure_;
  std::vector<std::thread> workers_;
};

}  // namespace grit
