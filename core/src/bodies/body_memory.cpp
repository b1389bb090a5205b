#include "bodies/body_memory.hpp"

#include <spdlog/fmt/fmt.h>

#include "format/resources.hpp"
#include "grit/error.hpp"

namespace grit {

std::string memory_fault(double bodies, double available) {
  const double needed = bytes_per_body * bodies;
  if (!(needed > available)) return "";
  return fault_text(
      fmt::format("{:.0f} bodies, which need about {} of memory with their contacts", bodies, bytes_text(needed)),
      fmt::format("up to {:.0f} here, as {} are available: use fewer bodies, or a machine with more memory",
                  available / bytes_per_body, bytes_text(available)));
}

}  // namespace grit
