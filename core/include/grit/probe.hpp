// Probes look at a const world and say numbers. Nothing a probe does changes a trajectory.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "grit/memory.hpp"
#include "grit/parameters.hpp"
#include "grit/world.hpp"

namespace grit {

/// One quantity that a probe reports at every sample.
struct Channel {
  std::string name;                ///< snake_case; becomes a dataset
  std::string unit;                ///< UDUNITS spelling, "1" if dimensionless
  std::string doc;                 ///< one line, with the sign convention
  std::vector<std::size_t> shape;  ///< of one sample: {} a number, {n} a list, …
  /// Of a list: the channel of the same probe and shape that says where each number is, e.g. "place" [m]; an angle
  /// ("rad" or "degree") where the list goes by direction. Empty: numbers of something else.
  std::string coordinate = {};
  std::vector<std::string> components = {};  ///< what each number of a sample is, e.g. "xx"; as Field has them
};

/// One table of an instant, of any length: contacts, cells, chains. A probe that has fields "centre" [m, width 3: where
/// a cell is now] and "size" [m, width 3: what it fills on a map] says by them that its fields of as many rows are
/// maps. A map parts its colours at zero for every component but those on the diagonal of a tensor in Pa; for a single
/// number where its doc says "positive" or "clockwise", unless its unit is Pa.
struct Field {
  std::string name;  ///< snake_case
  std::string unit, doc;
  std::size_t width = 1;       ///< numbers a row
  std::vector<double> values;  ///< row by row
  /// Of each number of a row, without spaces: e.g. "xx". Empty: x, y, z of three, xx, xy … zz of nine.
  std::vector<std::string> components = {};
};

/// Called from one thread, between steps.
class Probe {
 public:
  virtual ~Probe() = default;
  virtual void declare(Parameters& parameters) = 0;
  virtual StateRequest needs() const { return {}; }
  /// Once, before the first sample. Throws Error("probe TYPE, /KEY: …") of what the world lacks: told where KEY stands.
  virtual void prepare(const World&) {}
  /// The same at every call after prepare().
  virtual std::vector<Channel> channels() const = 0;
  /// Fills one span a channel, in the order of channels().
  virtual void sample(const World& world, std::span<const std::span<double>> values) = 0;
  /// What goes into frames.
  virtual std::vector<Field> fields(const World&) { return {}; }
  /// Names what it keeps from one sample for the next, each once, so that a run that goes on from a checkpoint is the
  /// same as one that was never stopped. Restored after prepare().
  virtual void remember(Memory&) {}
};

}  // namespace grit
