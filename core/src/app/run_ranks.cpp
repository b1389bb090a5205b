#include "app/run_ranks.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/dll/shared_library.hpp>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <thread>

#include "grit/error.hpp"
#include "plugins/loader.hpp"

namespace grit {
namespace {

unsigned number_of(const char* variable) {
  const char* const text = std::getenv(variable);
  unsigned number = 0;
  if (text != nullptr) std::from_chars(text, text + std::char_traits<char>::length(text), number);
  return number;
}

/// As Open MPI, MPICH and Slurm report it.
unsigned started_processes() {
  return std::max({number_of("OMPI_COMM_WORLD_SIZE"), number_of("PMI_SIZE"), number_of("SLURM_STEP_NUM_TASKS")});
}
unsigned processes_here() {
  return std::max({1u, number_of("OMPI_COMM_WORLD_LOCAL_SIZE"), number_of("MPI_LOCALNRANKS")});
}

Communicator* open_mpi() {
  const auto file = library_directory() / "mpi.so";
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    throw Error("started as one of " + std::to_string(started_processes()) +
                " processes, but this build runs in one: " + file.string() +
                " is missing; install MPI (Debian: libopenmpi-dev) and build again, or start grit without mpirun");
  // Open MPI opens components of its own, which need its symbols.
  static boost::dll::shared_library library;
  library.load(file, boost::dll::load_mode::rtld_lazy | boost::dll::load_mode::rtld_global, error);
  if (error) throw Error(file.string() + " cannot be opened: " + error.message());
  return library.get<Communicator*()>("grit_mpi")();
}

constexpr std::size_t longest_shown = 500;

std::string host() {
  std::array<char, 256> name{};
  ::gethostname(name.data(), name.size() - 1);
  return name.data();
}

/// The text of each rank.
std::vector<std::string> texts(Ranks& ranks, const std::string& own) {
  const std::vector<std::size_t> lengths = ranks.each(own.size());
  const std::vector<char> all = ranks.all(std::vector<char>(own.begin(), own.end()));
  std::vector<std::string> texts;
  auto next = all.begin();
  for (const std::size_t length : lengths) {
    texts.emplace_back(next, next + static_cast<std::ptrdiff_t>(length));
    next += static_cast<std::ptrdiff_t>(length);
  }
  return texts;
}

}  // namespace

RunRanks::RunRanks() {
  if (started_processes() < 2) return;
  all_ = open_mpi();
  // Else each would run alone, into the same folder.
  if (all_->count() == 1)
    throw Error("started as one of " + std::to_string(started_processes()) +
                " processes, of which MPI connects none; use mpirun of the same MPI, or srun --mpi=pmix");
  ranks_ = Ranks(all_);
  if (is_first()) return;
  out_ = std::cout.rdbuf(silent_.rdbuf()), errors_ = std::cerr.rdbuf(silent_.rdbuf());
}

RunRanks::~RunRanks() {
  if (out_ != nullptr) std::cout.rdbuf(out_), std::cerr.rdbuf(errors_);
}

std::string RunRanks::messages() {
  std::string text = silent_.str();
  silent_.str("");
  return text;
}

std::optional<std::vector<std::byte>> RunRanks::agree(const std::vector<RankFact>& facts, const std::string& failure,
                                                      std::vector<std::byte> given) {
  awaited_ = false;
  const std::vector<std::string> hosts = texts(ranks_, host()), failures = texts(ranks_, failure);
  std::vector<std::vector<std::string>> all;  // by fact, of each rank
  for (const RankFact& fact : facts) all.push_back(texts(ranks_, fact.text));
  bool agrees = true;
  for (unsigned rank = 0; rank < count(); ++rank) {
    std::string why = failures[rank].starts_with("grit: ") ? failures[rank].substr(6) : failures[rank];
    for (std::size_t f = 0; f < facts.size() && why.empty(); ++f)
      if (all[f][rank] != all[f][0])
        why = "has another " + facts[f].what + " than rank 0" +
              (all[f][0].size() < longest_shown ? ": found " + all[f][rank] + ", there " + all[f][0] : "") +
              "; use the same grit, plugins and files on all hosts\n";
    if (why.empty()) continue;
    agrees = false;
    // A failure of the first rank, which others have had alike, is reported as in one process.
    if (is_first() && failures[0].empty())
      std::cerr << "grit: rank " << rank << " on " << hosts[rank] << ": " << why << std::flush;
  }
  const std::vector<std::byte> of_first = ranks_.all(is_first() ? std::move(given) : std::vector<std::byte>());
  return agrees ? std::optional(of_first) : std::nullopt;
}

unsigned RunRanks::threads(const Options& options) const {
  const unsigned all = options.threads();
  if (!several() || options.given("threads")) return all;
  // Where mpirun has bound this process to some cores, they are its own.
  const bool bound = static_cast<long>(std::thread::hardware_concurrency()) < ::sysconf(_SC_NPROCESSORS_ONLN);
  return bound ? all : std::max(1u, all / processes_here());
}

ExitStatus RunRanks::end(ExitStatus status) {
  if (!several()) return status;
  // The same on all ranks, the first of which may still write results.
  const bool together =
      status == ExitStatus::done || status == ExitStatus::interrupted || status == ExitStatus::numerics;
  constexpr double forever = 1e9, soon = 5;  // s
  if (all_->finish(together ? forever : soon)) return status;
  if (!is_first()) {
    std::cerr.rdbuf(errors_);
    std::cerr << "grit: rank " << ranks_.rank() << " on " << host() << ": " << messages() << std::flush;
  }
  all_->kill_all(static_cast<int>(status));
}

}  // namespace grit
