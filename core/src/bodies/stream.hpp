// Bodies that enter one after the other through a region.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bodies/group_builder.hpp"
#include "bodies/random.hpp"
#include "description/description.hpp"
#include "grit/archive.hpp"

namespace grit {

/// The box around the region of a stream [m].
Region bounds_of(const StreamSource& source);

/// The largest width of the region of a stream [m].
double width_of(const StreamSource& source);

/// The stream of one group of bodies: which body enters when and where. Its random numbers and counts are part of a
/// checkpoint, so that a resumed run is identical.
class Stream {
 public:
  Stream(const StreamSource& source, const GroupBuilder& builder, std::uint64_t seed);

  /// Begins at this time [s].
  void begin(double time) { begun_ = next_ = time; }
  bool begun() const { return begun_.has_value(); }
  /// Whether bodies should enter at `time` [s].
  bool is_due(double time) { return begun_ && time >= next_ && due(time, 1) > 0; }
  /// Number of bodies that should have entered by `time` but have not, as far as limits allow. At most `most`.
  std::size_t due(double time, std::size_t most);
  /// Diameter of the next body [m].
  double next_diameter();
  /// A random position for its centre, so far inside the region that a sphere of this radius does not leave it.
  Vec3 position(double radius);
  /// The box around its region [m].
  Region bounds() const { return bounds_of(source_); }
  Random& random() { return random_; }
  /// The next body has entered.
  void enter();

  std::uint64_t entered() const { return entered_; }
  double entered_mass() const { return mass_; }  ///< kg
  /// After bodies were let in at `time` [s]: `waiting` found no room. The next ones enter after `interval` [s] if these
  /// wait or if several would enter within it.
  void let_in(double time, std::size_t waiting, double interval);
  std::size_t waiting() const { return waiting_; }
  /// Diameter of the first that waits [m]; needs one.
  double waiting_diameter() const { return diameters_.back(); }
  double width() const { return width_of(source_); }

  void serialize(Archive& archive);

 private:
  double mass_of(double diameter) const { return builder_.mass(0.5 * diameter); }
  void draw();

  StreamSource source_;
  GroupBuilder builder_;
  Random random_;
  std::optional<double> begun_;
  std::vector<double> diameters_;  // the next ones, last first [m]
  std::uint64_t entered_ = 0;
  double mass_ = 0;  // kg
  std::size_t waiting_ = 0;
  double next_ = 0;  // s, time of the next attempt at the earliest
};

/// Rate of a stream [1/s]; of one by mass that of its mean body.
double expected_rate(const StreamSource& source, const GroupBuilder& builder);

/// Number of bodies of a stream by its limits; 0 if it has none.
std::size_t expected_count(const StreamSource& source, const GroupBuilder& builder);

}  // namespace grit
