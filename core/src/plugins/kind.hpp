// The kinds of plugins: name, folder and the member of PluginInfo that creates one.
#pragma once

#include "grit/plugin.hpp"

namespace grit {

template <class Interface>
constexpr const char* kind_name();
template <>
constexpr const char* kind_name<BodyKind>() {
  return "body";
}
template <>
constexpr const char* kind_name<ContactLaw>() {
  return "contact";
}
template <>
constexpr const char* kind_name<Engine>() {
  return "engine";
}
template <>
constexpr const char* kind_name<Geometry>() {
  return "geometry";
}
template <>
constexpr const char* kind_name<Probe>() {
  return "probe";
}
template <>
constexpr const char* kind_name<Scenario>() {
  return "scenario";
}

/// The make_ member of PluginInfo for an interface.
template <class Interface>
inline constexpr Interface* (*PluginInfo::*maker)() = nullptr;
template <>
inline constexpr auto maker<BodyKind> = &PluginInfo::make_body;
template <>
inline constexpr auto maker<ContactLaw> = &PluginInfo::make_contact;
template <>
inline constexpr auto maker<Engine> = &PluginInfo::make_engine;
template <>
inline constexpr auto maker<Geometry> = &PluginInfo::make_geometry;
template <>
inline constexpr auto maker<Probe> = &PluginInfo::make_probe;
template <>
inline constexpr auto maker<Scenario> = &PluginInfo::make_scenario;

struct Kind {
  const char* name;
  const char* folder;                    ///< below a plugin directory
  bool (*has_maker)(const PluginInfo&);  ///< whether the plugin has the make_ function of this kind
};

template <class Interface>
constexpr Kind kind_of(const char* folder) {
  return {kind_name<Interface>(), folder, [](const PluginInfo& info) { return info.*maker<Interface> != nullptr; }};
}

inline constexpr Kind kinds[] = {kind_of<BodyKind>("bodies"), kind_of<ContactLaw>("contacts"),
                                 kind_of<Engine>("engines"),  kind_of<Geometry>("geometry"),
                                 kind_of<Probe>("probes"),    kind_of<Scenario>("scenarios")};

}  // namespace grit
