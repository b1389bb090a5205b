#include "errors.hpp"

#include <array>
#include <exception>
#include <filesystem>
#include <string>

#include "format/message.hpp"
#include "grit/error.hpp"
#include "input/document.hpp"
#include "interpreter.hpp"

namespace grit::python {
namespace {

namespace py = pybind11;

py::object& family() {
  static auto& kept = *new py::object;  // never destroyed: the interpreter may end before
  return kept;
}

/// Raises an exception of grit.errors, made of what it is given.
template <class... Arguments>
void raise(const char* name, const Arguments&... arguments) {
  try {
    const py::object type = family().attr(name);
    PyErr_SetObject(type.ptr(), call(type, py::make_tuple(arguments...)).ptr());
  } catch (py::error_already_set& other) {  // such as a Ctrl-C just now
    other.restore();
  }
}

py::list problems_of(const DescriptionError& error) {
  const py::object problem = family().attr("Problem");
  py::list problems;
  for (const Problem& one : error.problems()) {
    const py::object line = one.line > 0 ? py::object(py::int_(one.line)) : py::none();
    problems.append(call(problem, py::make_tuple(one.file, line, one.pointer, one.message)));
  }
  return problems;
}

const char* name_of(Guard guard) {
  static constexpr std::array names{"none",   "overlap", "travel",  "energy",       "finite",
                                    "domain", "period",  "arrival", "critical_step"};
  return names[static_cast<std::size_t>(guard)];
}

void translate(std::exception_ptr thrown) {
  try {
    std::rethrow_exception(std::move(thrown));
  } catch (const DescriptionError& error) {
    raise("DescriptionError", error.what(), problems_of(error));
  } catch (const NumericsError& error) {
    raise("NumericsError", error.what(), error.cause(), name_of(error.guard()), pointer_of(error.keys()));
  } catch (const PluginError& error) {
    raise("PluginError", error.what());
  } catch (const FileError& error) {
    raise("FileError", error.what());
  } catch (const Error& error) {
    raise("Error", error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    raise("FileError", message_of(error));
  }
}

}  // namespace

void translate_errors(const py::module_& errors) {
  family() = errors;
  py::register_local_exception_translator(translate);
}

}  // namespace grit::python
