// Contacts of bodies with walls, and their histories.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bodies/bodies.hpp"
#include "bodies/reordering.hpp"
#include "contact/skins.hpp"
#include "grit/archive.hpp"
#include "grit/contact/contact_law.hpp"
#include "grit/geometry.hpp"
#include "ranks/ranks.hpp"
#include "threads/team.hpp"

namespace grit {

/// A wall as the contact pass needs it.
struct WallSurface {
  std::shared_ptr<const Geometry> geometry;
  std::uint32_t material = 0;
  bool gives_way = false;    ///< moved by contact forces (servo, free), so that its stiffness is needed
  bool free = false;         ///< moved by contact forces only
  std::vector<bool> groups;  ///< of bodies on which the wall acts; empty: all
  Pose pose;
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();                  ///< in the last step, as those of bodies
  bool surface_moves = false;                                         ///< relative to the wall
  Vec3 surface_velocity = Vec3::Zero(), surface_spin = Vec3::Zero();  ///< the same of the surface relative to the wall
  Vec3 free_axis = Vec3::Zero();                                      ///< unit, of free rotation; zero: none

  Vec3 period = Vec3::Zero();  ///< along axes on which the wall extends over exactly one period [m]; 0 along others
  std::array<const Geometry*, 3> uniform{};  ///< geometry that was found to be uniform along each axis

  /// The position at which to ask for contacts with a body: moved by whole periods into the extent of the wall.
  Vec3 within(Vec3 position) const {
    for (int k = 0; k < 3; ++k)
      if (period[k] > 0) {
        const double low = geometry->bounds().low[k] + pose.shift[k];
        position[k] -= period[k] * std::floor((position[k] - low) / period[k]);
      }
    return position;
  }
  bool acts_on(std::span<const std::uint16_t> group, std::size_t body) const {
    return groups.empty() || groups[group[body]];
  }
  Vec3 reference() const { return pose.about + pose.shift; }
  Vec3 point_velocity(const Vec3& point) const { return velocity + spin.cross(point - reference()); }
};

template <>
inline constexpr bool plain_numbers<WallContact> = true;
template <>
inline constexpr bool plain_numbers<ContactRow> = true;

/// Sums of the contacts of one wall.
struct WallLoad {
  Vec3 force = Vec3::Zero();   ///< N
  Vec3 moment = Vec3::Zero();  ///< N m, about the wall's reference point
  double stiffness = 0;        ///< sum of normal stiffnesses [N/m]
  std::uint32_t contacts = 0;  ///< that overlap or have a force
  double spring = 0;           ///< sum of stiffnesses, each in its stiffest direction [N/m]
  double dashpot = 0;          ///< the same of dashpots [N s/m]
  std::uint32_t near = 0;      ///< bodies that may come into contact before the next search
  /// Shear forces and their moments with those of rolling and twisting, of a wall whose surface moves [N, N m].
  Vec3 surface_force = Vec3::Zero(), surface_moment = Vec3::Zero();
  double turning_spring = 0;   ///< upper bound of the stiffness against free rotation [N m/rad]
  double turning_dashpot = 0;  ///< the same of dashpots [N m s/rad]
};

/// Contacts are sorted by the chunk of their body, then by wall, body and feature. This is the order in which they are
/// found, so that histories are matched by walking along two sorted lists.
class WallContacts {
 public:
  /// Finds which bodies may come into contact with which walls while no displacement exceeds its skin. `group`: of each
  /// body; may be empty if walls act on all groups. `now`: of the bodies in contact of which this rank has had the
  /// chunks.
  void rebuild(const Bodies& bodies, std::span<const std::uint16_t> group, std::span<const WallSurface> walls,
               const Skins& skins, std::span<const StateField> fields, const Renumbering& now, Ranks& ranks,
               Team& team);
  /// Of the contacts of all ranks, which it has, a rank continues those of its own chunks.
  void share(const Ranks& ranks) { cuts_ = ranks.cuts(), whole_ = !ranks.several(); }
  /// Completes the contacts of all ranks, with their forces.
  void complete(Ranks& ranks);
  /// Finds the candidates of one chunk again, of the same bodies and walls. Contacts and their histories stay.
  void find_candidates(std::size_t chunk, const Bodies& bodies, std::span<const std::uint16_t> group,
                       std::span<const WallSurface> walls, const Skins& skins);
  /// Whether any body of a chunk may come into contact with a wall before the next search.
  bool has_candidates(std::size_t chunk) const { return !chunks_[chunk].candidate.empty(); }
  void set_fields(std::span<const StateField> fields);
  static constexpr std::uint32_t no_wall = ~0u;
  /// Walls get new indices, before the next rebuild(). Contacts of walls that become no_wall are removed.
  void renumber_walls(std::span<const std::uint32_t> now);

