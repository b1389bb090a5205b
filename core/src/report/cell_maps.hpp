// Maps of cells from probes in frames, in the form of the page.
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
#include "output/shown_fields.hpp"
#include "report/packed.hpp"

namespace grit {

/// Takes frames in order. The fields of a probe are those of its first frame.
class CellMaps {
 public:
  /// Numbers are float32, at most `bytes` in all before deflating. Each probe of a frame may use the same part of it: a
  /// map that would exceed it is omitted.
  CellMaps(DataElements& data, std::size_t bytes) : data_(data), bytes_(bytes), bytes_left_(bytes) {}

  /// Adds the maps of a frame. Missing fields are NaN.
  void add(std::size_t frame, const std::string& stage, const std::vector<FieldGroup>& maps);

  /// [{probe, boxes, fields, frames}], one entry per probe:
  ///   boxes    by stage {low, high}: corners of the box of all cells of its frames [m]
  ///   fields   [{name, label, unit, shown_unit, factor, about, components, signed, rank, ranges}], of the cells,
  ///            without bookkeeping: signed, by component, whether the quantity is signed; rank, the order of fields
  ///            (see shown_fields); ranges, by stage, [[low, high] per component] of the central 98 % of the cells of
  ///            each frame, but at most largest_shown(); null without numbers
  ///   frames   [{frame, cells, data}]: for frames that have the map, float32: of all cells x, y and z of the centre,
  ///            then of the size [m], then each component of the fields
  ///   left_out number of frames omitted for lack of space
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
    std::map<std::string, std::vector<std::optional<Range>>> ranges;  ///< by stage, one per component
    int rank;
    std::vector<bool> is_signed;  ///< one per component
    double largest_shown;
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
