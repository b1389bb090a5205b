// Scales that people like to read.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace grit {

/// Whether a number can be drawn, and be part of a scale: finite, and below 1e30 in SI, which nothing of this field
/// reaches. A greater one is of something that has gone wrong, and would hide all others.
bool drawable(double value);

/// The steps 1, 2, 5 × 10ⁿ: the one that cuts `span` (> 0) into about `pieces`.
double nice_step(double span, int pieces);

/// Multiples of a nice step within [low, high]; about `pieces` + 1 of them.
std::vector<double> ticks(double low, double high, int pieces);

/// An axis and the multiples of its step, 1, 2 or 5 × 10ⁿ, that are marked on it.
struct AxisTicks {
  double low, high, step;
  std::vector<double> marks;
};
enum class AxisEnds { kept, whole_steps };
/// An axis over [low, high] with 4 to 8 ticks: as fine as `fits`, or, where nothing fits, as coarse as
/// four ticks are. It ends where it is told, or goes out to whole steps; it does where fewer than four lie within.
/// Where there is no such range, of infinite or too narrow ends, it has one about them.
AxisTicks axis_ticks(
    double low, double high, AxisEnds ends,
    const std::function<bool(const AxisTicks&)>& fits = [](const AxisTicks&) { return true; });

/// A number for a tick of a scale with this step, with U+2212 for minus.
std::string tick_label(double value, double step);

/// Three significant digits, with U+2212 for minus.
std::string short_number(double value);

/// A unit of UDUNITS as people write it: "kN m-3" is "kN/m³", "degree" is "°". What is no product of powers stays.
std::string written_unit(const std::string& unit);

/// A unit of UDUNITS in which `largest` is easy to read, as people write it, and what to multiply by: 0.004 m becomes
/// 4 mm, 26 000 N m-3 become 26 kN/m³, rad become °. Units without prefixes, "1" among them, stay.
struct ReadableUnit {
  double factor = 1;
  std::string unit;
};
ReadableUnit readable(const std::string& unit, double largest);

/// "1.2 s", "69.23 ms", "3.4 µs": four digits.
std::string written_time(double seconds);

/// "label [unit]", or the label alone for a unit of "1" or "".
std::string axis_title(const std::string& label, const std::string& unit);

/// A channel's name as people write it: `shear_stress` is "shear stress", `sigma_1` is "σ₁", `mu_eff` is "μ_eff".
std::string spelled(const std::string& name);

/// A sentence whose names of symbols with an index are written so: "asin(sigma_1 - …)" is "asin(σ₁ - …)".
std::string with_symbols(const std::string& text);

/// What an axis of a picture says of a probe's channel: "slip: share", but of a test, and of time, the name alone.
std::string channel_label(const std::string& probe, const std::string& channel);

/// 1234567 as "1 234 567", with thin spaces that do not break.
std::string grouped(std::uint64_t number);

}  // namespace grit