  /// Finds and evaluates the contacts of one chunk; adds to the sums of its bodies, and to `losses` unless it is
  /// null. `again` if this instant has been evaluated before: forces are the same up to rounding, and histories do not
  /// advance. Returns the largest overlap over a radius.
  double evaluate(std::size_t chunk, const ContactLaw& law, const Bodies& bodies, bool one_material,
                  std::span<const WallSurface> walls, double dt, bool again, BodySum* sum, Losses* losses);
  /// Bodies have grown by `factor` to their present size; increases the overlaps accordingly.
  void grow(const Bodies& bodies, double factor);
  /// Loads on all walls, summed chunk by chunk over all ranks.
  void loads(std::span<WallLoad> loads, Ranks& ranks) const;
  /// Estimate of the normal force on a wall [N] at the pose `there` with `velocity` [m/s] and bodies as they are now:
  /// of springs, linear with their present stiffness, and of dashpots, without attraction. Considers `all` bodies, or
  /// only those that it may come into contact with before the next search.
  double force_ahead(std::size_t wall, const WallSurface& surface, const Pose& there, const Vec3& velocity,
                     const ContactLaw& law, const Bodies& bodies, std::span<const std::uint16_t> group, bool all,
                     Ranks& ranks) const;

  struct Touching {
    const WallContact* contact;
    const ContactRow* row;
    std::span<const double> state;
    bool acts() const { return WallContacts::acts(*contact, *row); }
  };
  /// All contacts, in order.
  template <class Use>
  void each(Use use) const {
    for (std::size_t c = 0; c < chunks_.size(); ++c) each(c, use);
  }
  /// Contacts of one chunk.
  template <class Use>
  void each(std::size_t c, Use use) const {
    const Chunk& chunk = chunks_[c];
    for (std::size_t i = 0; i < chunk.contact.size(); ++i)
      use(Touching{&chunk.contact[i], &chunk.row[i], {chunk.state.data() + i * fields_.size(), fields_.size()}});
  }
  /// Contacts of a chunk's bodies if their radii were larger by `near` [m], at this instant; overlaps include `near`.
  template <class Use>
  void each_near(std::size_t c, const Bodies& bodies, std::span<const WallSurface> walls, double near, Use use) const {
    for (std::size_t w = 0; w < walls.size(); ++w)
      each_near(c, bodies, walls[w], w, near, [&](const SurfaceContact& contact) { use(contact, walls[w]); });
  }
  /// Those with one wall, whose index is `w`.
  template <class Use>
  void each_near(std::size_t c, const Bodies& bodies, const WallSurface& wall, std::size_t w, double near,
                 Use use) const {
    const Chunk& chunk = chunks_[c];
    std::vector<Sphere> spheres;
    std::vector<SurfaceContact> found;
    for (std::uint32_t n = chunk.candidate_start[w]; n < chunk.candidate_start[w + 1]; ++n) {
      const Row& x = bodies.position[chunk.candidate[n]];
      spheres.push_back({wall.within({x.x, x.y, x.z}), x.w + near, chunk.candidate[n]});
    }
    if (!spheres.empty()) wall.geometry->find_contacts(wall.pose, spheres, found);
    for (const SurfaceContact& contact : found) use(contact);
  }
  /// Number of contacts that overlap or have a force.
  std::size_t touching_count() const;
  void serialize(SharedArchive& archive) {
    // Each chunk has at least the lengths of its lists.
    chunks_.resize(archive.length(chunks_.size(), 5 * sizeof(std::uint64_t)));
    archive.each_chunk(chunks_.size(), [this](Archive& own, std::size_t chunk) { own(chunks_[chunk]); });
    if (archive.restoring()) whole_ = true;
  }
  /// Throws Error unless restored contacts fit so many bodies, walls and materials.
  void check_restored(std::size_t bodies, std::size_t walls, std::size_t materials) const;

