// A setting without effect.
#pragma once

#include <string>

namespace grit {

struct UnusedSetting {
  std::string pointer;  ///< JSON pointer
  std::string why;
};

}  // namespace grit
