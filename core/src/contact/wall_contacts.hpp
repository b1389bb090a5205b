// Touches of bodies and walls, and what they remember.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bodies/bodies.hpp"
#include "contact/chunks.hpp"
#include "contact/skins.hpp"
#include "grit/contact/contact_law.hpp"
#include "grit/geometry.hpp"
#include "grit/memory.hpp"

namespace grit {

/// A wall as the contact pass needs it.
struct WallSurface {
  std::shared_ptr<const Geometry> geometry;
  std::uint32_t material = 0;
  bool gives_way = false;  ///< moved by what presses on it, which asks how stiffly
  bool free = false;       ///< moved by nothing else
  Pose pose;
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();  ///< of the last step, like those of the bodies

  Vec3 reference() const { return pose.about + pose.shift; }
  Vec3 point_velocity(const Vec3& point) const { return velocity + spin.cross(point - reference()); }
};

template <>
inline constexpr bool plain_numbers<WallTouch> = true;

/// What the bodies do to one wall.
struct WallLoad {
  Vec3 force = Vec3::Zero();   ///< N
  Vec3 moment = Vec3::Zero();  ///< N m, about the wall's reference point
  double stiffness = 0;        ///< N/m, normal, of all touches
  std::uint32_t touches = 0;
  double spring = 0;       ///< N/m, of all touches, each in its stiffest direction
  double dashpot = 0;      ///< N s/m, the same
  std::uint32_t near = 0;  ///< bodies that may come to touch it before the next search
};

/// Touches are filed by the chunk of their body, then by wall, body and feature: the order in which they are found, so
/// that memory is handed on by walking along two sorted lists.
class WallContacts {
 public:
  /// Which bodies may come to touch which wall while neither goes further than its skin is wide.
  void rebuild(const Bodies& bodies, std::span<const WallSurface> walls, const Skins& skins,
               std::span<const StateField> fields, std::span<const std::uint32_t> order);
  void set_fields(std::span<const StateField> fields);

  /// Finds and evaluates the touches of one chunk; adds to the sums of its bodies, and to `losses` unless they are
  /// null. Returns the largest overlap over a radius.
  double evaluate(std::size_t chunk, const ContactLaw& law, const Bodies& bodies, bool one_material,
                  std::span<const WallSurface> walls, double dt, BodySum* sum, Losses* losses);
  /// Bodies have grown by `factor` to what they are now: touches go as much deeper.
  void grow(const Bodies& bodies, double factor);
  /// Loads on all walls, summed chunk by chunk.
  void loads(std::span<WallLoad> loads) const;
  /// What presses on a wall [N] were it `there`, moved at `velocity` [m/s], and were the bodies as they are now: of
  /// springs that stiffen no more than if they had been as stiff from first touch on, and of dashpots. Looks at `all`
  /// bodies, or at those alone that it may come to touch before the next search.
  double force_ahead(std::size_t wall, const WallSurface& surface, const Pose& there, const Vec3& velocity,
                     const ContactLaw& law, const Bodies& bodies, bool all) const;

  struct Touching {
    const WallTouch* touch;
    const ContactRow* row;
    std::span<const double> state;
  };
  /// All touches, in their order.
  template <class Use>
  void each(Use use) const {
    for (std::size_t c = 0; c < chunks_.size(); ++c) each(c, use);
  }
  /// Those of one chunk.
  template <class Use>
  void each(std::size_t c, Use use) const {
    const Chunk& chunk = chunks_[c];
    for (std::size_t i = 0; i < chunk.touch.size(); ++i)
      use(Touching{&chunk.touch[i], &chunk.row[i], {chunk.state.data() + i * fields_.size(), fields_.size()}});
  }
  /// What bodies of a chunk would touch if they were larger by `near` [m], at this instant: overlaps are as much
  /// larger.
  template <class Use>
  void each_near(std::size_t c, const Bodies& bodies, std::span<const WallSurface> walls, double near, Use use) const {
    const Chunk& chunk = chunks_[c];
    std::vector<Sphere> spheres;
    std::vector<Touch> found;
    for (std::size_t w = 0; w < walls.size(); ++w) {
      spheres.clear(), found.clear();
      for (std::uint32_t n = chunk.candidate_start[w]; n < chunk.candidate_start[w + 1]; ++n) {
        const Row& x = bodies.position[chunk.candidate[n]];
        spheres.push_back({{x.x, x.y, x.z}, x.w + near, chunk.candidate[n]});
      }
      if (!spheres.empty()) walls[w].geometry->touch(walls[w].pose, spheres, found);
      for (const Touch& touch : found) use(touch, walls[w]);
    }
  }
  std::size_t touching_count() const;
  void remember(Memory& memory) { memory(chunks_); }

 private:
  struct Chunk {
    std::vector<std::uint32_t> candidate_start;  // by wall
    std::vector<std::uint32_t> candidate;        // bodies
    std::vector<WallTouch> touch;
    std::vector<double> state;
    std::vector<ContactRow> row;
    std::vector<WallLoad> load;  // by wall

    void remember(Memory& memory) {
      memory(candidate_start, candidate, touch, state);
      row.resize(touch.size());
    }
  };
  /// What a touch of the last step was.
  struct Before {
    Vec3 normal;
    std::uint32_t body, wall, feature, material;
    double overlap;
  };
  /// What evaluate() works with. One for all chunks of a thread, so that it stays in the cache.
  struct Workspace {
    std::vector<Sphere> spheres;
    std::vector<Touch> found;
    std::vector<Before> before;
    std::vector<double> state_before;
    std::vector<std::uint32_t> same_body_before, fresh, gone;  // indices of touches
    std::vector<bool> hide;
  };
  /// Leaves out touches where the surface of another wall that the same body touches goes on: edges of coplanar faces
  /// that meet, and edges that faces share, count once. Across a gap each face counts: whatever the body is over, its
  /// force does not jump there.
  static void leave_out_hidden(Chunk& chunk, Workspace& work, const Bodies& bodies, std::span<const WallSurface> walls);
  /// Whether the wall of the deeper touch is also where the lesser one is.
  static bool hidden(const WallTouch& lesser, const WallTouch& deeper, const Row& body,
                     std::span<const WallSurface> walls, Workspace& work);
  /// From the touches of the last step to those of this one. Leaves in work.gone those that none takes over.
  void hand_on_memories(Chunk& chunk, Workspace& work, const Bodies& bodies, double dt) const;
  /// What springs of touches that are gone held is lost.
  void part(const Workspace& work, const ContactLaw& law, const Bodies& bodies, Losses& losses) const;

  std::vector<Chunk> chunks_;
  std::vector<StateField> fields_;
};

}  // namespace grit
