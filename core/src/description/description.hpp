// The plain description, typed: values alone, nothing alive. Each parameter is declared here and nowhere else: reading,
// checks, schema and reference pages come from these declarations.
#pragma once

#include <array>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grit/description.hpp"
#include "grit/parameters.hpp"
#include "plugins/component.hpp"

namespace grit {

/// Each time a wall has gone so far, there or back, from where it was the last time.
struct DisplacementCadence {
  std::string wall, axis = "x";
  double value = 0;  ///< m, above 0
  void declare(Parameters& p);
};
/// When something is to happen again and again. None given: never.
struct Cadence {
  std::optional<double> every_time;
  std::int64_t every_steps = 0;
  std::optional<DisplacementCadence> every_displacement;
  std::optional<double> every_left;  ///< share of all mass that has come
  bool never() const { return !every_time && every_steps == 0 && !every_displacement && !every_left; }
  void declare(Parameters& p);
};

// ---- grains

struct UniformSizes {
  static constexpr const char* type_name = "uniform";
  double smallest = 0.25e-3, largest = 0.75e-3;
  void declare(Parameters& p);
};
struct LinearSizes {
  static constexpr const char* type_name = "linear";
  double smallest = 0.25e-3, largest = 0.75e-3;
  void declare(Parameters& p);
};
struct LogNormalSizes {
  static constexpr const char* type_name = "log-normal";
  double median = 0.5e-3, deviation = 0.25, smallest = 0.25e-3, largest = 1e-3;
  void declare(Parameters& p);
};
struct SieveSizes {
  static constexpr const char* type_name = "sieve";
  std::vector<double> diameters, passing;
  void declare(Parameters& p);
};
struct ListSizes {
  static constexpr const char* type_name = "list";
  std::vector<double> diameters;
  void declare(Parameters& p);
};
using Sizes = OneOf<UniformSizes, LinearSizes, LogNormalSizes, SieveSizes, ListSizes>;

/// Grains at random places that do not overlap.
struct CloudGrains {
  static constexpr const char* type_name = "cloud";
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  std::int64_t count = 0;
  Sizes sizes{"size distribution"};
  std::string flat = "none";
  void declare(Parameters& p);
};
/// A text file, "x y z radius" a line.
struct FileGrains {
  static constexpr const char* type_name = "file";
  std::string path;
  void declare(Parameters& p);
};
struct PlacedGrain {
  Vec3 position = Vec3::Zero(), velocity = Vec3::Zero(), spin = Vec3::Zero(), orientation = Vec3::Zero();
  double radius = 0;
  void declare(Parameters& p);
};
struct PlacedGrains {
  static constexpr const char* type_name = "list";
  std::deque<PlacedGrain> grains;
  void declare(Parameters& p);
};
struct BodiesDescription {
  Component<BodyKind> kind;
  std::string material;
  std::string stage;  ///< at whose begin they appear; empty: the start of the run
  Vec3 velocity = Vec3::Zero();
  static constexpr double usual_overlap = 0.01;
  double overlap = usual_overlap;  ///< of the smaller radius
  double heavier_below = 0;        ///< m
  OneOf<CloudGrains, FileGrains, PlacedGrains> grains{"source of grains"};
  explicit BodiesDescription(const Registry& registry);
  void declare(Parameters& p);
};

// ---- walls

struct ServoDescription {
  std::string axis = "z";
  std::optional<double> pressure{};  ///< Pa, compression positive
  std::optional<double> force{};     ///< N, what the wall exerts on the bodies, along the axis
  double max_velocity = 0;           ///< m/s
  double gain = 1;                   ///< share of the force's error that one step takes away where contacts are springs
  std::string area = "geometry";
  void declare(Parameters& p);
};
struct FollowDescription {
  std::string wall, axes = "z";
  void declare(Parameters& p);
};
struct FreeDescription {
  std::string axes = "z";
  double mass = 0;
  Vec3 load = Vec3::Zero();
  void declare(Parameters& p);
};
/// On top of velocity and spin. After t the wall has gone amplitude × (sin(2π f t + phase) − sin(phase)), and turned as
/// far by angle.
struct OscillationDescription {
  Vec3 amplitude = Vec3::Zero(), angle = Vec3::Zero();  ///< of the displacement [m], of the rotation vector [rad]
  double frequency = 0;                                 ///< Hz
  double phase = 0;                                     ///< rad
  void declare(Parameters& p);
};
/// Along each axis a wall is fixed, has a velocity or oscillates, follows another wall, is servo-controlled, or is
/// free.
struct MotionDescription {
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
  std::optional<Vec3> about{};
  double ramp_time = 0;
  std::optional<OscillationDescription> oscillation{};
  std::optional<ServoDescription> servo{};
  std::optional<FollowDescription> follow{};
  std::optional<FreeDescription> free{};
  void declare(Parameters& p);
};
struct WallDescription {
  Component<Geometry> geometry;
  std::string material;
  MotionDescription motion;
  explicit WallDescription(const Registry& registry);
  void declare(Parameters& p);
};

// ---- the rest

struct MaterialDescription {
  double density = 2600;
  Description values = Description::object();  ///< of the parameters of the contact law, SI
  /// With a law, to read its parameters; without one, the values that there are.
  void declare(const std::string& name, ContactLaw* law, Parameters& p);
  bool operator==(const MaterialDescription&) const = default;
};
/// Where two materials meet, in either order.
struct InterfaceDescription {
  std::string a, b;                            ///< b is empty where the name had no "+"
  Description values = Description::object();  ///< of the parameters of the contact law, SI
  /// With the name that the description gives it, "a+b".
  explicit InterfaceDescription(const std::string& name);
  std::string name() const { return b.empty() ? a : a + '+' + b; }
  /// As that of a material.
  void declare(ContactLaw* law, Parameters& p);
  bool operator==(const InterfaceDescription&) const = default;
};
struct DomainDescription {
  std::optional<Vec3> low, high;
  std::array<bool, 3> periodic{false, false, false};
  Vec3 strain_rate = Vec3::Zero();
  std::vector<std::string> open_sides;
  void declare(Parameters& p);
};
struct SpecimenDescription {
  std::vector<std::string> low, high;  ///< walls of the x, y and z sides; "" where the domain bounds it
  void declare(Parameters& p);
};
struct TimeStepDescription {
  double safety = 0.8;
  double steps_per_impact = 7;  ///< (π/7)²/4: such an impact gains 5 % at most, what the energy guard allows
  std::optional<double> value;
  bool allow_unstable = false;
  void declare(Parameters& p);
};
struct GuardsDescription {
  double overlap = 0.2;  ///< of the smaller radius
  double travel = 0.05;  ///< of a radius, in one step
  double energy = 0.05;  ///< share of the energy that may appear from nowhere
  void declare(Parameters& p);
};
struct EngineDescription {
  Component<Engine> engine;
  explicit EngineDescription(const Registry& registry) : engine(registry) {}
  void declare(Parameters& p);
};
struct ProbeDescription {
  Component<Probe> probe;
  Cadence cadence;
  std::vector<std::string> stages;  ///< empty: all
  bool frames = true;               ///< whether its fields go into frames
  explicit ProbeDescription(const Registry& registry) : probe(registry) {}
  void declare(Parameters& p);
};

// ---- stages

struct Condition;
struct TimeCondition {
  static constexpr const char* type_name = "time";
  double value = 0;
  void declare(Parameters& p);
};
struct StepsCondition {
  static constexpr const char* type_name = "steps";
  std::int64_t value = 0;
  void declare(Parameters& p);
};
struct DisplacementCondition {
  static constexpr const char* type_name = "displacement";
  std::string wall, axis = "x";
  double value = 0;
  void declare(Parameters& p);
};
struct UnbalancedForceCondition {
  static constexpr const char* type_name = "unbalanced-force";
  double below = 1e-3;
  void declare(Parameters& p);
};
struct KineticEnergyCondition {
  static constexpr const char* type_name = "kinetic-energy";
  double below = 1e-4;
  void declare(Parameters& p);
};
struct VoidRatioCondition {
  static constexpr const char* type_name = "void-ratio";
  std::optional<double> below, above;
  void declare(Parameters& p);
};
struct MeanStressCondition {
  static constexpr const char* type_name = "mean-stress";
  std::optional<double> below, above;
  void declare(Parameters& p);
};
struct PressureCondition {
  static constexpr const char* type_name = "pressure";
  std::string wall;
  double value = 0, within = 0.01;
  void declare(Parameters& p);
};
struct LeftCondition {
  static constexpr const char* type_name = "left";
  double share = 1;
  void declare(Parameters& p);
};
/// Several conditions; here so that they can be copied where Condition is complete.
struct Conditions {
  std::vector<Condition> of;
  Conditions();
  Conditions(const Conditions&);
  Conditions(Conditions&&) noexcept;
  Conditions& operator=(const Conditions&);
  Conditions& operator=(Conditions&&) noexcept;
  ~Conditions();
};
struct AllCondition : Conditions {
  static constexpr const char* type_name = "all";
  void declare(Parameters& p);
};
struct AnyCondition : Conditions {
  static constexpr const char* type_name = "any";
  void declare(Parameters& p);
};
struct Condition {
  OneOf<TimeCondition, StepsCondition, DisplacementCondition, UnbalancedForceCondition, KineticEnergyCondition,
        VoidRatioCondition, MeanStressCondition, PressureCondition, LeftCondition, AllCondition, AnyCondition>
      is{"condition"};
  void declare(Parameters& p) { p.choose(is); }
};

/// A number of the description that changes during a stage, in equal increments.
struct RampDescription {
  std::string pointer;
  Description from, to;  ///< as the description would give them
  double duration = 0;
  std::int64_t increments = 50;
  void declare(Parameters& p);
};
/// Bodies that become larger where they are.
struct GrowthDescription {
  double rate = 0;  ///< 1/s, above 0
  void declare(Parameters& p);
};
struct ExpectDescription {
  std::optional<double> void_ratio;
  double within = 0.01;
  void declare(Parameters& p);
};
struct StageDescription {
  std::string name;
  Condition until;
  double limit = 0;                       ///< s of simulated time after which the stage has failed
  std::optional<double> usual_time = {};  ///< s that it takes as a rule, for estimates
  Description change = Description::object();
  std::deque<RampDescription> ramps;
  std::optional<GrowthDescription> growth;
  ExpectDescription expect;
  void declare(Parameters& p);
};

// ---- output

struct PictureDescription {
  std::string x;
  std::vector<std::string> y;
  std::string view = "xz";
  std::string color = "rotation";
  void declare(Parameters& p);
};
/// Complains of a name that is not "probe/channel"; "" passes.
void check_channel(const std::string& name, const char* key, const Complain& complain);

/// A curve from elsewhere: two columns of a CSV file, SI.
struct ReferenceCurve {
  std::string file, x, y;
  void declare(Parameters& p);
};

/// What a curve of the run is to be seen against: a value or a curve.
struct ReferenceDescription {
  std::string of, against;
  std::optional<double> value;
  std::optional<ReferenceCurve> curve;
  void declare(Parameters& p);
};
struct OutputDescription {
  Cadence frames;
  double checkpoint_every = 600;  ///< s of wall clock
  std::optional<PictureDescription> picture;
  std::map<std::string, ReferenceDescription> references;
  std::vector<std::string> summary;
  void declare(Parameters& p);
};

/// A whole scene. Every name in it (of a wall, a material, a stage) was checked to exist once it has been read.
struct SceneDescription {
  explicit SceneDescription(const Registry& registry);

