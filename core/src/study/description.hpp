// Description of a study: one scene, varied settings, and metrics.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "description/description.hpp"
#include "grit/description.hpp"
#include "grit/parameters.hpp"

namespace grit {

/// Metrics of a run. Channels are named "probe/channel", as in series.h5.
struct MaximumMetric {
  static constexpr const char* type_name = "maximum";
  static constexpr const char* type_doc = "largest value of the curve";
  void declare(Parameters&) {}
};
struct PositionOfMaximumMetric {
  static constexpr const char* type_name = "position-of-maximum";
  static constexpr const char* type_doc = "abscissa of the largest value";
  void declare(Parameters&) {}
};
struct MinimumMetric {
  static constexpr const char* type_name = "minimum";
  static constexpr const char* type_doc = "smallest value of the curve";
  void declare(Parameters&) {}
};
struct LastMetric {
  static constexpr const char* type_name = "last";
  static constexpr const char* type_doc = "last value of the curve";
  void declare(Parameters&) {}
};
struct MeanMetric {
  static constexpr const char* type_name = "mean";
  static constexpr const char* type_doc = "mean over the last part of the curve";
  double fraction = 0.2;
  void declare(Parameters& p);
};
struct ValueMetric {
  static constexpr const char* type_name = "value";
  static constexpr const char* type_doc = "value at an abscissa";
  Description at;  ///< a number in the unit of the abscissa, or a text with a unit
  void declare(Parameters& p);
};
struct CurveMetric {
  static constexpr const char* type_name = "curve";
  static constexpr const char* type_doc = "the whole curve";
  void declare(Parameters&) {}
};
struct ProfileMetric {
  static constexpr const char* type_name = "profile";
  static constexpr const char* type_doc = "the last sample of a channel with several values";
  void declare(Parameters&) {}
};

struct MetricDescription {
  OneOf<MaximumMetric, PositionOfMaximumMetric, MinimumMetric, LastMetric, MeanMetric, ValueMetric, CurveMetric,
        ProfileMetric>
      what{"metric"};
  std::string of, against;
  Description written_scale, written_value;  ///< a number in the unit of the channel, or a text with a unit; or null
  std::optional<double> scale, value;        ///< their numbers, after find_numbers()
  std::optional<ReferenceCurve> curve;

  void declare(Parameters& p);
  /// Only the metric and its channels, without references.
  void declare_channels(Parameters& p);
  bool is_curve() const;
  /// The channel in whose unit its values are.
  std::string channel() const;
  /// The channel of the abscissa; empty for the index of a profile.
  std::string abscissa() const;
  /// Reports what has no number, with the units of channels that are known.
  void find_numbers(const std::map<std::string, std::string>& units, const Complain& complain);
  /// Whether the description gives its reference.
  bool has_own_reference() const { return !written_value.is_null() || curve; }
};

struct SettingDescription {
  std::string doc;
  std::vector<std::string> pointers;
  Description values = Description::array();
  std::vector<std::string> labels;
  std::string usual;

  void declare(Parameters& p);
  std::size_t levels() const { return values.size(); }
  std::string label(std::size_t level) const;
  std::size_t usual_level() const;
  std::size_t finest_level() const { return levels() - 1; }
  /// "/pointer=value" for each pointer.
  std::vector<std::string> sets(std::size_t level) const;
};

struct SeedsDescription {
  std::string pointer = "/seed";
  std::vector<double> values{1, 2, 3};
  void declare(Parameters& p);
};

struct StudyDescription {
  std::string title, scene, purpose = "accuracy", vary = "one-at-a-time";
  Description set = Description::object();
  std::map<std::string, SettingDescription> settings;
  SeedsDescription seeds;
  std::map<std::string, MetricDescription> metrics;
  double tolerance = 0.05;

  void declare(Parameters& p);
  /// Whether metrics are shown against the settings, without a finest level to compare with.
  bool is_sweep() const { return purpose == "sweep"; }
  /// Whether the finest settings are the reference of a metric.
  bool compares_with_finest() const;
};

/// A pointer at which each run is changed, and where in the file it is written.
struct ChangedPointer {
  std::string pointer, where;
};
/// Refuses values that are changed twice: only the last change would count.
void refuse_changed_twice(const std::vector<ChangedPointer>& all, std::string_view allowed, const Complain& complain);

/// Throws FileError and DescriptionError with all problems.
StudyDescription load_study(const std::filesystem::path& path);

}  // namespace grit
