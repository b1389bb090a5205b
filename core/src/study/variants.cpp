#include "study/variants.hpp"

#include <algorithm>
#include <cctype>

namespace grit {
namespace {

std::string whole(double seed) { return std::to_string(static_cast<long long>(seed)); }

}  // namespace

std::vector<Variant> variants(const StudyDescription& study) {
  std::vector<std::size_t> usual, finest;
  for (const auto& [name, setting] : study.settings)
    usual.push_back(setting.usual_level()), finest.push_back(setting.finest_level());

  const bool crossed = study.vary != "one-at-a-time";
  // No level of a plain sweep is special.
  const bool plain = study.is_sweep() && (crossed || study.settings.size() == 1);
  std::vector<Variant> all;
  const auto add = [&](const std::vector<std::size_t>& levels) {
    if (std::ranges::any_of(all, [&](const Variant& other) { return other.levels == levels; })) return;
    std::string name;
    std::size_t k = 0;
    for (const auto& [setting_name, setting] : study.settings) {
      if (plain || levels[k] != usual[k])
        name += (name.empty() ? "" : ", ") + setting_name + "=" + setting.label(levels[k]);
      ++k;
    }
    all.push_back({levels, name.empty() ? "usual" : name});
  };
  if (!plain) add(usual);
  if (!crossed) {
    std::size_t k = 0;
    for (const auto& [name, setting] : study.settings) {
      for (std::size_t level = 0; level < setting.levels(); ++level) {
        auto levels = usual;
        levels[k] = level;
        add(levels);
      }
      ++k;
    }
  } else {
    std::vector<std::size_t> levels(usual.size(), 0);
    for (std::size_t k = 0; k < levels.size();) {
      add(levels);
      for (k = 0; k < levels.size() && levels[k] == finest[k]; ++k) levels[k] = 0;
      if (k < levels.size()) ++levels[k];
    }
  }
  if (study.is_sweep()) return all;
  add(finest);
  const auto reference = std::ranges::find(all, finest, &Variant::levels);
  if (all.size() > 1 && reference->name != "usual") reference->name = "finest";
  std::rotate(reference, reference + 1, all.end());
  return all;
}

std::vector<std::string> sets_of(const StudyDescription& study, const Variant& variant, double seed) {
  std::vector<std::string> sets;
  for (const auto& [pointer, value] : study.set.items()) sets.push_back(pointer + '=' + value.dump());
  std::size_t k = 0;
  for (const auto& [name, setting] : study.settings)
    for (auto& set : setting.sets(variant.levels[k++])) sets.push_back(std::move(set));
  sets.push_back(study.seeds.pointer + '=' + whole(seed));
  return sets;
}

std::filesystem::path folder_of(const Variant& variant, double seed) {
  std::string name = variant.name;
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && std::string("=.,+-").find(c) == std::string::npos) c = '_';
  return std::filesystem::path("runs") / name / ("seed-" + whole(seed));
}

}  // namespace grit
