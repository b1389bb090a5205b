#include "contact/team.hpp"

#include <algorithm>
#include <utility>

namespace grit {
namespace {

constexpr int index_bits = 20;
constexpr std::uint64_t index_mask = (1u << index_bits) - 1;

std::uint64_t generation_of(std::uint64_t ticket) { return ticket >> (2 * index_bits); }
std::uint64_t chunks_of(std::uint64_t ticket) { return ticket >> index_bits & index_mask; }
std::uint64_t next_of(std::uint64_t ticket) { return ticket & index_mask; }
bool has_work(std::uint64_t ticket) { return next_of(ticket) < chunks_of(ticket); }

// A pass takes some 100 µs; waking a sleeper some 5 µs. A spin of about 10 µs bridges the gap between two passes.
constexpr int spins = 400;
void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

}  // namespace

Team::Team(unsigned threads) {
  for (unsigned i = 1; i < threads; ++i) workers_.emplace_back([this] { work_loop(); });
}

Team::~Team() {
  stop_.store(true);
  ticket_.fetch_add(std::uint64_t{1} << (2 * index_bits));
  ticket_.notify_all();
  for (auto& worker : workers_) worker.join();
}

void Team::run(std::size_t chunks, Call call, void* context) {
  call_ = call, context_ = context;
  done_.store(0, std::memory_order_relaxed);
  const std::uint64_t generation = generation_of(ticket_.load(std::memory_order_relaxed)) + 1;
  ticket_.store(generation << (2 * index_bits) | std::uint64_t{chunks} << index_bits, std::memory_order_release);
  ticket_.notify_all();
  take_chunks(generation_of(ticket_.load(std::memory_order_relaxed)));
  const auto all = static_cast<std::uint32_t>(chunks);
  std::uint32_t done = done_.load(std::memory_order_acquire);
  for (int i = 0; i < spins && done != all; ++i) pause(), done = done_.load(std::memory_order_acquire);
  while (done != all) done_.wait(done, std::memory_order_acquire), done = done_.load(std::memory_order_acquire);
  if (failed_.exchange(false)) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void Team::take_chunks(std::uint64_t generation) {
  std::uint64_t ticket = ticket_.load(std::memory_order_acquire);
  while (generation_of(ticket) == generation && has_work(ticket)) {
    if (!ticket_.compare_exchange_weak(ticket, ticket + 1, std::memory_order_acq_rel)) continue;
    // The job cannot end before this chunk is done, so that call_ and context_ are its own.
    const std::uint64_t chunks = chunks_of(ticket);
    try {
      call_(context_, next_of(ticket));
    } catch (...) {
      if (!failed_.exchange(true)) failure_ = std::current_exception();
    }
    if (done_.fetch_add(1, std::memory_order_acq_rel) + 1 == chunks) done_.notify_one();
    ticket = ticket_.load(std::memory_order_acquire);
  }
}

void Team::work_loop() {
  while (!stop_.load(std::memory_order_relaxed)) {
    std::uint64_t ticket = ticket_.load(std::memory_order_acquire);
    for (int i = 0; i < spins && !has_work(ticket); ++i) pause(), ticket = ticket_.load(std::memory_order_acquire);
    if (has_work(ticket)) take_chunks(generation_of(ticket));
    else if (!stop_.load()) ticket_.wait(ticket, std::memory_order_acquire);
  }
}

}  // namespace grit