  std::string title;
  std::int64_t seed = 1;
  Component<ContactLaw> contacts;
  std::map<std::string, MaterialDescription> materials;
  std::vector<InterfaceDescription> interfaces;  ///< in the order in which they were described
  DomainDescription domain;
  std::map<std::string, BodiesDescription> bodies;
  std::map<std::string, WallDescription> walls;
  std::map<std::string, EngineDescription> engines;
  SpecimenDescription specimen;
  TimeStepDescription time_step;
  GuardsDescription guards;
  std::deque<StageDescription> stages;
  std::map<std::string, ProbeDescription> probes;
  OutputDescription output;

  void declare(Parameters& p);

  /// The sections that a stage may change and ramp; of the domain only its strain rate.
  static const std::vector<std::string>& changeable();
  /// Declares one of these alone.
  void declare_section(const std::string& section, Parameters& p);
  /// Declares one entry of a section that has entries by name, or a section that has none, with a law to read
  /// parameters of materials. An entry that is not there is added. False if a description has no such section.
  bool declare_unit(const std::string& section, const std::string& name, ContactLaw* law, Parameters& p);
  /// Whether it is there.
  bool has_unit(const std::string& section, const std::string& name) const;
  /// The names of a section's entries; one empty name for a section that has none.
  std::vector<std::string> units_of(const std::string& section) const;
  /// Whether a changeable section has entries by name.
  static bool has_names(const std::string& section);
  /// Reports what does not fit together between sections that a stage may change.
  void check_together(const Complain& complain) const;
  /// The interface of this name; null if there is none.
  InterfaceDescription* find_interface(const std::string& name);

  const Registry& registry() const { return *registry_; }

 private:
  std::shared_ptr<ContactLaw> law_to_read() const;

  const Registry* registry_;
};

}  // namespace grit
