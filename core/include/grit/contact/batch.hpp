// Interface between the kernel and a contact law: plain arrays, one virtual call per batch.
#pragma once

#include <cstddef>
#include <cstdint>

#include "grit/vec.hpp"

namespace grit {

/// Number of candidate pairs in a block, for any register width.
inline constexpr std::size_t block_size = 8;

/// Result of one contact, 64 bytes: force on b [N] and its normal component (> 0 in compression), moment on b about b's
/// centre [N m] and overlap [m]. Zero if the pair is not in contact. For walls see WallBatch.
struct alignas(64) ContactRow {
  Row force;   // w: normal force
  Row moment;  // w: overlap
};

/// Sums of force [N] and moment [N m] on one body.
struct alignas(64) BodySum {
  Row force, moment;
};

/// Added to the position [m] and velocity [m/s] of b across a periodic boundary. A cell has 27 of them.
struct ImageShift {
  Row position, velocity;
};

/// Energy dissipated by contacts in the last step [J].
struct Losses {
  double friction = 0;
  double rolling = 0;  ///< includes twisting
  double viscosity = 0;
};

/// Candidate pairs of one chunk of bodies. All a's belong to the chunk, and either all or none of the b's, so that no
/// two threads write to the same sum.
struct PairBatch {
  // Bodies by index: centre [m] and radius [m]; velocity [m/s] and 1/mass [1/kg]; spin [rad/s] and 1/inertia.
  const Row* position;
  const Row* velocity;
  const Row* spin;
  // Candidate pairs by index; their number is a multiple of block_size.
  const std::uint32_t* a;
  const std::uint32_t* b;
  const std::uint8_t* image;     ///< index into shifts; null without periodic boundaries
  const std::uint8_t* material;  ///< of each body; null if there is only one
  const ImageShift* shifts;
  std::size_t first_block, last_block;
  std::size_t last_near;     ///< pairs from this block on were separate at the last neighbour search; most are skipped
  std::uint32_t last_body;   ///< of the chunk
  std::uint32_t dummy_body;  ///< index of a dummy body far away from all others: b of padding pairs
  // Bodies needed next, to prefetch.
  const std::uint32_t* next;             ///< indices; null if they are contiguous
  std::uint32_t next_first, next_count;  ///< first index if contiguous; number in both cases
  double dt;                             ///< s
  bool again;                            ///< the contact history already includes this step; compute forces only
  double closing;                        ///< upper bound of the approach of any two bodies, summed over steps [m]
  // Contact history and results.
  double* state;           ///< [block][field][block_size]
  std::uint8_t* touching;  ///< [block], one bit per pair in contact, or within the reach of the law
  std::uint8_t* acting;    ///< out: [block], one bit per pair that overlaps or has a force; null for laws without reach
  float* asleep_until;  ///< [block]: a block without contacts is skipped until `closing` reaches this; null: skip none
  ContactRow* row;      ///< [candidate, from the first of first_block]: result for b; null if b belongs to the chunk
                        ///< too and is summed like a
  BodySum* sum;         ///< [body]; null if sums are not requested
  double largest_overlap;  ///< out: largest overlap over the smaller radius
  Losses* losses;          ///< added to; null if not requested
};

/// One contact of a body with a wall.
struct WallContact {
  Vec3 normal;         ///< unit, from the body into the wall
  Vec3 normal_before;  ///< the same one step ago; equal to normal when the contact is new
  Vec3 velocity;       ///< of the wall's surface at the point [m/s]
  Vec3 spin;           ///< of the wall [rad/s]
  double overlap;      ///< m, > 0; minus the distance of the surfaces within the reach of a law
  std::uint32_t body;  ///< index
  std::uint32_t wall;
  std::uint32_t feature;   ///< SurfaceContact::feature
  std::uint32_t material;  ///< of the wall's surface
};

/// Wall contacts of one chunk of bodies, in the order of the bodies.
struct WallBatch {
  const Row* position;
  const Row* velocity;
  const Row* spin;
  const std::uint8_t* material;  ///< of each body; null if there is only one
  std::size_t count;
  const WallContact* contact;
  double dt;        ///< s
  bool again;       ///< this instant has been evaluated before: contact histories do not advance
  double* state;    ///< [contact][field]
  ContactRow* row;  ///< [contact]: force on the wall and moment about the contact point, which lies on the wall. Shear
                    ///< acts at the sphere's surface, one overlap behind that point; so the moment is that of the law
                    ///< plus overlap · normal × shear
  BodySum* sum;     ///< [body]
  double largest_overlap;
  Losses* losses;  ///< added to; null if not requested
};

}  // namespace grit
