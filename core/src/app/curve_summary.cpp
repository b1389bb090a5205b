#include "app/curve_summary.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <sstream>

#include "format/symbols.hpp"
#include "output/named_fields.hpp"

namespace grit {

CurveSummary::CurveSummary(Recorder& next, const Scene& scene, std::function<void(const std::string&)> say)
    : next_(next), scene_(scene), say_(std::move(say)), curves_(scene.description->output.summary.size()) {}

void CurveSummary::begin(const World& world, std::span<const ProbeGroup> probes) {
  const SingleChannels channels(probes);
  const SceneDescription& description = *scene_.description;
  channels.check(scene_.document, description.output);
  check_fields(scene_.document, description, world);
  for (std::size_t i = 0; i < curves_.size(); ++i)
    curves_[i].channel = channels.at(description.output.summary[i], fmt::format("/output/summary/{}", i));
  next_.begin(world, probes);
}

void CurveSummary::sample(std::size_t probe, const World& world, std::span<const std::span<const double>> values) {
  for (Curve& curve : curves_) {
    if (curve.channel.probe != probe) continue;
    curve.last = curve.channel.of(world, values);
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

void CurveSummary::serialize(Archive& archive) {
  for (Curve& curve : curves_) archive(curve.largest, curve.last, curve.any);
  next_.serialize(archive);
}

std::string CurveSummary::text() const {
  std::ostringstream text;
  text.precision(4);
  for (const Curve& curve : curves_) {
    const bool ends = !std::isnan(curve.last);
    if (!curve.any && ends) continue;  // never sampled
    const ReadableUnit shown = readable(curve.channel.unit, std::abs(curve.any ? curve.largest : curve.last));
    const std::string unit = after_number(shown.unit);
    text << curve.channel.full_name() << ": ";
    if (curve.any) text << "peak " << shown.factor * curve.largest << unit << ", ";
    if (ends) text << "final " << shown.factor * curve.last << unit << '\n';
    else text << "not defined at the end\n";
  }
  return text.str();
}

}  // namespace grit
