// Linear force chains: grains that bear more than the mean and are in line with the next. See README.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "grit/archive.hpp"
#include "grit/world.hpp"

namespace grit {

/// The chains of an instant.
struct LinearChains {
  /// By chain, its grains from one end to the other; of each the least id of its bodies.
  std::vector<std::vector<std::uint32_t>> grains;
  /// The chain, from 1, that each contact of World::contacts() is a link of; 0 for none.
  std::vector<std::uint32_t> of_contact;
  double mean_major_stress = 0;  ///< of all grains, positive in compression [Pa]; 0 without grains

  void serialize(Archive& archive) { archive(grains, of_contact, mean_major_stress); }
};

/// `angle` [rad]: largest one between the line of two centres and the direction of either grain's major stress.
LinearChains linear_chains(const World& world, double angle);

/// How the chains of one instant go on in those of a later one.
struct Turnover {
  std::size_t born = 0, died = 0;
};
Turnover turnover(const LinearChains& before, const LinearChains& after);

}  // namespace grit
