#include "study/parts.hpp"

#include <algorithm>
#include <utility>

namespace grit {
namespace {

std::string type_of(const Description& one) { return one.is_object() ? one.value("type", "") : ""; }

}  // namespace

std::vector<std::string> parts_of(const Description& resolved) {
  const auto section = [&](const char* key) { return resolved.value(key, Description::object()); };
  std::vector<std::string> parts{"contacts " + type_of(section("contacts"))};
  for (const auto& [key, one] :
       {std::pair("bodies", "bodies"), std::pair("walls", "wall"), std::pair("engines", "engine")}) {
    const Description all = section(key);
    for (const auto& [name, part] : all.items()) parts.push_back(std::string(one) + ' ' + name + ": " + type_of(part));
  }
  for (const auto& stage : resolved.value("stages", Description::array()))
    parts.push_back("stage " + stage.value("name", ""));
  const auto periodic = section("domain").value("periodic", Description::array());
  for (std::size_t axis = 0; axis < periodic.size(); ++axis)
    if (periodic[axis] == true) parts.push_back(std::string("repeats along ") + "xyz"[axis]);
  std::ranges::sort(parts);
  return parts;
}

bool is_random(const Description& resolved) {
  return std::ranges::any_of(resolved.value("bodies", Description::object()), [](const Description& group) {
    const std::string grains = type_of(group.value("source", Description()));
    return grains == "cloud" || grains == "stream" ||
           ((grains == "file" || grains == "lattice") && type_of(group) == "clump");
  });
}

}  // namespace grit
