// Ranks as processes of MPI. A component of its own, which grit opens where mpirun or srun has started it, so that grit
// needs no MPI elsewhere.
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <climits>
#include <exception>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "ranks/communicator.hpp"

namespace grit {
namespace {

/// Longer messages are sent in parts, as MPI counts in int.
constexpr std::size_t most_at_once = std::size_t{1} << 30;
constexpr int tag = 0;

struct Requests final : Communicator::Exchange {
  ~Requests() override { MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE); }

  std::vector<MPI_Request> requests;
};

class MpiCommunicator final : public Communicator {
 public:
  MpiCommunicator() {
    int thread_support = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &thread_support);
    if (thread_support < MPI_THREAD_FUNNELED) throw std::runtime_error("this MPI does not allow threads");
    MPI_Comm_dup(MPI_COMM_WORLD, &all_), MPI_Comm_dup(MPI_COMM_WORLD, &ends_);
    MPI_Comm_rank(all_, &rank_), MPI_Comm_size(all_, &count_);
  }

  unsigned rank() const override { return static_cast<unsigned>(rank_); }
  unsigned count() const override { return static_cast<unsigned>(count_); }

  void gather(std::span<std::byte> all, std::span<const std::size_t> starts) override {
    if (all.size() > INT_MAX) return gather_in_parts(all, starts);
    counts_.resize(count()), starts_.resize(count());
    for (unsigned r = 0; r < count(); ++r)
      counts_[r] = static_cast<int>(starts[r + 1] - starts[r]), starts_[r] = static_cast<int>(starts[r]);
    MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_BYTE, all.data(), counts_.data(), starts_.data(), MPI_BYTE, all_);
  }

  void sum(std::span<std::uint64_t> numbers) override {
    MPI_Allreduce(MPI_IN_PLACE, numbers.data(), static_cast<int>(numbers.size()), MPI_UINT64_T, MPI_SUM, all_);
  }

  void largest(std::span<double> numbers) override {
    MPI_Allreduce(MPI_IN_PLACE, numbers.data(), static_cast<int>(numbers.size()), MPI_DOUBLE, MPI_MAX, all_);
  }

  void transpose(std::span<std::uint64_t> by_rank) override {
    MPI_Alltoall(MPI_IN_PLACE, 0, MPI_UINT64_T, by_rank.data(), 1, MPI_UINT64_T, all_);
  }

  std::unique_ptr<Exchange> begin(std::span<const Message> sent, std::span<const Message> received) override {
    auto all = std::make_unique<Requests>();
    for (const Message& one : received)
      each_part(one, [&](std::byte* from, int size) {
        MPI_Irecv(from, size, MPI_BYTE, static_cast<int>(one.rank), tag, all_, &all->requests.emplace_back());
      });
    for (const Message& one : sent)
      each_part(one, [&](std::byte* from, int size) {
        MPI_Isend(from, size, MPI_BYTE, static_cast<int>(one.rank), tag, all_, &all->requests.emplace_back());
      });
    return all;
  }

  bool finish(double seconds) override {
    MPI_Request request;
    MPI_Ibarrier(ends_, &request);
    const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    for (int arrived = 0;;) {
      MPI_Test(&request, &arrived, MPI_STATUS_IGNORE);
      if (arrived != 0) break;
      if (std::chrono::steady_clock::now() > until) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    MPI_Finalize();
    return true;
  }

  [[noreturn]] void kill_all(int status) override {
    MPI_Abort(MPI_COMM_WORLD, status);
    std::terminate();
  }

 private:
  template <class Use>
  static void each_part(const Message& message, Use use) {
    for (std::size_t first = 0; first < message.bytes.size(); first += most_at_once)
      use(message.bytes.data() + first, static_cast<int>(std::min(most_at_once, message.bytes.size() - first)));
  }
  void gather_in_parts(std::span<std::byte> all, std::span<const std::size_t> starts) {
    std::vector<Message> sent, received;
    const auto part = [&](unsigned r) { return all.subspan(starts[r], starts[r + 1] - starts[r]); };
    for (unsigned r = 0; r < count(); ++r)
      if (r != rank()) sent.push_back({r, part(rank())}), received.push_back({r, part(r)});
    begin(sent, received).reset();
  }

  MPI_Comm all_, ends_;
  int rank_ = 0, count_ = 1;
  std::vector<int> counts_, starts_;
};

}  // namespace
}  // namespace grit

extern "C" [[gnu::visibility("default")]] grit::Communicator* GRIT_MPI_ENTRY() {
  static grit::MpiCommunicator all;
  return &all;
}
