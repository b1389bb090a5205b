// Contents of the parts of averaging cells: volumes of solids, and contact forces.
#pragma once

#include "grit/toolkit/averaging_cells.hpp"
#include "grit/world.hpp"

namespace grit {

/// Calls visit(part, volume, body) with the volume [m³] of each body in each part that it may intersect. Overlaps at
/// contacts count twice, those within a clump once.
template <class Visit>
void share_out_solids(const World& world, const AveragingCells& cells, const Visit& visit) {
  const auto positions = world.positions();
  const auto shares = world.volume_fractions();
  for (std::size_t i = 0; i < positions.size(); ++i)
    cells.share_out_sphere(xyz(positions[i]), positions[i].w, [&](std::size_t part, double volume) {
      visit(part, shares.empty() ? volume : shares[i] * volume, i);
    });
}

/// The piece of a contact's branch in one part.
struct Piece {
  const Contact& contact;
  const Branch& branch;
  double from, to;  ///< 0 at the start of the branch, 1 at its end
  Mat3 load;        ///< force ⊗ branch [N m]; the sum over a volume is the Love–Weber stress times that volume
};

/// Calls visit(part, piece) for each piece of each contact's branch.
template <class Visit>
void share_out_contacts(const World& world, const AveragingCells& cells, const Visit& visit) {
  for (const Contact& contact : world.contacts()) {
    const Branch branch = branch_of(world, contact);
    const Mat3 load = contact.force * branch.vector.transpose();
    cells.share_out_branch(branch, [&](std::size_t part, double from, double to) {
      visit(part, Piece{contact, branch, from, to, (to - from) * load});
    });
  }
}

}  // namespace grit
