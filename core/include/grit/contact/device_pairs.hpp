// The contacts of one step body by body, for devices with many threads.
#pragma once

#include <cstddef>
#include <cstdint>

#include "grit/contact/batch.hpp"

namespace grit {

/// A body near another one, in the list of the latter.
struct DeviceNeighbour {
  std::uint32_t body;   ///< index
  std::uint16_t image;  ///< index into DevicePairs::shifts, of b
  std::uint16_t is_a;   ///< 1: this body is a of the pair, and the owner of the list is b; 0: the reverse
};

/// Plain arrays in the memory of a device. Every pair is in the lists of both bodies, with its contact history, so that
/// no two threads write to the same place. Both evaluate it in the same order of a and b, and find the same bits.
struct DevicePairs {
  // Bodies by index, as in PairBatch.
  const Row* position;
  const Row* velocity;
  const Row* spin;
  const std::uint8_t* material;  ///< of each body; null if there is only one
  const ImageShift* shifts;      ///< null without periodic boundaries
  // Lists: those of body i are the entries from first[i] to before first[i + 1].
  const std::uint32_t* first;
  const DeviceNeighbour* neighbour;
  std::uint8_t* contact;  ///< [entry]: in_contact, and is_acting for laws with reach
  double* state;          ///< [field][entry]: contact history
  std::size_t entries;
  double dt;     ///< s
  bool again;    ///< the contact history already includes this step
  BodySum* sum;  ///< [body], out; force.w: the largest overlap over the smaller radius

  static constexpr std::uint8_t in_contact = 1, is_acting = 2;
};

}  // namespace grit
