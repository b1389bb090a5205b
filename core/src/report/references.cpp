#include "report/references.hpp"

#include "format/symbols.hpp"
#include "output/reference_curve.hpp"

namespace grit {

std::vector<Reference> references_of(RunResults& run) {
  std::vector<Reference> all;
  for (const auto& [name, json] : run.at("/description/output/references").items()) try {
      Reference reference{
          .name = spelled(name), .of = json.at("of"), .against = json.value("against", ""), .value = {}};
      if (json.contains("value") && json.at("value").is_number()) {
        reference.value = json.at("value").get<double>();
      } else {
        const Description& curve = json.at("curve");
        ReferencePoints read = read_reference({curve.at("file"), curve.at("x"), curve.at("y")});
        reference.x = std::move(read.x), reference.y = std::move(read.y);
      }
      all.push_back(std::move(reference));
    } catch (const std::exception& error) {
      run.problems.push_back("reference " + name + ": " + error.what());
    }
  return all;
}

}  // namespace grit
