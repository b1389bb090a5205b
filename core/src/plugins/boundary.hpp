// Calls into the code of plugins.
#pragma once

#include <string>
#include <string_view>
#include <typeinfo>

#include "grit/error.hpp"

namespace grit {

/// An exception out of a plugin, or a value that it must not return. Names the plugin; further ones that it passes are
/// not to blame.
class BoundaryError : public PluginError {
 public:
  using PluginError::PluginError;
};

/// To be called while an exception is handled. Throws a BoundaryError that names the plugin, the called function and
/// the cause. A BoundaryError passes, and so does std::bad_alloc: it is no fault of the plugin.
[[noreturn]] void throw_boundary_error(const std::string& plugin, std::string_view function);

/// Throws a BoundaryError: the function of the plugin `did` something, e.g. "returned", that is a `fault`.
[[noreturn]] void throw_boundary_fault(const std::string& plugin, std::string_view function, std::string_view did,
                                       const std::string& fault);

/// Returns `call()`. An exception becomes a BoundaryError.
template <class Call>
decltype(auto) at_boundary(const std::string& plugin, std::string_view function, Call&& call) {
  try {
    return call();
  } catch (...) {
    throw_boundary_error(plugin, function);
  }
}

/// The same of a function that may refuse what it is given: a ParameterError, a FileError or a plain Error passes, to
/// be reported at its place in the description.
template <class Call>
decltype(auto) at_boundary_unless_refused(const std::string& plugin, std::string_view function, Call&& call) {
  try {
    return call();
  } catch (const ParameterError&) {
    throw;
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    if (typeid(error) == typeid(Error)) throw;
    throw_boundary_error(plugin, function);
  } catch (...) {
    throw_boundary_error(plugin, function);
  }
}

}  // namespace grit
