// What passes between the kernel and a contact law: plain arrays, one virtual call a batch.
#pragma once

#include <cstddef>
#include <cstdint>

#include "grit/vec.hpp"

namespace grit {

/// Candidate pairs are stored in blocks of this many, whatever the width of the machine's registers.
inline constexpr std::size_t block_size = 8;

/// What one contact does, 64 bytes: force on b [N] and its normal part (> 0 in compression), moment on b about b's
/// centre [N m] and the overlap [m]. Zero where the pair does not touch. Of a wall: see WallBatch.
struct alignas(64) ContactRow {
  Row force;   // w: normal force
  Row moment;  // w: overlap
};

/// Force [N] and moment [N m] gathered for one body.
struct alignas(64) BodySum {
  Row force, moment;
};

/// What crossing a periodic boundary adds to the position [m] and velocity [m/s] of b. A cell has 27 of them.
struct ImageShift {
  Row position, velocity;
};

/// What contacts have dissipated in the step that led here [J].
struct Losses {
  double friction = 0;
  double rolling = 0;  ///< with twisting
  double viscosity = 0;
};

/// Candidate pairs of one chunk of bodies. All a's belong to it, and all b's or none, so no two threads write one sum.
struct PairBatch {
  // bodies, by index: centre [m] and radius [m]; velocity [m/s] and 1/mass [1/kg]; spin [rad/s] and 1/inertia
  const Row* position;
  const Row* velocity;
  const Row* spin;
  // candidates, by index, a multiple of block_size
  const std::uint32_t* a;
  const std::uint32_t* b;
  const std::uint8_t* image;     ///< index into shifts; null without periodic boundaries
  const std::uint8_t* material;  ///< of each body; null when all are of one material
  const ImageShift* shifts;
  std::size_t first_block, last_block;
  std::size_t last_near;    ///< from this block on pairs were apart when they were filed: most are asleep
  std::uint32_t last_body;  ///< of the chunk
  std::uint32_t nobody;     ///< index of a body that is far away from all others; padding has it as b
  // bodies that will be wanted next, for the processor to fetch meanwhile
  const std::uint32_t* next;             ///< their indices; null where they lie one behind the other
  std::uint32_t next_first, next_count;  ///< where they do: from which on; how many in either case
  double dt;                             ///< s
  bool again;                            ///< the step is in the memory already: forces alone are wanted
  double closing;                        ///< by how much two bodies can have come closer at most, a sum over steps [m]
  // memory and results
  double* state;           ///< [block][field][block_size]
  std::uint8_t* touching;  ///< [block], a bit a lane
  float* asleep_until;     ///< [block]: where none touches, none will before `closing` is as large; null: look at all
  ContactRow* row;         ///< [candidate, from the first of first_block]: what it does to b; null where b is of the
                           ///< chunk too, and has its sum as a has
  BodySum* sum;            ///< [body]; null where nobody asks for sums
  double largest_overlap;  ///< out: largest overlap over the smaller radius
  Losses* losses;          ///< added to; null where nobody asks
};

/// One point where a body touches a wall.
struct WallTouch {
  Vec3 normal;         ///< unit, from the body into the wall
  Vec3 normal_before;  ///< the same one step ago; equal to normal when the touch is new
  Vec3 velocity;       ///< of the wall's surface at the point [m/s]
  Vec3 spin;           ///< of the wall [rad/s]
  double overlap;      ///< m, > 0
  std::uint32_t body;  ///< index
  std::uint32_t wall;
  std::uint32_t feature;   ///< stable id of what is touched
  std::uint32_t material;  ///< of the wall's surface
};

/// Touches of one chunk of bodies, in the order of their bodies.
struct WallBatch {
  const Row* position;
  const Row* velocity;
  const Row* spin;
  const std::uint8_t* material;  ///< of each body; null when all are of one material
  std::size_t count;
  const WallTouch* touch;
  double dt;
  double* state;    ///< [touch][field]
  ContactRow* row;  ///< [touch]: force on the wall and moment about the point of contact, which lies on the wall. Shear
                    ///< acts at the sphere's surface, the overlap behind it: normal force alone has no moment there,
                    ///< shear has overlap · normal × shear beside what the law says
  BodySum* sum;     ///< [body]
  double largest_overlap;
  Losses* losses;  ///< added to; null where nobody asks
};

}  // namespace grit
