// The plain description as typed values, without live components. Each parameter is declared here and nowhere else:
// reading, checks, schema and reference pages are derived from these declarations.
#pragma once

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grit/description.hpp"
#include "grit/parameters.hpp"
#include "plugins/component.hpp"

namespace grit {

/// Due each time a wall has moved by `value`, in either direction, since the last time.
struct DisplacementCadence {
  std::string wall, axis = "x";
  double value = 0;  ///< m, above 0
  void declare(Parameters& p);
};
/// Interval of a repeated event. None given: never.
struct Cadence {
  std::optional<double> every_time;
  std::int64_t every_steps = 0;
  std::optional<DisplacementCadence> every_displacement;
  std::optional<double> every_discharged;  ///< fraction of the mass of all bodies so far
  bool never() const { return !every_time && every_steps == 0 && !every_displacement && !every_discharged; }
  void declare(Parameters& p);
};

// ---- grains

struct UniformSizes {
  static constexpr const char* type_name = "uniform";
  static constexpr const char* type_doc = "all diameters from smallest to largest are equally frequent, by number";
  double smallest = 0.25e-3, largest = 0.75e-3;
  void declare(Parameters& p);
};
struct LinearSizes {
  static constexpr const char* type_name = "linear";
  static constexpr const char* type_doc =
      "the mass that passes a sieve increases linearly from the smallest to the largest diameter";
  double smallest = 0.25e-3, largest = 0.75e-3;
  void declare(Parameters& p);
};
struct LogNormalSizes {
  static constexpr const char* type_name = "log-normal";
  static constexpr const char* type_doc =
      "the logarithm of the diameter is normally distributed, by number; cut at the smallest and largest";
  double median = 0.5e-3, log_standard_deviation = 0.25, smallest = 0.25e-3, largest = 1e-3;
  void declare(Parameters& p);
};
struct SieveSizes {
  static constexpr const char* type_name = "sieve";
  static constexpr const char* type_doc = "sieve curve: the mass that passes increases linearly between the sieves";
  std::vector<double> diameters, passing;
  void declare(Parameters& p);
};
struct ListSizes {
  static constexpr const char* type_name = "list";
  static constexpr const char* type_doc = "diameters one by one";
  std::vector<double> diameters;
  void declare(Parameters& p);
};
struct ShapeSizes {
  static constexpr const char* type_name = "shape";
  static constexpr const char* type_doc = "all clumps have the size in which their shape is given, by a list or a file";
  void declare(Parameters&) {}
};
using Sizes = OneOf<UniformSizes, LinearSizes, LogNormalSizes, SieveSizes, ListSizes, ShapeSizes>;

/// Equal bodies at regular positions.
struct LatticeSource {
  static constexpr const char* type_name = "lattice";
  static constexpr const char* type_doc = "equal bodies on a crystal lattice";
  std::string kind = "simple-cubic";
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  double diameter = 0;            ///< m
  std::optional<double> spacing;  ///< of nearest neighbours, m; none: the diameter
  void declare(Parameters& p);
};
/// A text file with a body in each line, written by grit or another code.
struct FileSource {
  static constexpr const char* type_name = "file";
  static constexpr const char* type_doc = "bodies from a text file";
  /// What columns may hold: x, y, z, r (radius), d (diameter), velocity, spin, type, id; - is skipped.
  static const std::vector<std::string>& column_names();
  std::string path, format = "auto";
  std::vector<std::string> columns;  ///< empty: those of the format
  std::int64_t header_lines = 0;
  double scale = 1;             ///< m
  std::string particle_type;    ///< empty: all
  std::int64_t time_step = -1;  ///< below 0: the last one
  void declare(Parameters& p);
};
struct ListedBody {
  Vec3 position = Vec3::Zero(), velocity = Vec3::Zero(), spin = Vec3::Zero(), orientation = Vec3::Zero();
  double radius = 0;
  void declare(Parameters& p);
};
struct ListSource {
  static constexpr const char* type_name = "list";
  static constexpr const char* type_doc = "bodies one by one";
  std::deque<ListedBody> bodies;
  void declare(Parameters& p);
};
/// The bodies of the group of this name in the sample from which the run begins.
struct SampleSource {
  static constexpr const char* type_name = "sample";
  static constexpr const char* type_doc =
      "the bodies of the group of this name in the sample that /begin names, with their positions and velocities";
  void declare(Parameters&) {}
};
struct RectangleRegion {
  static constexpr const char* type_name = "rectangle";
  static constexpr const char* type_doc = "a parallelogram";
  Vec3 corner = Vec3::Zero(), edge_a = Vec3::Zero(), edge_b = Vec3::Zero();
  void declare(Parameters& p);
};
struct DiscRegion {
  static constexpr const char* type_name = "disc";
  static constexpr const char* type_doc = "a circular disc";
  Vec3 centre = Vec3::Zero(), normal = Vec3::UnitZ();
  double radius = 0;
  void declare(Parameters& p);
};
struct BoxRegion {
  static constexpr const char* type_name = "box";
  static constexpr const char* type_doc = "a box along the axes";
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  void declare(Parameters& p);
};
struct SphereRegion {
  static constexpr const char* type_name = "sphere";
  static constexpr const char* type_doc = "a sphere";
  Vec3 centre = Vec3::Zero();
  double radius = 0;
  void declare(Parameters& p);
};
struct CylinderRegion {
  static constexpr const char* type_name = "cylinder";
  static constexpr const char* type_doc = "a circular cylinder";
  Vec3 start = Vec3::Zero(), end = Vec3::Zero();
  double radius = 0;
  void declare(Parameters& p);
};
struct HalfSpaceRegion {
  static constexpr const char* type_name = "half-space";
  static constexpr const char* type_doc = "all that is behind a plane";
  Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();
  void declare(Parameters& p);
};
/// The inside of a closed surface.
struct MeshRegion {
  static constexpr const char* type_name = "mesh";
  static constexpr const char* type_doc = "the inside of a closed surface from an STL file";
  std::string path;
  double scale = 0;  ///< m
  Vec3 position = Vec3::Zero();
  void declare(Parameters& p);
};
/// What a cloud fills.
struct CloudRegion {
  OneOf<BoxRegion, SphereRegion, CylinderRegion, MeshRegion> is{"region"};
  void declare(Parameters& p) { p.choose(is); }
};
/// Bodies at random positions without overlap.
struct CloudSource {
  static constexpr const char* type_name = "cloud";
  static constexpr const char* type_doc = "bodies at random positions without overlap";
  std::optional<Vec3> low, high;      ///< of a box
  std::optional<CloudRegion> region;  ///< instead
  std::int64_t count = 0;
  Sizes sizes{"size distribution"};
  std::string plane_normal = "none";
  void declare(Parameters& p);
};
/// Bodies that enter one after the other during the run.
struct StreamSource {
  static constexpr const char* type_name = "stream";
  static constexpr const char* type_doc = "bodies that enter through a region at a rate, during the run";
  OneOf<RectangleRegion, DiscRegion, BoxRegion> region{"region"};
  std::optional<double> number_rate, mass_rate;  ///< 1/s, kg/s
  Sizes sizes{"size distribution"};
  std::int64_t count = 0;            ///< limit; 0: none
  std::optional<double> mass, time;  ///< limits [kg, s]
  void declare(Parameters& p);
};

struct BodiesDescription {
  Component<BodyKind> kind;
  std::string material;
  std::string stage;  ///< at the start of which they appear; empty: the start of the run
  Vec3 velocity = Vec3::Zero();
  static constexpr double usual_overlap = 0.01;
  double overlap = usual_overlap;  ///< of the smaller radius
  OneOf<CloudSource, FileSource, LatticeSource, ListSource, StreamSource, SampleSource> source{"source of bodies"};
  bool is_from_sample() const { return std::holds_alternative<SampleSource>(source.value()); }
  explicit BodiesDescription(const Registry& registry);
  void declare(Parameters& p);
};

// ---- walls

struct ServoDescription {
  std::string axis = "z";
  std::optional<double> pressure{};  ///< Pa, compression positive
  std::optional<double> force{};     ///< N, of the wall on the bodies, along the axis
  double max_velocity = 0;           ///< m/s
  double gain = 1;                   ///< fraction of the force error corrected per step if contacts are elastic
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
/// Rotation under the moment of bodies, about an axis through the reference point of the wall.
struct FreeRotationDescription {
  Vec3 axis = Vec3::Zero();  ///< of any length above 0
  double inertia = 0;        ///< kg m²
  double moment = 0;         ///< external, N m
  void declare(Parameters& p);
};
/// Added to velocity and spin. The displacement after t is amplitude × (sin(2π f t + φ) − sin(φ)) along each axis, the
/// rotation the same with angle.
struct OscillationDescription {
  Vec3 amplitude = Vec3::Zero(), angle = Vec3::Zero();              ///< of displacement [m], of rotation vector [rad]
  double frequency = 0;                                             ///< Hz
  double phase = 0;                                                 ///< rad
  Vec3 amplitude_phase = Vec3::Zero(), angle_phase = Vec3::Zero();  ///< added to phase, by axis [rad]
  Vec3 phases_of_displacement() const { return amplitude_phase.array() + phase; }
  Vec3 phases_of_rotation() const { return angle_phase.array() + phase; }
  void declare(Parameters& p);
};
/// Along each axis a wall is fixed, has a velocity or oscillates, follows another wall, is servo-controlled, or is
/// free.
struct MotionDescription {
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
  /// Of the surface relative to the wall, in the axes of the wall [m/s, rad/s]; bodies feel the part along the surface.
  Vec3 surface_velocity = Vec3::Zero(), surface_spin = Vec3::Zero();
  std::optional<Vec3> about{};
  double ramp_time = 0;
  std::optional<OscillationDescription> oscillation{};
  std::optional<ServoDescription> servo{};
  std::optional<FollowDescription> follow{};
  std::optional<FreeDescription> free{};
  std::optional<FreeRotationDescription> free_rotation{};
  bool surface_moves() const { return !surface_velocity.isZero(0.0) || !surface_spin.isZero(0.0); }
  void declare(Parameters& p);
};
struct WallDescription {
  Component<Geometry> geometry;
  std::string material;
  std::vector<std::string> groups;  ///< of bodies on which it acts; empty: all
  MotionDescription motion;
  explicit WallDescription(const Registry& registry);
  void declare(Parameters& p);
};

// ---- the rest

struct MaterialDescription {
  double density = 2600;
  Description values = Description::object();  ///< of the parameters of the contact law, SI
  /// With a law: declares its parameters, for reading. Without: declares the present values.
  void declare(const std::string& name, ContactLaw* law, Parameters& p);
  bool operator==(const MaterialDescription&) const = default;
};
/// Contact of two materials, in either order.
struct InterfaceDescription {
  std::string a, b;                            ///< b is empty if the name had no "+"
  Description values = Description::object();  ///< of the parameters of the contact law, SI
  /// `name` as in the description, "a+b".
  explicit InterfaceDescription(const std::string& name);
  std::string name() const { return b.empty() ? a : a + '+' + b; }
  /// The same as name() == other.
  bool is_named(std::string_view other) const {
    return b.empty() ? other == a
                     : other.size() == a.size() + 1 + b.size() && other.starts_with(a) && other[a.size()] == '+' &&
                           other.ends_with(b);
  }
  /// As MaterialDescription::declare().
  void declare(ContactLaw* law, Parameters& p);
  bool operator==(const InterfaceDescription&) const = default;
};
/// Names of the components of strain and stress of a cell.
inline const std::array<std::string, 6> cell_components{"xx", "yy", "zz", "xy", "xz", "yz"};
/// Target stresses of a cell [Pa]; components without one keep their strain rate.
struct CellStressDescription {
  std::optional<double> xx, yy, zz, xy, xz, yz;
  void declare(Parameters& p);
};
/// The strain rate of a periodic cell that keeps stresses.
struct CellServoDescription {
  CellStressDescription stress;
  double max_strain_rate = 0;  ///< 1/s
  double gain = 1;
  std::int64_t interval = 10;  ///< steps
  /// xx, yy, zz, xy, xz, yz
  std::array<std::optional<double>, 6> targets() const {
    return {stress.xx, stress.yy, stress.zz, stress.xy, stress.xz, stress.yz};
  }
  void declare(Parameters& p);
};
/// Gradients of the mean flow of a cell [1/s], of the first component along the second axis.
struct ShearRateDescription {
  double xy = 0, xz = 0, yz = 0;
  Vec3 vector() const { return {xy, xz, yz}; }
  void declare(Parameters& p);
};
struct DomainDescription {
  std::optional<Vec3> low, high;
  std::array<bool, 3> periodic{false, false, false};
  Vec3 strain_rate = Vec3::Zero();
  ShearRateDescription shear_rate;
  std::optional<CellServoDescription> servo;
  std::vector<std::string> open_sides;
  /// Keys that stages may change.
  static const std::vector<std::string>& changeable();
  /// Whether images may move off the axes.
  bool shears() const {
    return !shear_rate.vector().isZero(0.0) || (servo && (servo->stress.xy || servo->stress.xz || servo->stress.yz));
  }
  /// Whether the cell may change its shape.
  bool deforms() const { return servo || shears() || !strain_rate.isZero(0.0); }
  void declare(Parameters& p);
};
/// A prepared sample from which a run begins: the state of another run.
struct BeginDescription {
  std::string from;  ///< its folder of results
  std::string at = "end";
  std::int64_t frame = -1;     ///< below 0: the last one
  std::optional<double> time;  ///< of the frame [s]
  std::string springs = "keep";
  void declare(Parameters& p);
};
struct SpecimenDescription {
  std::vector<std::string> low, high;  ///< walls at the x, y and z sides; "": bound of the domain
  void declare(Parameters& p);
};
struct TimeStepDescription {
  double safety = 0.8;
  double steps_per_impact = 7;  ///< (π/7)²/4: such an impact gains at most 5 % energy, the limit of the energy guard
  std::optional<double> max_displacement;  ///< of a body or wall per step, over the radius
  std::optional<double> value;
  bool allow_unstable = false;
  void declare(Parameters& p);
};
struct GuardsDescription {
  double overlap = 0.2;  ///< of the smaller radius
  double travel = 0.05;  ///< of the radius, per step
  double energy = 0.05;  ///< spurious gain, fraction of the energy
  void declare(Parameters& p);
};
/// The displacement per step to which the time step is limited, over the radius.
double max_displacement(const TimeStepDescription& time_step, const GuardsDescription& guards);
struct EngineDescription {
  Component<Engine> engine;
  std::vector<std::string> groups;  ///< of bodies on which it acts; empty: all
  explicit EngineDescription(const Registry& registry) : engine(registry) {}
  void declare(Parameters& p);
  bool acts_on(const std::string& group) const {
    return groups.empty() || std::ranges::find(groups, group) != groups.end();
  }
};
struct ProbeDescription {
  Component<Probe> probe;
  Cadence cadence;
  std::vector<std::string> groups;  ///< of bodies that it samples; empty: all
  std::vector<std::string> stages;  ///< empty: all
  bool frames = true;               ///< whether its fields are written to frames
  explicit ProbeDescription(const Registry& registry) : probe(registry) {}
  void declare(Parameters& p);
};

// ---- stages

struct Condition;
struct TimeCondition {
  static constexpr const char* type_name = "time";
  static constexpr const char* type_doc = "this time has passed since the stage began";
  double value = 0;
  void declare(Parameters& p);
};
struct StepsCondition {
  static constexpr const char* type_name = "steps";
  static constexpr const char* type_doc = "this number of steps was taken since the stage began";
  std::int64_t value = 0;
  void declare(Parameters& p);
};
struct DisplacementCondition {
  static constexpr const char* type_name = "displacement";
  static constexpr const char* type_doc = "a wall has moved this far since the stage began";
  std::string wall, axis = "x";
  double value = 0;
  void declare(Parameters& p);
};
struct UnbalancedForceCondition {
  static constexpr const char* type_name = "unbalanced-force";
  static constexpr const char* type_doc = "the unbalanced force is below a limit";
  double below = 1e-3;
  void declare(Parameters& p);
};
struct AtRestCondition {
  static constexpr const char* type_name = "at-rest";
  static constexpr const char* type_doc = "all bodies are at rest on their contacts";
  double below = 0.01;
  void declare(Parameters& p);
};
struct KineticEnergyCondition {
  static constexpr const char* type_name = "kinetic-energy";
  static constexpr const char* type_doc = "kinetic over elastic energy is below a limit; free spin does not decay";
  double below = 1e-4;
  void declare(Parameters& p);
};
struct VoidRatioCondition {
  static constexpr const char* type_name = "void-ratio";
  static constexpr const char* type_doc = "the specimen is denser or looser than a limit";
  std::optional<double> below, above;
  void declare(Parameters& p);
};
struct MeanStressCondition {
  static constexpr const char* type_name = "mean-stress";
  static constexpr const char* type_doc = "the mean stress of the specimen is below or above a limit";
  std::optional<double> below, above;
  void declare(Parameters& p);
};
struct StressCondition {
  static constexpr const char* type_name = "stress";
  static constexpr const char* type_doc = "a component of the stress of the specimen has reached a value";
  std::string component = "zz";
  double value = 0, within = 0.01;
  void declare(Parameters& p);
};
struct PressureCondition {
  static constexpr const char* type_name = "pressure";
  static constexpr const char* type_doc = "the pressure on a wall has reached a value";
  std::string wall;
  double value = 0, within = 0.01;
  void declare(Parameters& p);
};
struct DischargedCondition {
  static constexpr const char* type_name = "discharged";
  static constexpr const char* type_doc = "this fraction of the mass has been discharged through open sides";
  double fraction = 1;
  void declare(Parameters& p);
};
/// Several conditions. Its members are defined where Condition is complete.
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
  static constexpr const char* type_doc = "all of several conditions hold";
  void declare(Parameters& p);
};
struct AnyCondition : Conditions {
  static constexpr const char* type_name = "any";
  static constexpr const char* type_doc = "one of several conditions holds";
  void declare(Parameters& p);
};
struct Condition {
  OneOf<TimeCondition, StepsCondition, DisplacementCondition, UnbalancedForceCondition, AtRestCondition,
        KineticEnergyCondition, VoidRatioCondition, MeanStressCondition, StressCondition, PressureCondition,
        DischargedCondition, AllCondition, AnyCondition>
      is{"condition"};
  void declare(Parameters& p) { p.choose(is); }
};

/// A number of the description that changes during a stage, in equal increments.
struct RampDescription {
  std::string pointer;
  Description from, to;  ///< as in the description
  double duration = 0;
  std::int64_t increments = 50;
  void declare(Parameters& p);
};
/// Bodies that grow in place.
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
  double limit = 0;                         ///< simulated time after which the stage fails, s
  std::optional<double> typical_time = {};  ///< simulated, for estimates, s
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
/// Ends of a colour scale, in SI.
struct ColorScaleDescription {
  std::string of;
  std::optional<double> low, high;
  void declare(Parameters& p);
};
/// Reports a name that is not "probe/channel"; "" is allowed.
void check_channel(const std::string& name, const char* key, const Complain& complain);

/// A reference curve: two columns of a CSV file, SI.
struct ReferenceCurve {
  std::string file, x, y;
  void declare(Parameters& p);
};

/// A reference for a curve of the run: a value or a curve.
struct ReferenceDescription {
  std::string of, against;
  std::optional<double> value;
  std::optional<ReferenceCurve> curve;
  void declare(Parameters& p);
};
struct FramesDescription : Cadence {
  std::vector<std::string> formats;  ///< beside HDF5
  bool never() const { return Cadence::never() && formats.empty(); }
  void declare(Parameters& p);
};
struct OutputDescription {
  FramesDescription frames;
  double checkpoint_every = 600;  ///< s of wall clock
  std::optional<PictureDescription> picture;
  std::deque<ColorScaleDescription> color_scales;
  std::map<std::string, ReferenceDescription> references;
  std::vector<std::string> summary;
  void declare(Parameters& p);
};

/// A complete scene. Reading checks that every name in it (of a wall, a material, a stage) exists.
struct SceneDescription {
  explicit SceneDescription(const Registry& registry);

