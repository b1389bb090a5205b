#include "kernel/sharing.hpp"

#include "contact/halo.hpp"
#include "ranks/ranks.hpp"

namespace grit {
namespace {

Traffic sum(const Traffic& a, double factor, const Traffic& b) {
  return {a.messages + factor * b.messages, a.bytes + factor * b.bytes, a.gathers + factor * b.gathers,
          a.gathered + factor * b.gathered, a.seconds + factor * b.seconds};
}

Traffic mean(const Traffic& all, double count) { return count > 0 ? sum({}, 1 / count, all) : Traffic{}; }

}  // namespace

void SharingRecord::steps_end(Ranks& ranks, std::uint64_t step) {
  if (!ranks.several()) return;
  // Before the first search, the run was set up.
  if (searches_ > 0) {
    for (const Traffic& of_rank : ranks.each(sum(ranks.traffic(), -1, before_))) in_steps_ = sum(in_steps_, 1, of_rank);
    steps_ += static_cast<double>(ranks.count()) * static_cast<double>(step - step_);
  }
  step_ = step, before_ = ranks.traffic();
}

void SharingRecord::search_ends(Ranks& ranks, const Halo& halo, std::size_t bodies) {
  if (!ranks.several()) return;
  struct Share {
    double neighbours, pairs, shared_pairs, independent_pairs;
    Traffic search;
  };
  const Share own{static_cast<double>(halo.bodies()), static_cast<double>(halo.pairs()),
                  static_cast<double>(halo.shared_pairs()), static_cast<double>(halo.independent_pairs()),
                  sum(ranks.traffic(), -1, before_)};
  for (const Share& of_rank : ranks.each(own)) {
    neighbours_ += of_rank.neighbours, pairs_ += of_rank.pairs, shared_pairs_ += of_rank.shared_pairs;
    independent_pairs_ += of_rank.independent_pairs;
    in_searches_ = sum(in_searches_, 1, of_rank.search);
  }
  searches_ += ranks.count(), bodies_ += static_cast<double>(bodies);
  before_ = ranks.traffic();
}

Sharing SharingRecord::sharing(double imbalance) const {
  // Each shared pair is counted on two ranks.
  const double distinct = pairs_ - 0.5 * shared_pairs_;
  return {imbalance,
          bodies_ > 0 ? neighbours_ / bodies_ : 0,
          distinct > 0 ? 0.5 * shared_pairs_ / distinct : 0,
          pairs_ > 0 ? independent_pairs_ / pairs_ : 0,
          mean(in_steps_, steps_),
          mean(in_searches_, searches_)};
}

}  // namespace grit
