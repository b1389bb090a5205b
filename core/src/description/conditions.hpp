// Conditions that end stages.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "grit/parameters.hpp"

namespace grit {

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

}  // namespace grit
