// Maps of cells that probes leave in frames, as a page carries them.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "grit/description.hpp"
#include "output/read_frames.hpp"
#include "report/map_fields.hpp"
#include "report/packed.hpp"

namespace grit {

/// Takes frames one after another. Of a probe the page knows what fields the first of its frames had.
class CellMaps {
 public:
  /// Numbers are kept as float32, of `bytes` before deflating at most, of which each probe of a frame has the same
  /// share: a probe of which a frame would go beyond that has no map there.
  CellMaps(DataElements& data, std::size_t bytes) : data_(data), bytes_(bytes), bytes_left_(bytes) {}

  /// The maps of a frame. What they lack is NaN.
  void add(std::size_t frame, const std::string& stage, const std::vector<FieldGroup>& maps);

  /// [{probe, boxes, fields, frames}], a probe each:
  ///   boxes    by stage {low, high}: corners of the box of all cells of its frames [m]
  ///   fields   [{name, label, unit, shown_unit, factor, about, components, signed, rank, ranges}], of what cells hold,
  ///            bookkeeping apart: signed says of each component whether zero parts its values, rank which field is
  ///            looked at first (see map_fields); ranges has for each stage [[low, high] a component] that 98 of 100
  ///            cells of each of its frames lie within, null where there is no number
  ///   frames   [{frame, cells, data}]: of those frames that have it, float32: of all cells x, y and z of the centre,
  ///            then of the size [m], then component after component of the fields
  ///   left_out frames that had no room
  Description result() const;

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  struct Range {
    double low, high;
  };
  struct Box {
    std::array<double, 3> low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};  ///< m
  };
  struct MapField {
    std::string name, unit, doc;
    std::vector<std::string> components;
    std::size_t width;
    std::map<std::string, std::vector<std::optional<Range>>> ranges;  ///< by stage, a component each
    int rank;
    std::vector<bool> parted;  ///< by zero, a component each
  };
  struct Map {
    std::string probe;
    std::vector<MapField> fields;
    Description frames = Description::array();
    std::size_t left_out = 0, bytes = 0;
    std::map<std::string, Box> boxes;  ///< by stage
  };
  Map& map_of(const FieldGroup& group);

  DataElements& data_;
  std::size_t bytes_, bytes_left_;
  std::vector<Map> maps_;
};

}  // namespace grit
