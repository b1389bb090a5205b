#include "app/too_deep.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "app/shipped_studies.hpp"
#include "study/parts.hpp"

namespace grit {
namespace {

constexpr double tolerance = 0.05;  // of a study's figures
constexpr double far_beyond = 2;    // times as deep, or as costly, as would do
// Of a dense packing, with five contacts each; means of them scatter between samples by about 1/√contacts.
constexpr double contacts_a_body = 2.5, fine_scatter = 0.005;
constexpr double fewest_diameters = 5;

bool shows(const Evidence& level) {
  return std::ranges::any_of(level.findings, [](const Finding& one) { return !(one.error <= 2 * one.standard_error); });
}

/// Sets `tried` if a study knows this depth.
std::optional<std::string> by_studies(const std::string& scenario, const std::vector<std::string>& parts,
                                      const std::function<bool(const std::vector<std::string>&)>& same, bool& tried) {
  for (ChartedStudy& study : shipped_studies()) {
    if (!is_of(study, scenario, parts)) continue;
    std::erase_if(study.settings, [](const auto& setting) { return setting.first != "depth"; });
    for (const Advice& advice : advise(study, tolerance, same)) {
      if (advice.now == nullptr) continue;
      tried = true;
      const auto& levels = study.settings.at(advice.setting);
      for (const Evidence* one : advice.cheaper) {
        if (!one->known || one->findings.empty() || advice.now->sets.empty() || shows(*one) ||
            least_sure(levels, *one, tolerance).confidence(tolerance) > Confidence::likely)
          continue;
        const double saved = advice.now->cost / one->cost;
        if (saved < far_beyond) continue;
        const Finding& finding = *one->decisive(tolerance);
        const std::string& set = advice.now->sets.front();
        return fmt::format(
            "{}: {} deep; by \"{}\" {} changes {} by {:.1f} ± {:.1f} %, which is within what samples scatter, and is "
            "{:.1f} times cheaper",
            set.substr(0, set.find('=')), advice.now->level, study.title, one->level, finding.figure,
            100 * finding.error, 100 * finding.standard_error, saved);
      }
    }
  }
  return std::nullopt;
}

std::optional<std::string> by_contacts(const SceneDescription& scene, const Simulation& world, bool plain) {
  const auto& periodic = scene.domain.periodic;
  if (std::ranges::count(periodic, true) != 1 || !scene.domain.strain_rate.isZero(0.0)) return std::nullopt;
  const auto axis = static_cast<int>(std::ranges::find(periodic, true) - periodic.begin());
  const double depth = world.cell().high[axis] - world.cell().low[axis];
  const double contacts = contacts_a_body * static_cast<double>(world.positions().size());
  const double share =
      std::max(1 / (fine_scatter * fine_scatter) / contacts, fewest_diameters * world.mean_diameter() / depth);
  if (share * far_beyond > 1) return std::nullopt;
  // A scenario writes the domain.
  return fmt::format(
      "{}: the cell repeats along {}, and with {:.2g} m there are some {:.0f} contacts, whose means scatter between "
      "samples by about 1/√contacts, {:.2g} %; {:.2g} m would give {:.2g} % for {:.2g} of the cost",
      plain ? fmt::format("/domain/high/{}", axis) : "/scenario/depth", "xyz"[axis], depth, contacts,
      100 / std::sqrt(contacts), share * depth, 100 / std::sqrt(share * contacts), share);
}

}  // namespace

std::optional<std::string> too_deep(const Scene& described, const Simulation& world, const std::string& scenario,
                                    const std::function<bool(const std::vector<std::string>&)>& same) {
  const SceneDescription& scene = *described.description;
  bool tried = false;
  auto line = by_studies(scenario, parts_of(resolved(scene)), same, tried);
  if (!line && !tried) line = by_contacts(scene, world, scenario.empty());
  return line;
}

}  // namespace grit
