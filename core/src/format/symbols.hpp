// Symbols and units as people write them.
#pragma once

#include <string>

namespace grit {

/// A UDUNITS unit as people write it: "kN m-3" is "kN/m³", "degree" is "°". What is no product of powers stays.
std::string written_unit(const std::string& unit);

/// A UDUNITS unit in which `largest` is easy to read, as people write it, and the factor to multiply by: 0.004 m
/// becomes 4 mm, 26 000 N m-3 become 26 kN/m³, rad become °. Units without prefixes, "1" among them, stay.
struct ReadableUnit {
  double factor = 1;
  std::string unit;
};
ReadableUnit readable(const std::string& unit, double largest);

/// "label [unit]", or the label alone for a unit of "1" or "".
std::string axis_title(const std::string& label, const std::string& unit);

/// A channel's name as people write it: `shear_stress` is "shear stress", `sigma_1` is "σ₁", `mu_eff` is "μ_eff".
std::string spelled(const std::string& name);

/// A sentence with symbols that have an index written so: "asin(sigma_1 - …)" is "asin(σ₁ - …)".
std::string with_symbols(const std::string& text);

/// Label of a probe's channel on an axis: "slip: share", but of a test, and of time, the name alone.
std::string channel_label(const std::string& probe, const std::string& channel);

}  // namespace grit
