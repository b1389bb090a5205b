#include "grit/testing/reading.hpp"
#include "input/document.hpp"
#include "input/reader.hpp"
#include "input/units.hpp"

namespace grit {

std::vector<Problem> read_parameters(const Description& keys, Parameters& parameters) {
  std::vector<Problem> problems;
  read(Document(keys, "test"), "", parameters, problems);
  return problems;
}

bool is_unit(const std::string& text) {
  try {
    return !text.empty() && !unit_spellings(text).empty();
  } catch (const PluginError&) {
    return false;
  }
}

}  // namespace grit
