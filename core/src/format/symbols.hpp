// Symbols and units for display.
#pragma once

#include <string>

namespace grit {

/// A UDUNITS unit for display: "kN m-3" becomes "kN/m³", "degree" becomes "°". Other than products of powers are kept.
std::string written_unit(const std::string& unit);

/// A unit for display with a prefix that makes `largest` readable, and the factor to multiply by: 0.004 m becomes 4 mm,
/// 26 000 N m-3 becomes 26 kN/m³, rad becomes °. Units that take no prefix, such as "1", are kept.
struct ReadableUnit {
  double factor = 1;
  std::string unit;
};
ReadableUnit readable(const std::string& unit, double largest);

/// A unit as it follows a number: " kPa", "°"; empty for "1" or "".
std::string after_number(const std::string& unit);

/// "label [unit]", or the label alone for a unit of "1" or "".
std::string axis_title(const std::string& label, const std::string& unit);

/// A channel's name for display: `shear_stress` becomes "shear stress", `sigma_1` "σ₁", `mu_eff` "μ_eff".
std::string spelled(const std::string& name);

/// Replaces symbols with an index in a sentence: "asin(sigma_1 - …)" becomes "asin(σ₁ - …)".
std::string with_symbols(const std::string& text);

/// Axis label of a probe's channel: "slip: fraction"; only the channel's name for probe "test" and for time.
std::string channel_label(const std::string& probe, const std::string& channel);

}  // namespace grit