  std::string title;
  std::int64_t seed = 1;
  Component<ContactLaw> contacts;
  std::map<std::string, MaterialDescription> materials;
  std::vector<InterfaceDescription> interfaces;  ///< in written order
  DomainDescription domain;
  std::optional<BeginDescription> begin;
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

  /// The sections that a stage may change or ramp; in the domain only the strain rate.
  static const std::vector<std::string>& changeable();
  /// Declares one of these sections.
  void declare_section(const std::string& section, Parameters& p);
  /// Declares one entry of a section with named entries, or a section without them; `law` reads the parameters of
  /// materials. An entry that does not exist is added. False if there is no such section.
  bool declare_unit(const std::string& section, const std::string& name, ContactLaw* law, Parameters& p);
  /// Whether this entry or section exists.
  bool has_unit(const std::string& section, const std::string& name) const;
  /// The names of a section's entries; one empty name for a section without named entries.
  std::vector<std::string> units_of(const std::string& section) const;
  /// Whether a changeable section has entries by name.
  static bool has_names(const std::string& section);
  /// Reports inconsistencies between sections that a stage may change.
  void check_together(const Complain& complain) const;
  /// Names of all materials, also of those that stages add; ascending.
  std::vector<std::string> names_of_materials() const;
  /// The interface of this name; null if there is none.
  InterfaceDescription* find_interface(const std::string& name);

  const Registry& registry() const { return *registry_; }

 private:
  std::shared_ptr<ContactLaw> law_to_read() const;

  const Registry* registry_;
};

}  // namespace grit
