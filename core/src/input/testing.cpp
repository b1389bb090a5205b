#include "grit/testing/reading.hpp"
#include "input/document.hpp"
#include "input/reader.hpp"

namespace grit {

std::vector<Problem> read_parameters(const Description& keys, Parameters& parameters) {
  std::vector<Problem> problems;
  read(Document(keys, "test"), "", parameters, problems);
  return problems;
}

}  // namespace grit
