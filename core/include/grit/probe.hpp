// Probes: components that measure. They read a const World and never change the run.
#pragma once

#include <string>
#include <vector>

#include "grit/archive.hpp"
#include "grit/channels.hpp"
#include "grit/parameters.hpp"
#include "grit/world.hpp"

namespace grit {

/// A table at one instant, of any length: contacts, cells, chains. If a probe has the fields "centre" (present position
/// of a cell [m], width 3) and "size" (size of a cell on a map [m], width 3), its fields with the same number of rows
/// are drawn as maps. The colours of a map diverge at zero for all components except the diagonal of a tensor in Pa;
/// for a single number, if its doc contains "positive" or "clockwise" and its unit is not Pa. If it has the field "id"
/// (of bodies, width 1), bodies can be coloured by its fields with as many rows.
struct Field {
  std::string name;  ///< snake_case
  std::string unit, doc;
  std::size_t width = 1;       ///< numbers per row
  std::vector<double> values;  ///< row by row
  /// Names of the numbers of a row, without spaces, e.g. "xx". Empty: x, y, z for width 3; xx, xy … zz for width 9.
  std::vector<std::string> components = {};
  /// Name of a wall if the rows are its triangles: ParaView then colours the wall by the field.
  std::string wall = {};
};

/// Base class of plugins of kind "probe". Called from one thread, between steps.
class Probe {
 public:
  virtual ~Probe() = default;
  virtual void declare(Parameters& parameters) = 0;
  virtual StateRequest needs() const { return {}; }
  /// Called once before the first sample. Throws ParameterError for parameters that do not fit the world, e.g. a wall
  /// that does not exist; its keys are those of the parameters.
  virtual void prepare(const World&) {}
  /// The channels; identical at every call after prepare(). No name is that of another, "time" or "step".
  virtual std::vector<Channel> channels() const = 0;
  /// Writes every value of every channel.
  virtual void sample(const World& world, ChannelValues& values) = 0;
  /// Tables for frames.
  virtual std::vector<Field> fields(const World&) { return {}; }
  /// Passes each member that the probe keeps between samples to the archive, once. A resumed run is then identical to
  /// an uninterrupted one. Restored after prepare().
  virtual void serialize(Archive&) {}
};

}  // namespace grit
