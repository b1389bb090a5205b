// A number of a scene that is set again and again.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>

#include "plugins/parameter_values.hpp"

namespace grit {

class CheckedNumber {
 public:
  /// Finds it in a declaration; nothing if there is no number. Valid as long as find_number() says.
  static std::optional<CheckedNumber> find(Parameters& parameters, std::span<const std::string> keys);
  /// Sets it, if its range and the checks of all objects around it allow that.
  bool set(double value) const;
  /// Sets it unchecked.
  void restore(double value) const { place_.set(value); }
  double get() const { return place_.get(); }
  /// Whether a range and checks are known: not among the values of a component that is only described.
  bool is_declared() const { return declared_.parameter.has_value(); }

 private:
  CheckedNumber(NumberPlace place, Declared declared) : place_(place), declared_(std::move(declared)) {}

  NumberPlace place_;
  Declared declared_;
};

}  // namespace grit
