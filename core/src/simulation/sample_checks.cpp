#include "simulation/sample_checks.hpp"

namespace grit {
namespace {

std::string quoted_names(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "\"" : ", \"") + name + '"';
  return text.empty() ? "none" : text;
}

std::string axes_of(const std::array<bool, 3>& periodic) {
  std::string text;
  for (std::size_t k = 0; k < 3; ++k)
    if (periodic[k]) text += (text.empty() ? "" : ", ") + std::string(1, "xyz"[k]);
  return text.empty() ? "no axis" : text;
}

}  // namespace

std::string name_of_sample(const BeginDescription& begin) { return "the sample in " + begin.from; }

void check_groups(const SceneDescription& scene, const std::set<std::string>& has, const std::string& sample,
                  SampleFaults& faults) {
  std::set<std::string> used;
  for (const auto& [name, group] : scene.bodies)
    if (group.is_from_sample()) used.insert(name);
  for (const std::string& name : used)
    if (!has.contains(name))
      faults.push_back({{"bodies", name}, sample + " has no group of this name; it has " + quoted_names(has)});
  for (const std::string& name : has)
    if (!used.contains(name))
      faults.push_back({{"bodies"},
                        sample + " has a group \"" + name +
                            "\", which is not described; add it with \"source\": {\"type\": \"sample\"}"});
}

void check_domain(const DomainDescription& now, const DomainDescription& before, const std::string& sample,
                  SampleFaults& faults) {
  if (now.periodic != before.periodic)
    faults.push_back({{"domain", "periodic"},
                      "the domain of " + sample + " is periodic along " + axes_of(before.periodic) + "; use the same"});
  else if ((now.periodic[0] || now.periodic[1] || now.periodic[2]) &&
           (now.low != before.low || now.high != before.high))
    faults.push_back({{"domain"},
                      "the domain of " + sample +
                          " has other bounds; use those of its description: the cell keeps its present size"});
}

std::vector<std::string> walls_with_other_geometry(const SceneDescription& now, const SceneDescription& before) {
  std::vector<std::string> names;
  for (const auto& [name, wall] : now.walls)
    if (const auto then = before.walls.find(name); then != before.walls.end() && then->second.geometry != wall.geometry)
      names.push_back(name);
  return names;
}

}  // namespace grit
