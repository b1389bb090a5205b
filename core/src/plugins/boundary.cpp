#include "plugins/boundary.hpp"

#include <exception>
#include <new>

namespace grit {
void throw_boundary_error(const std::string& plugin, std::string_view function) {
  std::string what = "something that is not a std::exception";
  try {
    throw;
  } catch (const BoundaryError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    what = error.what();
  } catch (...) {
  }
  throw_boundary_fault(plugin, function, "threw:", what);
}

void throw_boundary_fault(const std::string& plugin, std::string_view function, std::string_view did,
                          const std::string& fault) {
  throw BoundaryError(plugin + ": its " + std::string(function) + ' ' + std::string(did) + ' ' + fault +
                      "\n  fix the plugin, or choose another one");
}

}  // namespace grit
