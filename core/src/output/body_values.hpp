// Numbers of bodies from the fields of probes, as colours.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "grit/world.hpp"
#include "run/recorder.hpp"

namespace grit {

/// One number for each body.
struct BodyValues {
  std::string name;  ///< "PROBE/FIELD/COMPONENT"; "PROBE/FIELD" of a scalar, and of the magnitude of a vector
  std::string label, unit, doc;
  bool is_signed = false;         ///< whether the colour scale is symmetric about zero
  std::vector<double> of_bodies;  ///< NaN for bodies that the probe does not have
};

/// Whether a name is that of a probe's field, not of a built-in colour.
inline bool names_a_field(const std::string& name) { return name.find('/') != std::string::npos; }

/// The numbers of the bodies with these ids. A table belongs to bodies if it has a field "id"; its fields are those
/// with as many rows, without "centre" and "size". Empty for other tables.
std::vector<BodyValues> values_of_bodies(const FieldGroup& table, std::span<const std::int64_t> ids);

/// Those of this name among several tables, for the bodies of a world; without a name if there are none.
BodyValues values_of_bodies(std::span<const FieldGroup> tables, const World& world, const std::string& name);

}  // namespace grit
