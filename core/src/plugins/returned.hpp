// What plugins return, checked before the kernel uses it.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "grit/body_kind.hpp"
#include "grit/contact/contact_law.hpp"
#include "grit/engine.hpp"
#include "grit/geometry.hpp"
#include "grit/probe.hpp"

namespace grit {

/// What is wrong with a value, as "…; allowed is …"; empty if nothing is.
std::string fault_of(const ClumpShape& shape);
std::string fault_of(std::span<const StateField> fields);
std::string fault_of(Phase phase);
std::string fault_of(const MotionSettings& settings);
std::string fault_of(const EngineRates& rates);
std::string fault_of(const Bounds& bounds);
std::string fault_of(std::span<const Channel> channels);
std::string fault_of(std::span<const Field> fields);
/// Of a unit normal, zero where it is undefined.
std::string fault_of_normal(const Vec3& normal);
/// Of a number that is positive, or not negative.
std::string fault_of_positive(double number);
std::string fault_of_not_negative(double number);
/// Of the corners of triangles.
std::string fault_of_triangles(std::span<const Vec3> corners);
/// Of contacts of these spheres, in the order of the spheres. Their numbers are left to the guards of the kernel.
std::string fault_of_contacts(std::span<const SurfaceContact> contacts, std::span<const Sphere> spheres);

}  // namespace grit
