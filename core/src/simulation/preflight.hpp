// Faults of a description that need its components to be found, before a run.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "input/scene.hpp"
#include "simulation/live_components.hpp"

namespace grit {

/// Faults, each with its position in the files of a description.
class Faults {
 public:
  explicit Faults(const Document& document) : document_(&document) {}
  /// Adds a fault at a pointer.
  void add(const std::string& pointer, const std::string& message);
  /// Adds a fault of the values at `pointers`, at their last assignment in the first `stages` stages.
  void add(const std::vector<std::string>& pointers, std::size_t stages, const std::string& message);
  /// A reporter for faults of components after `stages` stages have begun.
  ReportFault report_of(std::size_t stages);
  /// Throws DescriptionError with all of them.
  void throw_if_any();

 private:
  const Document* document_;
  std::vector<Problem> problems_;
};

/// Checks in all stages that geometries can be prepared, that servos have an area and a normal for their pressure, that
/// conditions can be met, and that a prescribed time step is below the critical one of all groups of bodies.
/// `components` and `geometries` are those at the start of the run.
void check_stages(const Scene& scene, const Components& components, LiveGeometries geometries, Faults& faults);

}  // namespace grit
