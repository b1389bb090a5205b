// Calls into the code of plugins that should not throw.
#pragma once

#include <exception>
#include <string>

#include "grit/error.hpp"

namespace grit {

/// Returns `call()`. Any exception becomes a PluginError that names the plugin and the called function.
template <class Call>
decltype(auto) at_boundary(const std::string& plugin, const std::string& part, Call&& call) {
  const auto thrown = [&](const std::string& what) {
    return PluginError(plugin + ": its " + part + " threw: " + what + "\n  fix the plugin, or choose another one");
  };
  try {
    return call();
  } catch (const std::exception& error) {
    throw thrown(error.what());
  } catch (...) {
    throw thrown("something that is not a std::exception");
  }
}

}  // namespace grit
