#include "ranks/ranks.hpp"

#include <numeric>
#include <stdexcept>

namespace grit {

std::vector<std::size_t> Ranks::starts(std::size_t size, std::size_t per_chunk, std::size_t count) const {
  std::vector<std::size_t> starts;
  for (unsigned r = 0; r < this->count(); ++r) starts.push_back(std::min(cuts_.first(r) * per_chunk, count) * size);
  starts.push_back(count * size);
  return starts;
}

void Ranks::refuse_alone() const {
  if (alone_ > 0) throw std::logic_error("one rank alone needs values of the others");
}

std::vector<std::size_t> Ranks::one_each(std::size_t size) const {
  std::vector<std::size_t> starts;
  for (unsigned r = 0; r <= count(); ++r) starts.push_back(r * size);
  return starts;
}

std::vector<std::size_t> Ranks::starts_of(std::size_t own) {
  const std::vector<std::size_t> sizes = each(own);
  std::vector<std::size_t> starts(count() + 1, 0);
  std::partial_sum(sizes.begin(), sizes.end(), starts.begin() + 1);
  return starts;
}

void Ranks::send_piece(unsigned to, std::span<const std::byte> piece) {
  const std::size_t length = piece.size();
  std::vector<Communicator::Message> sent;
  const std::span lengths(&length, 1);
  add(sent, to, lengths);
  exchange(sent, {});
  sent.clear();
  add(sent, to, piece);
  exchange(sent, {});
}

std::vector<std::byte> Ranks::receive_piece(unsigned from) {
  std::array<std::size_t, 1> length{};
  std::vector<Communicator::Message> received;
  add(received, from, length);
  exchange({}, received);
  std::vector<std::byte> piece(length.front());
  received.clear();
  add(received, from, piece);
  exchange({}, received);
  return piece;
}

}  // namespace grit
