// A study of speed against accuracy, typed: one scene, settings that vary, and the figures that count.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "description/description.hpp"
#include "grit/description.hpp"
#include "grit/parameters.hpp"

namespace grit {

/// What is taken from a run. Channels are named "group/channel", as in series.h5.
struct MaximumFigure {
  static constexpr const char* type_name = "maximum";
  void declare(Parameters&) {}
};
struct PlaceOfMaximumFigure {
  static constexpr const char* type_name = "place-of-maximum";
  void declare(Parameters&) {}
};
struct MinimumFigure {
  static constexpr const char* type_name = "minimum";
  void declare(Parameters&) {}
};
struct LastFigure {
  static constexpr const char* type_name = "last";
  void declare(Parameters&) {}
};
struct MeanFigure {
  static constexpr const char* type_name = "mean";
  double share = 0.2;
  void declare(Parameters& p);
};
struct ValueFigure {
  static constexpr const char* type_name = "value";
  double at = 0;
  void declare(Parameters& p);
};
struct CurveFigure {
  static constexpr const char* type_name = "curve";
  void declare(Parameters&) {}
};
struct ProfileFigure {
  static constexpr const char* type_name = "profile";
  void declare(Parameters&) {}
};

struct FigureDescription {
  OneOf<MaximumFigure, PlaceOfMaximumFigure, MinimumFigure, LastFigure, MeanFigure, ValueFigure, CurveFigure,
        ProfileFigure>
      what{"figure"};
  std::string of, against;
  std::optional<double> scale, value;
  std::optional<ReferenceCurve> curve;

  void declare(Parameters& p);
  bool is_curve() const;
};

struct SettingDescription {
  std::string about;
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
  std::string title, scene, vary = "one-at-a-time";
  Description set = Description::object();
  std::map<std::string, SettingDescription> settings;
  SeedsDescription seeds;
  std::map<std::string, FigureDescription> figures;
  double tolerance = 0.05;
  bool advice = true;  ///< whether descriptions may be advised by it

  void declare(Parameters& p);
};

/// Throws FileError and DescriptionError with all problems.
StudyDescription load_study(const std::filesystem::path& path);

}  // namespace grit
