#include "app/installation.hpp"

#include <boost/dll/runtime_symbol_info.hpp>
#include <system_error>

namespace grit {
namespace fs = std::filesystem;

fs::path beside_program(std::initializer_list<const char*> inner) {
  for (fs::path above = boost::dll::program_location().string(); above.has_relative_path();) {
    above = above.parent_path();
    for (const char* each : inner)
      if (std::error_code none; fs::exists(above / each, none)) return above / each;
  }
  return {};
}

fs::path documentation() {
  // A page that no other docs/ is likely to have.
  constexpr const char *installed = "share/doc/grit/docs/plugins/contact-law.md", *tree = "docs/plugins/contact-law.md";
  return beside_program({installed, tree}).parent_path().parent_path().parent_path();
}

}  // namespace grit
