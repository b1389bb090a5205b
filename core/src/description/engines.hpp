// Actions on bodies other than contacts.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "grit/parameters.hpp"
#include "plugins/component.hpp"

namespace grit {

struct EngineDescription {
  Component<Engine> engine;
  std::vector<std::string> groups;  ///< of bodies on which it acts; empty: all
  explicit EngineDescription(const Registry& registry) : engine(registry) {}
  void declare(Parameters& p);
  bool acts_on(const std::string& group) const {
    return groups.empty() || std::ranges::find(groups, group) != groups.end();
  }
};

}  // namespace grit
