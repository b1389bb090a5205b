// A picture and the name of its file.
#pragma once

#include <string>

namespace grit {

struct NamedPicture {
  std::string name;  ///< for a file: "map-packing-void_ratio"
  std::string svg;
};

}  // namespace grit
