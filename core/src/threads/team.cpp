#include "threads/team.hpp"

#include <algorithm>
#include <string>
#include <system_error>
#include <utility>

#include "grit/error.hpp"
#include "threads/chunks.hpp"

namespace grit {
namespace {

constexpr int index_bits = 20;
constexpr std::uint64_t index_mask = (1u << index_bits) - 1;
constexpr std::uint32_t generation_mask = (1u << 24) - 1;

std::uint64_t make_ticket(std::uint32_t generation, std::size_t first, std::size_t end) {
  return std::uint64_t{generation} << (2 * index_bits) | std::uint64_t{end} << index_bits | first;
}
std::uint32_t generation_of(std::uint64_t ticket) { return static_cast<std::uint32_t>(ticket >> (2 * index_bits)); }
std::uint64_t end_of(std::uint64_t ticket) { return ticket >> index_bits & index_mask; }
std::uint64_t next_of(std::uint64_t ticket) { return ticket & index_mask; }

// A pass takes some 100 µs; waking a sleeping thread some 5 µs. Spinning for about 10 µs bridges the gap between
// passes.
constexpr int spins = 400;
void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

/// Spins for a while, then sleeps, until `value` changes.
template <class T>
void wait_while(const std::atomic<T>& value, T was) {
  for (int i = 0; i < spins; ++i) {
    if (value.load(std::memory_order_acquire) != was) return;
    pause();
  }
  value.wait(was, std::memory_order_acquire);
}

}  // namespace

Team::Team(unsigned threads) : stretch_(std::make_unique<Stretch[]>(threads)) {
  workers_.reserve(threads - 1);
  try {
    for (unsigned i = 1; i < threads; ++i) workers_.emplace_back([this, i] { work_loop(i); });
  } catch (const std::system_error& error) {
    const std::size_t started = workers_.size() + 1;
    stop();
    throw FileError("cannot start " + std::to_string(threads) + " threads, only " + std::to_string(started) + ": " +
                    error.code().message() +
                    "; use fewer threads, or allow this user more processes or memory (ulimit)");
  } catch (...) {
    stop();
    throw;
  }
}

Team::~Team() { stop(); }

void Team::stop() {
  stop_.store(true);
  generation_.fetch_add(1);
  generation_.notify_all();
  for (auto& worker : workers_) worker.join();
}

void Team::run(std::size_t chunks, Call call, void* context) {
  if (chunks > index_mask)
    throw Error("found " + std::to_string(chunks) + " chunks of bodies; allowed with several threads are up to " +
                std::to_string(index_mask) + " of " + std::to_string(chunk_bodies) +
                " bodies each: use one thread, or fewer bodies");
  call_ = call, context_ = context;
  left_.store(static_cast<std::uint32_t>(chunks), std::memory_order_relaxed);
  const std::uint32_t generation = (generation_.load(std::memory_order_relaxed) + 1) & generation_mask;
  for (unsigned t = 0; t < threads(); ++t)
    stretch_[t].ticket.store(make_ticket(generation, chunks * t / threads(), chunks * (t + 1) / threads()),
                             std::memory_order_release);
  generation_.store(generation, std::memory_order_release);
  generation_.notify_all();
  take_chunks(generation, 0);
  for (std::uint32_t left; (left = left_.load(std::memory_order_acquire)) != 0;) wait_while(left_, left);
  if (failed_.exchange(false)) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void Team::take_chunks(std::uint32_t generation, unsigned thread) {
  for (unsigned t = 0; t < threads(); ++t) {
    std::atomic<std::uint64_t>& stretch = stretch_[(thread + t) % threads()].ticket;
    std::uint64_t ticket = stretch.load(std::memory_order_acquire);
    while (generation_of(ticket) == generation && next_of(ticket) < end_of(ticket)) {
      if (!stretch.compare_exchange_weak(ticket, ticket + 1, std::memory_order_acq_rel)) continue;
      // The job cannot end before this chunk is done, so that call_ and context_ are its own.
      try {
        call_(context_, next_of(ticket));
      } catch (...) {
        if (!failed_.exchange(true)) failure_ = std::current_exception();
      }
      if (left_.fetch_sub(1, std::memory_order_acq_rel) == 1) left_.notify_one();
      ticket = stretch.load(std::memory_order_acquire);
    }
  }
}

void Team::work_loop(unsigned thread) {
  for (std::uint32_t seen = 0; !stop_.load();) {
    const std::uint32_t generation = generation_.load(std::memory_order_acquire);
    if (generation == seen) {
      wait_while(generation_, seen);
      continue;
    }
    seen = generation;
    take_chunks(generation, thread);
  }
}

}  // namespace grit
