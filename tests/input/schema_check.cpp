#include "schema_check.hpp"

#include <fstream>
#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "grit/error.hpp"
#include "input/scene.hpp"
#include "simulation/live_scene.hpp"

namespace grit {

using Adapter = valijson::adapters::NlohmannJsonAdapter;

struct SchemaCheck::Parts {
  nlohmann::json json;  // outlives the schema, which refers to it
  valijson::Schema schema;
};

SchemaCheck::SchemaCheck(const Description& schema) : parts_(std::make_unique<Parts>()) {
  parts_->json = nlohmann::json::parse(schema.dump());
  valijson::SchemaParser(valijson::SchemaParser::kDraft7).populateSchema(Adapter(parts_->json), parts_->schema);
}
SchemaCheck::~SchemaCheck() = default;

std::string SchemaCheck::refusal(const std::filesystem::path& file) const {
  std::ifstream stream(file);
  const auto json = nlohmann::json::parse(stream);
  valijson::Validator validator;
  valijson::ValidationResults results;
  if (validator.validate(parts_->schema, Adapter(json), &results)) return {};
  std::string text = file.string() + ": ";
  for (valijson::ValidationResults::Error error; results.popError(error); text += error.description + '\n')
    for (const auto& part : error.context) text += part;
  return text;
}

std::string kernel_refusal(const std::filesystem::path& file, const Registry& registry) {
  try {
    const Scene scene = load_scene(file, {}, registry);
    LiveScene{scene};
    return {};
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace grit
