#include "app/curve_summary.hpp"

#include <cmath>
#include <sstream>

#include "grit/error.hpp"

namespace grit {

CurveSummary::CurveSummary(Recorder& next, std::vector<std::string> channels,
                           std::function<void(const std::string&)> say)
    : next_(next), say_(std::move(say)) {
  for (auto& name : channels) curves_.push_back({.name = std::move(name), .unit = ""});
}

void CurveSummary::begin(const World& world, std::span<const ProbeGroup> probes) {
  for (Curve& curve : curves_) {
    bool found = false;
    std::string all;
    for (std::size_t p = 0; p < probes.size(); ++p)
      for (std::size_t c = 0; c < probes[p].channels.size(); ++c) {
        const Channel& channel = probes[p].channels[c];
        if (!channel.shape.empty()) continue;
        const std::string name = probes[p].name + '/' + channel.name;
        all += (all.empty() ? "" : ", ") + name;
        if (name == curve.name) found = true, curve.probe = p, curve.channel = c, curve.unit = channel.unit;
      }
    if (!found) throw Error("/output/summary names \"" + curve.name + "\", which no probe has; there is: " + all);
  }
  next_.begin(world, probes);
}

void CurveSummary::sample(std::size_t probe, const World& world, std::span<const std::span<const double>> values) {
  for (Curve& curve : curves_) {
    if (curve.probe != probe) continue;
    curve.last = values[curve.channel][0];
    if (std::isnan(curve.last)) continue;
    if (!curve.any || std::abs(curve.last) > std::abs(curve.largest)) curve.largest = curve.last;
    curve.any = true;
  }
  next_.sample(probe, world, values);
}

void CurveSummary::stage_ended(const World& world, const std::string& what) {
  say_("stage \"" + world.stage() + "\" ended: " + what);
  next_.stage_ended(world, what);
}

void CurveSummary::remember(Memory& memory) {
  for (Curve& curve : curves_) memory(curve.largest, curve.last, curve.any);
  next_.remember(memory);
}

std::string CurveSummary::text() const {
  std::ostringstream text;
  text.precision(4);
  for (const Curve& curve : curves_) {
    const bool ends = !std::isnan(curve.last);
    if (!curve.any && ends) continue;  // nobody looked
    const std::string unit = curve.unit == "1" ? "" : ' ' + curve.unit;
    text << curve.name << ": ";
    if (curve.any) text << "peak " << curve.largest << unit << ", ";
    if (ends) text << "final " << curve.last << unit << '\n';
    else text << "not defined at the end\n";
  }
  return text.str();
}

}  // namespace grit
