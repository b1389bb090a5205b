// The largest stable time step.
#pragma once

#include "bodies/bodies.hpp"
#include "contact/contact_table.hpp"
#include "contact/demand.hpp"
#include "contact/wall_contacts.hpp"
#include "grit/contact/contact_law.hpp"

namespace grit {

/// What contacts ask of the bodies, walls held. Each body's mass and inertia are shared out
/// among its contacts in proportion to what they ask for; then ω_max² is at most the largest over the contacts of
/// Q_a + Q_b, with Q the sum over a body's contacts of max(k_n/m, k_s (1/m + r²/I) + k_r/I, k_t/I) (the element bound
/// of Irons and Treharne, doi 10.1002/eqe.4290010107; Gershgorin's rows give the same without rotations). Dashpots add
/// up in their directions: the damping rate is at most the largest over the bodies of |Σ c (1/m_a + 1/m_b) n n|. Pairs
/// nearer than `near` count as touching, and every body has at least one contact with its like, `overlap` deep: the
/// shortest impact is taken from that one, as none with a larger body is shorter.
///
/// Contacts form and part where bodies move, so that chunks are looked at anew when their bodies have gone far enough,
/// each by itself.
///
/// A clump is a body whose contacts are at the ends of arms: what a spring asks of it is bounded by what its parts
/// along and across the normal ask by themselves, each by the mass that a push there meets at least. Dashpots are added
/// up whatever their directions.
class CriticalStep {
 public:
  struct Instant {
    const Bodies& bodies;
    const ContactTable& pairs;
    const WallContacts& walls;
    std::span<const WallSurface> surfaces;
    const ContactLaw& law;
    const ImageShift* shifts;
    const Skins& skins;
    double near;     ///< m
    double overlap;  ///< that a body is reckoned to have with one of its like at least, over its radius
  };
  /// Looks at all chunks.
  Demand find(const Instant& at, Team& team);
  /// Looks at those of which something has gone further than `way` [m] since they were looked at.
  Demand renew(const Instant& at, double way, Team& team);
  /// Whether there are any.
  bool due(const Skins& skins, double way) const;

  void remember(Memory& memory) {
    memory(demand_, clumps_.springs, clumps_.least, clumps_.dashpots, clumps_.dashpot, chunk_, walls_walked_);
  }

 private:
  struct Chunk {
    Demand demand;                    ///< the largest of its bodies by themselves
    Demand together;                  ///< of its pairs, and of clumps that it has a body of
    double walked = 0;                ///< when it was looked at [m]
    std::vector<std::uint32_t> near;  ///< candidates that count as touching
    void remember(Memory& memory) { memory(demand, together, walked, near); }
  };
  Demand look(const std::vector<std::size_t>& chunks, const Instant& at, Team& team);
  void ask(std::size_t chunk, const Instant& at);
  /// A clump has the demands of all its bodies.
  void gather(std::size_t clump, const Clumps& clumps);
  void compare(std::size_t chunk, const Instant& at);

  std::vector<double> demand_;  // by body, 1/s²
  struct OfClumps {
    std::vector<double> springs, least;  // by body, 1/s²: of its contacts; of one with its like
    std::vector<double> dashpots;        // by body, 1/s: of contacts of which a clump is part
    std::vector<double> dashpot;         // by clump
  } clumps_;
  std::vector<Chunk> chunk_;
  double walls_walked_ = 0;
};

}  // namespace grit