 private:
  struct Chunk {
    std::vector<std::uint32_t> candidate_start;  // by wall
    std::vector<std::uint32_t> candidate;        // bodies
    std::vector<WallContact> contact;
    std::vector<std::uint8_t> crossed;  // by contact: whether it continues one of another wall since the last step
    std::vector<double> state;
    std::vector<ContactRow> row;
    std::vector<WallLoad> load;  // by wall

    void serialize(Archive& archive) {
      archive(candidate_start, candidate, contact, crossed, state);
      row.resize(contact.size());
    }
  };
  /// Whether a contact overlaps or has a force; otherwise it is only within the reach of the law.
  static bool acts(const WallContact& contact, const ContactRow& row) {
    return contact.overlap >= 0 || row.force.w != 0;
  }
  /// Buffers of evaluate(). One for all chunks of a thread, so that it stays in the cache.
  struct Workspace {
    std::vector<Sphere> spheres;
    std::vector<SurfaceContact> found;
    std::vector<WallContact> before;           // contacts of the last step, or of the last evaluation of this one
    std::vector<std::uint8_t> crossed_before;  // by these contacts
    std::vector<double> state_before;
    std::vector<std::uint32_t> same_body_before, fresh, gone;  // indices of contacts
    std::vector<bool> hide;
  };
  /// Removes contacts at edges where the surface continues on another wall that the body touches: edges where coplanar
  /// faces meet, and shared edges, count once. Across a gap each face counts, so that the force is continuous there.
  static void leave_out_hidden(Chunk& chunk, Workspace& work, const Bodies& bodies, std::span<const WallSurface> walls);
  /// Whether the wall of the deeper contact also covers the point of the other one.
  static bool hidden(const WallContact& lesser, const WallContact& deeper, const Row& body,
                     std::span<const WallSurface> walls, Workspace& work);
  /// Adds the velocities of surfaces that move relative to their walls.
  static void carry_along(Chunk& chunk, const Bodies& bodies, std::span<const WallSurface> walls);
  /// Copies histories from the contacts of the last step to those of this one. work.gone lists those that ended.
  void carry_histories(Chunk& chunk, Workspace& work, const Bodies& bodies, double dt, bool again) const;
  /// Books the elastic energy of ended contacts as dissipated, and that of bonds that broke.
  void part(const Workspace& work, const ContactLaw& law, const Bodies& bodies, Losses& losses) const;

  /// All contacts of some chunks, one after the other.
  struct Contacts {
    std::vector<WallContact> contact;
    std::vector<std::uint8_t> crossed;
    std::vector<double> state;
  };
  /// Takes the contacts of former chunks out of these; with several ranks, those that belong to chunks of this one now.
  Contacts taken(const Renumbering& now, Ranks& ranks);
  /// Puts them into the chunks of their bodies.
  void place(const Contacts& all, std::size_t bodies);

  std::vector<Chunk> chunks_;
  std::vector<StateField> fields_;
  Cuts cuts_;          // which rank had which chunk at the last rebuild
  bool whole_ = true;  // whether this rank has the contacts of all chunks
};

}  // namespace grit
