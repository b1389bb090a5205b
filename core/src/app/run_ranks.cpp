#include "app/run_ranks.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/dll/shared_library.hpp>
#include <boost/preprocessor/stringize.hpp>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <map>
#include <thread>

#include "grit/error.hpp"
#include "grit/toolkit/text_file.hpp"
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

/// Open MPI ends the process where Slurm has started it without PMIx, MPICH where without PMI.
void refuse_slurm_without_pmi() {
  const bool known = std::getenv("PMIX_NAMESPACE") != nullptr || std::getenv("PMI_RANK") != nullptr ||
                     std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr;
  if (known) return;
  throw Error("started as one of " + std::to_string(started_processes()) +
              " processes by Slurm, which does not connect them; use srun --mpi=pmix, or mpirun");
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
  constexpr const char* entry = BOOST_PP_STRINGIZE(GRIT_MPI_ENTRY);
  if (!library.has(entry)) throw Error(file.string() + " is of another build of grit; build or install both together");
  return library.get<Communicator*()>(entry)();
}

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

constexpr char unit_separator = '\x1f', record_separator = '\x1e';

/// Facts as one text.
std::string joined(const std::vector<RankFact>& facts) {
  std::string text;
  for (const RankFact& fact : facts) text += fact.what + unit_separator + fact.text + record_separator;
  return text;
}

std::vector<std::string> parts_of(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

std::map<std::string, std::string> facts_of(const std::string& text) {
  std::map<std::string, std::string> facts;
  for (const std::string& fact : parts_of(text, record_separator)) {
    const std::size_t end = fact.find(unit_separator);
    facts[fact.substr(0, end)] = fact.substr(end + 1);
  }
  return facts;
}

/// The first lines that only one of two texts has.
std::string lines_beyond(const std::string& text, const std::string& other) {
  constexpr std::size_t most = 3, longest = 200;
  const std::vector<std::string> known = parts_of(other, '\n');
  std::string found;
  std::size_t count = 0;
  for (const std::string& line : parts_of(text, '\n')) {
    if (std::ranges::find(known, line) != known.end()) continue;
    if (++count > most) return found + " …";
    // As in JSON: indented, with a comma.
    const std::size_t first = std::min(line.size(), line.find_first_not_of(' ')),
                      last = line.size() - line.ends_with(',');
    found += (found.empty() ? "" : ", ") + visible_text(line.substr(first, std::max(first, last) - first), longest);
  }
  return found.empty() ? "nothing" : found;
}

/// In which facts a rank differs from the first one; empty if in none.
std::string differences(const std::map<std::string, std::string>& own,
                        const std::map<std::string, std::string>& first) {
  std::string text;
  for (const auto& [what, expected] : first) {
    const auto found = own.find(what);
    const std::string there = found != own.end() ? found->second : "";
    if (there != expected)
      text += "  " + what + ": found " + lines_beyond(there, expected) + "; rank 0 has " +
              lines_beyond(expected, there) + '\n';
  }
  return text.empty() ? "" : "differs from rank 0; use the same grit, plugins and files on all hosts\n" + text;
}

}  // namespace

RunRanks::RunRanks() {
  if (started_processes() < 2) return;
  refuse_slurm_without_pmi();
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
  const std::vector<std::string> hosts = texts(ranks_, host()), failures = texts(ranks_, failure),
                                 all = texts(ranks_, joined(facts));
  bool agrees = true;
  for (unsigned rank = 0; rank < count(); ++rank) {
    std::string why = failures[rank].starts_with("grit: ") ? failures[rank].substr(6) : failures[rank];
    if (why.empty() && failures[0].empty()) why = differences(facts_of(all[rank]), facts_of(all[0]));
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
