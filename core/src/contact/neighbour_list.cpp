#include "contact/neighbour_list.hpp"

namespace grit {

void NeighbourList::build(const Bodies& bodies, const NeighbourSearch& search, Team& team) {
  chunk_.resize(chunks_of(bodies.count()));
  team.each(chunk_.size(), [&](std::size_t chunk) {
    chunk_[chunk].clear();
    search.neighbours_of_chunk(bodies, chunk, chunk_[chunk]);
  });
}

void NeighbourList::near(const Bodies& bodies, const ImageShift* shifts, std::size_t chunk, double skin,
                         std::vector<Candidate>& found) const {
  for (const Candidate& pair : chunk_[chunk]) {
    const Quad a = load(bodies.position[pair.a]), b = load(bodies.position[pair.b]);
    const Quad branch = b - a + load(shifts[pair.image].position);
    const double square = branch[0] * branch[0] + branch[1] * branch[1] + branch[2] * branch[2];
    const double touch = a[3] + b[3], reach = touch + skin;
    if (square < reach * reach)
      found.push_back({pair.a, pair.b, pair.image, static_cast<std::uint8_t>(square < touch * touch)});
  }
}

}  // namespace grit
