// The simulated region, its deformation, and the specimen in it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "grit/parameters.hpp"
#include "grit/vec.hpp"

namespace grit {

/// Names of the components of strain and stress of a cell.
inline const std::array<std::string, 6> cell_components{"xx", "yy", "zz", "xy", "xz", "yz"};
/// Target stresses of a cell [Pa]; components without one keep their strain rate.
struct CellStressDescription {
  std::optional<double> xx, yy, zz, xy, xz, yz;
  void declare(Parameters& p);
};
/// The strain rate of a periodic cell that keeps stresses.
struct CellServoDescription {
  CellStressDescription stress;
  double max_strain_rate = 0;  ///< 1/s
  double gain = 1;
  std::int64_t interval = 10;  ///< steps
  /// xx, yy, zz, xy, xz, yz
  std::array<std::optional<double>, 6> targets() const {
    return {stress.xx, stress.yy, stress.zz, stress.xy, stress.xz, stress.yz};
  }
  void declare(Parameters& p);
};
/// Gradients of the mean flow of a cell [1/s], of the first component along the second axis.
struct ShearRateDescription {
  double xy = 0, xz = 0, yz = 0;
  Vec3 vector() const { return {xy, xz, yz}; }
  void declare(Parameters& p);
};
struct DomainDescription {
  std::optional<Vec3> low, high;
  std::array<bool, 3> periodic{false, false, false};
  Vec3 strain_rate = Vec3::Zero();
  ShearRateDescription shear_rate;
  std::optional<CellServoDescription> servo;
  std::vector<std::string> open_sides;
  /// Keys that stages may change.
  static const std::vector<std::string>& changeable();
  /// Whether images may move off the axes.
  bool shears() const {
    return !shear_rate.vector().isZero(0.0) || (servo && (servo->stress.xy || servo->stress.xz || servo->stress.yz));
  }
  /// Whether the cell may change its shape.
  bool deforms() const { return servo || shears() || !strain_rate.isZero(0.0); }
  void declare(Parameters& p);
};

struct SpecimenDescription {
  std::vector<std::string> low, high;  ///< walls at the x, y and z sides; "": bound of the domain
  void declare(Parameters& p);
};

}  // namespace grit
