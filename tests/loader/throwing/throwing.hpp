// Plugins that work, unless $THROW_IN names one of their functions: that one throws what $THROW_WHAT names, or ends the
// process by exit(0); after $THROW_AFTER calls, if that is set.
#pragma once

#include <atomic>
#include <cstdlib>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>

#include "grit/error.hpp"
#include "grit/parameters.hpp"
#include "grit/plugin.hpp"

namespace throwing {

inline void here(const char* function) {
  const char* const where = std::getenv("THROW_IN");
  if (where == nullptr || std::string(where) != function) return;
  static std::atomic<int> calls = 0;
  const char* const after = std::getenv("THROW_AFTER");
  if (after != nullptr && calls++ < std::atoi(after)) return;
  const std::string what = std::getenv("THROW_WHAT");
  if (what == "std::exception") throw std::runtime_error("lost my way");
  if (what == "grit::Error") throw grit::Error("lost my way");
  if (what == "grit::PluginError") throw grit::PluginError("lost my way");
  if (what == "grit::FileError") throw grit::FileError("lost my way");
  if (what == "grit::ParameterError") throw grit::ParameterError({{"way", "none", "one"}});
  if (what == "std::bad_alloc") throw std::bad_alloc();
  if (what == "exit(0)") std::exit(0);
  throw 42;
}

/// An object in the parameters of a plugin.
struct Part {
  void declare(grit::Parameters& p) {
    here("declare() of a nested object");
    p.check([](const grit::Complain&) { here("check of parameters"); });
  }
};

/// A way that a choice offers.
struct Way {
  static constexpr const char *type_name = "way", *type_doc = "the only one";
  Way() { here("choose()"); }
  void declare(grit::Parameters& p) {
    here("declare() of a choice");
    p.check([](const grit::Complain&) { here("check of parameters"); });
  }
};

struct ChosenWay {
  grit::OneOf<Way> one{"way"};
  void declare(grit::Parameters& p) { p.choose(one); }
};

/// Declares a nested object, a list of such, a choice, a check and a function to be called when the object was read.
inline void declare(const char* function, grit::Parameters& p) {
  here(function);
  static Part part;
  static std::deque<Part> parts;
  p.add("part", part);
  p.add("parts", parts);
  static std::optional<ChosenWay> chosen;
  p.add("way", chosen);
  p.check([](const grit::Complain&) { here("check of parameters"); });
  p.when_read([] { here("when_read()"); });
}

/// The PluginInfo of a plugin whose make_ function is set by `set`.
template <class Set>
const grit::PluginInfo* plugin(const char* kind, const char* name, Set set) {
  here("grit_plugin()");
  static grit::PluginInfo info;
  info.kind = kind, info.name = name, info.version = "1.0.0", info.doc = "of the tests of the boundary";
  set(info);
  return &info;
}

}  // namespace throwing
