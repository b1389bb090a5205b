// Messages between the processes that share one simulation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace grit {

/// The ranks of a run: processes started by `mpirun`. All call the same functions in the same order.
class Communicator {
 public:
  /// Bytes to or from a rank.
  struct Message {
    unsigned rank;
    std::span<std::byte> bytes;
  };

  virtual ~Communicator() = default;
  /// From 0 on.
  virtual unsigned rank() const = 0;
  virtual unsigned count() const = 0;
  /// Fills `all` with a part of each rank: that of rank r from starts[r] to starts[r + 1]. The own part is in place
  /// before.
  virtual void gather(std::span<std::byte> all, std::span<const std::size_t> starts) = 0;
  /// Adds the numbers of all ranks, entry by entry.
  virtual void sum(std::span<std::uint64_t> numbers) = 0;
  /// Takes the largest of all ranks, entry by entry.
  virtual void largest(std::span<double> numbers) = 0;
  /// Sends entry r to rank r, and takes in its place what that rank sends to this one.
  virtual void transpose(std::span<std::uint64_t> by_rank) = 0;
  /// Messages on their way. The end of its lifetime waits until those that were sent may change, and others are there.
  class Exchange {
   public:
    virtual ~Exchange() = default;
  };
  /// Begins to send some messages and to receive others, of known lengths: at most one to and one from each rank.
  [[nodiscard]] virtual std::unique_ptr<Exchange> begin(std::span<const Message> sent,
                                                        std::span<const Message> received) = 0;
  /// The last call of each rank: waits for the others. False if they have not called it within so many seconds.
  virtual bool finish(double seconds) = 0;
  /// Kills the processes of all ranks, with this exit status, as this one cannot go on.
  [[noreturn]] virtual void kill_all(int status) = 0;
};

}  // namespace grit
