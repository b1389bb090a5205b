// Complete state of a simulation at one instant. The parts of the kernel share it; data of one part are in that part.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bodies/bodies.hpp"
#include "contact/contact_table.hpp"
#include "contact/halo.hpp"
#include "contact/wall_contacts.hpp"
#include "device/mirror.hpp"
#include "domain/deforming_cell.hpp"
#include "domain/population_statistics.hpp"
#include "kernel/neighbour_lists.hpp"
#include "kernel/settings.hpp"
#include "kernel/step_time.hpp"
#include "motion/motion.hpp"
#include "motion/walls.hpp"

namespace grit {

struct State {
  explicit State(const Cell& box) : cell(box) {}

  StepTime time;
  std::string stage;  ///< name; empty before the first
  Settings settings;
  std::vector<std::string> materials;  ///< names by index
  DeformingCell cell;
  Bodies bodies;
  std::vector<std::uint16_t> group;   ///< of each body, index of Settings::groups; empty if nothing depends on it
  PopulationStatistics statistics;    ///< of all bodies that ever entered
  std::vector<Departure> departures;  ///< bodies that left through open sides
  double discharged_mass = 0;         ///< of these [kg]
  NeighbourLists lists;
  ContactTable pairs;
  Halo halo;
  WallContacts wall_contacts;
  Walls walls;
  std::vector<WallSurface> surfaces;           ///< of the walls, for the contact pass
  LargeArray<BodySum> sum;                     ///< contact forces and moments by body
  std::vector<Row> added_force, added_moment;  ///< by engines; empty without any
  double overlap = 0;                          ///< largest over a radius, at the last evaluation
  /// Whether a rank has values of all bodies, or only of its own and those near them; see completion.hpp.
  struct {
    bool bodies = true;      ///< where they are and how they move
    bool identities = true;  ///< which body has which index; if not, `bodies` is false, too
    bool sums = true;
  } complete;
  std::unique_ptr<DeviceMirror> device;  ///< that steps the bodies; null: this process does

  /// Input of the contact pass; `again` if this instant has been evaluated before.
  ContactTable::Instant instant(bool again) const {
    return {*settings.law, bodies, statistics.one_material, cell.images(), time.previous_dt, lists.skins(), again};
  }
  /// Settings of the motion of a body.
  const MotionSettings& motion_of(std::size_t body) const {
    return settings.motion_of_groups.empty() ? settings.motion : settings.motion_of_groups[group[body]];
  }
  const MotionSettings& motion_of(const Clump& clump) const { return motion_of(bodies.clumps.spheres[clump.first]); }
  /// Distances of surfaces up to which the law acts [m], for bodies of the largest radius.
  std::vector<double> reaches() const {
    if (statistics.largest_radius == 0) return {};  // no bodies, or none yet: a law may divide by a radius
    return settings.law->reaches(statistics.largest_radius);
  }
  /// The next step of the leap-frog scheme. `energies`: whether work is summed up.
  MotionStep next_motion(bool energies) const;
  /// Whether the cell may change its shape in the next step.
  bool deforms() const { return cell.deforms() || settings.cell_servo; }
  /// Discharged mass over all mass that entered.
  double discharged_fraction() const { return statistics.mass > 0 ? discharged_mass / statistics.mass : 0; }
  /// Throws Error unless the parts of a restored state fit together: whatever is used as an index or a length.
  void check_restored() const;
  /// Memory of bodies and contacts [bytes].
  std::size_t bytes() const;
};

}  // namespace grit
