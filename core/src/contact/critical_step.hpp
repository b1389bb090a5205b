// The largest stable time step.
#pragma once

#include <span>
#include <vector>

#include "bodies/bodies.hpp"
#include "contact/contact_table.hpp"
#include "contact/demand.hpp"
#include "contact/halo.hpp"
#include "contact/wall_contacts.hpp"
#include "grit/contact/contact_law.hpp"

namespace grit {

/// Demand of bodies before their first contacts: each has one with a body like itself.
Demand demand_without_contacts(const Bodies& bodies, const ContactLaw& law);

/// Upper bounds of the demands of contacts on bodies, with walls held. Q is the largest eigenvalue of the springs of
/// all contacts on one body, per mass and moment of inertia, with the other bodies held. The energy of a contact is at
/// most 1 + Q_b/Q_a times that with b held, plus 1 + Q_a/Q_b times that with a held; so ω_max² is at most the maximum
/// over the contacts of Q_a + Q_b. The same with Q the sum over a body's contacts of max(k_n/m, k_s (1/m + r²/I) +
/// k_r/I, k_t/I) is the element bound of Irons and Treharne, doi 10.1002/eqe.4290010107; the smaller one is taken. The
/// damping rate is at most the largest eigenvalue over the bodies of Σ c (1/m_a + 1/m_b) n n. Pairs nearer than `near`,
/// plus the reach of the law, count as contacts. Every body has at least one contact with a body of its own size with
/// the overlap `overlap`; the shortest impact is that of this contact, as none with a larger body is shorter.
///
/// Contacts form and open where bodies move. A chunk is evaluated again, independently of others, when its bodies have
/// moved far enough, or walls with bodies of it near them: the further, the longer its own critical step is than that
/// of all, and the less a new contact demands. Where stiffness grows with overlap, also when the springs of one of its
/// bodies have stiffened as far.
///
/// Contacts with several facets of a mesh may begin in one step, as in a ring of facets. If they stop a body sooner
/// than one like itself would, all within `ahead` count, and their impact limits the step.
///
/// The contacts of a clump have arms. The demand of a spring on it is bounded by those of its components along and
/// across the normal, each with the smallest effective mass there. Its dashpots are summed regardless of their
/// directions.
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
    double ahead;    ///< distance of facets that bodies may reach before the next evaluation [m]
    double overlap;  ///< minimum overlap with a body of the same size, over its radius
    Halo& halo;
    Ranks& ranks;
  };
  /// Evaluates all chunks.
  Demand find(const Instant& at, Team& team);
  /// Instead of an evaluation after a neighbour search: as if there were no contacts.
  void forget(std::size_t bodies);
  /// After an evaluation of the chunk's contacts. `overlap`: the deepest over the smaller radius.
  void touched(std::size_t chunk, double overlap) {
    Chunk& own = chunk_[chunk];
    own.overlap = overlap, own.least_overlap = std::min(own.least_overlap, overlap);
  }
  /// Changes since its last evaluation that make a chunk due.
  struct Change {
    double way;      ///< displacement of bodies of the chunk with the shortest step, or of walls near them [m]
    double overlap;  ///< deepest overlap over the smaller radius that may matter; infinite where springs do not stiffen
  };
  /// Own chunks whose bodies have perhaps not moved as far as bounds say, and have not been evaluated since the search.
  std::vector<std::size_t> in_doubt(const WallContacts& walls, const Skins& skins, const Change& change,
                                    const Ranks& ranks) const;
  /// Evaluates chunks with such a change, or with new candidates at walls.
  Demand renew(const Instant& at, const Change& change, Team& team);
  /// Whether there are such own chunks.
  bool due(const WallContacts& walls, const Skins& skins, const Change& change, const Ranks& ranks) const;
  /// Restored after the pairs.
  void serialize(SharedArchive& archive, const ContactTable& pairs);
  /// Throws Error unless restored values fit so many bodies.
  void check_restored(std::size_t bodies) const;

 private:
  struct Chunk {
    Demand alone;                     ///< largest of bodies with one contact, with a body like themselves
    Demand fresh;                     ///< largest of a new contact on one body
    Demand demand;                    ///< largest of single bodies
    Demand together;                  ///< largest of its pairs, and of clumps with a body in it
    bool at_walls = false;            ///< whether it had candidates at walls, whose contacts may have opened since
    double approached = 0;            ///< Skins::across() at its last evaluation [m]
    double walked = 0;                ///< displacement bound at its last evaluation [m]
    double walls_walked = 0;          ///< the same of walls
    double overlap = 0;               ///< deepest overlap over the smaller radius
    double least_overlap = 0;         ///< least value of it since its last evaluation or comparison of stiffness()
    double stiffness = 0;             ///< stiffness() at its last evaluation
    std::vector<std::uint32_t> near;  ///< candidates that count as contacts
    Demand all() const { return larger(demand, together); }
    bool evaluated_at_search() const { return approached == 0 && walked == 0; }
    /// Without `near`.
    void serialize(Archive& archive) {
      archive(alone, fresh, demand, together, at_walls, approached, walked, walls_walked, overlap, least_overlap,
              stiffness);
    }
  };
  /// The factor by which demands of a chunk's contacts may grow before its critical step is the shortest.
  double slack(const Chunk& chunk) const;
  /// The displacement after which a chunk is due, over that of the chunk with the shortest step.
  double patience(const Chunk& chunk) const;
  /// Whether its bodies have moved far enough, or walls near them.
  bool moved(std::size_t chunk, const WallContacts& walls, const Skins& skins, double way) const;
  bool bodies_moved(std::size_t chunk, const WallContacts& walls, const Skins& skins, double way) const;
  /// Whether overlaps have grown enough to compare the stiffness of springs.
  bool pressed(std::size_t chunk, double overlap) const;
  /// The largest sum over the contacts of one body of √(r δ)/m, r the reduced radius and δ the overlap [m/kg]: Hertzian
  /// springs are stiffer in proportion.
  double stiffness(std::size_t chunk, const Instant& at) const;
  /// Evaluates own chunks, and completes what other ranks need of them.
  Demand evaluate(const std::vector<std::size_t>& chunks, const Instant& at, Team& team);
  void evaluate_alone(std::size_t chunk, const Instant& at);
  /// `closings`: ContactTable::closings_across().
  void sum(std::size_t chunk, const Instant& at, std::span<const double> closings);
  /// The demand of a clump is the sum over its bodies.
  void gather(std::size_t clump, const Clumps& clumps);
  void compare(std::size_t chunk, const Instant& at);

  std::vector<double> demand_, least_;  // by body [1/s²]: of all contacts; of one with a body of its size
  struct OfClumps {
    std::vector<double> springs;   // by body, 1/s²
    std::vector<double> dashpots;  // by body, 1/s: of contacts of which a clump is part
    std::vector<double> dashpot;   // by clump
  } clumps_;
  std::vector<Chunk> chunk_;
  double shortest_ = 0;  // critical step of all chunks at the last evaluation [s]
};

}  // namespace grit
