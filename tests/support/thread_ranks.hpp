// Ranks that are threads of one process.
#pragma once

#include <algorithm>
#include <atomic>
#include <barrier>
#include <condition_variable>
#include <cstring>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "ranks/communicator.hpp"

namespace grit::test {

/// What the threads show each other.
class Board {
 public:
  explicit Board(unsigned count) : shown_(count), barrier_(static_cast<std::ptrdiff_t>(count)) {}

  unsigned count() const { return static_cast<unsigned>(shown_.size()); }
  /// Shows messages to all ranks, lets this one take what it needs, and returns when all have.
  void share(unsigned rank, std::vector<Communicator::Message> messages,
             const std::function<void(const std::vector<std::vector<Communicator::Message>>&)>& take) {
    shown_[rank] = std::move(messages);
    meet();
    take(shown_);
    meet();
  }
  /// A message between two ranks, of which no other rank knows.
  void send(unsigned from, unsigned to, std::span<const std::byte> bytes) {
    const std::lock_guard lock(mutex_);
    Mail& mail = mail_[{from, to}];
    mail.arrived[mail.sent++].assign(bytes.begin(), bytes.end());
    longest_message_ = std::max(longest_message_, bytes.size());
    arrived_.notify_all();
  }
  /// The number of the next message from one rank to another: messages arrive as they were expected.
  std::size_t expect(unsigned from, unsigned to) {
    const std::lock_guard lock(mutex_);
    return mail_[{from, to}].expected++;
  }
  /// Waits for a message. Nothing if another rank has failed.
  std::optional<std::vector<std::byte>> receive(unsigned from, unsigned to, std::size_t number) {
    std::unique_lock lock(mutex_);
    auto& messages = mail_[{from, to}].arrived;
    arrived_.wait(lock, [&] { return messages.contains(number) || failed_; });
    if (!messages.contains(number)) return {};
    return std::move(messages.extract(number).mapped());
  }
  std::size_t longest_message() const { return longest_message_; }
  /// A rank ends by an exception: the others must not wait for it.
  void leave() {
    {
      const std::lock_guard lock(mutex_);
      failed_ = true;
    }
    arrived_.notify_all();
    barrier_.arrive_and_drop();
  }

 private:
  void meet() {
    barrier_.arrive_and_wait();
    if (failed_) throw std::runtime_error("another rank has failed");
  }

  std::vector<std::vector<Communicator::Message>> shown_;
  std::barrier<> barrier_;
  std::atomic<bool> failed_{false};
  std::size_t longest_message_ = 0;
  std::mutex mutex_;
  std::condition_variable arrived_;
  struct Mail {
    std::size_t sent = 0, expected = 0;
    std::map<std::size_t, std::vector<std::byte>> arrived;
  };
  std::map<std::pair<unsigned, unsigned>, Mail> mail_;  // by sender and receiver
};

class ThreadRank final : public Communicator {
  struct Expected final : Exchange {
    Expected(Board& messages_board, unsigned own) : board(messages_board), rank(own) {}
    /// Where another rank has failed, the next function of all ranks throws.
    ~Expected() override {
      for (const auto& [one, number] : messages)
        if (const auto found = board.receive(one.rank, rank, number)) copy(*found, one.bytes);
    }
    Board& board;
    unsigned rank;
    std::vector<std::pair<Message, std::size_t>> messages;
  };

 public:
  ThreadRank(Board& board, unsigned rank) : board_(board), rank_(rank) {}

  unsigned rank() const override { return rank_; }
  unsigned count() const override { return board_.count(); }
  void gather(std::span<std::byte> all, std::span<const std::size_t> starts) override {
    const auto part = [&](unsigned r) { return all.subspan(starts[r], starts[r + 1] - starts[r]); };
    board_.share(rank_, {{rank_, part(rank_)}}, [&](const auto& shown) {
      for (unsigned r = 0; r < count(); ++r)
        if (r != rank_) copy(shown[r].front().bytes, part(r));
    });
  }
  void sum(std::span<std::uint64_t> numbers) override {
    reduce(numbers, [](std::uint64_t a, std::uint64_t b) { return a + b; });
  }
  void largest(std::span<double> numbers) override {
    reduce(numbers, [](double a, double b) { return std::max(a, b); });
  }
  void transpose(std::span<std::uint64_t> by_rank) override {
    std::vector<std::uint64_t> own(by_rank.begin(), by_rank.end());
    board_.share(rank_, {{rank_, std::as_writable_bytes(std::span(own))}}, [&](const auto& shown) {
      for (unsigned r = 0; r < count(); ++r) {
        const auto theirs = shown[r].front().bytes.subspan(rank_ * sizeof(std::uint64_t), sizeof(std::uint64_t));
        copy(theirs, std::as_writable_bytes(by_rank.subspan(r, 1)));
      }
    });
  }
  std::unique_ptr<Exchange> begin(std::span<const Message> sent, std::span<const Message> received) override {
    for (const Message& one : sent) board_.send(rank_, one.rank, one.bytes);
    auto all = std::make_unique<Expected>(board_, rank_);
    for (const Message& one : received) all->messages.emplace_back(one, board_.expect(one.rank, rank_));
    return all;
  }
  bool finish(double) override {
    board_.share(rank_, {}, [](const auto&) {});
    return true;
  }
  [[noreturn]] void kill_all(int) override { throw std::runtime_error("a rank ends all"); }

 private:
  template <class T, class Operation>
  void reduce(std::span<T> numbers, Operation operation) {
    std::vector<T> own(numbers.begin(), numbers.end());
    board_.share(rank_, {{rank_, std::as_writable_bytes(std::span(own))}}, [&](const auto& shown) {
      for (unsigned r = 0; r < count(); ++r) {
        std::vector<T> theirs(numbers.size());
        copy(shown[r].front().bytes, std::as_writable_bytes(std::span(theirs)));
        for (std::size_t k = 0; k < theirs.size(); ++k)
          numbers[k] = r == 0 ? theirs[k] : operation(numbers[k], theirs[k]);
      }
    });
  }
  static void copy(std::span<const std::byte> from, std::span<std::byte> to) {
    if (from.size() != to.size()) throw std::logic_error("a message has another length");
    std::ranges::copy(from, to.begin());
  }

  Board& board_;
  unsigned rank_;
};

/// Calls work(communicator) on so many ranks at once. Throws the first exception of one.
inline void on_ranks(unsigned count, const std::function<void(Communicator&)>& work) {
  Board board(count);
  std::vector<std::exception_ptr> failures(count);
  {
    std::vector<std::jthread> threads;
    for (unsigned r = 0; r < count; ++r)
      threads.emplace_back([&, r] {
        ThreadRank own(board, r);
        try {
          work(own);
        } catch (...) {
          failures[r] = std::current_exception();
          board.leave();
        }
      });
  }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace grit::test
