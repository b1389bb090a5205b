// What shows to be wrong in a description once its components are there, found before a run.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "input/scene.hpp"
#include "simulation/live_components.hpp"

namespace grit {

/// Faults, each with its place in the files of a description.
class Faults {
 public:
  explicit Faults(const Document& document) : document_(&document) {}
  /// One at a pointer.
  void add(const std::string& pointer, const std::string& message);
  /// One of what stands at one of these pointers, where it was written last by the changes of the first stages.
  void add(const std::vector<std::string>& pointers, std::size_t stages, const std::string& message);
  /// Adds faults of components after so many stages have begun.
  ReportFault report_of(std::size_t stages);
  /// Throws DescriptionError with all of them.
  void throw_if_any();

 private:
  const Document* document_;
  std::vector<Problem> problems_;
};

/// Goes through all stages: sees that geometries can be prepared, that servos have something to press with, and that
/// conditions can come true. `geometries` are those of the beginning.
void check_stages(const Scene& scene, LiveGeometries geometries, Faults& faults);

}  // namespace grit
