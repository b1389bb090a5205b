// Whether a JSON Schema and the kernel accept a description file. For a test over sims/:
//   const SchemaCheck schema(scene_schema(registry));
//   for (const auto& file : files) EXPECT_EQ(schema.refusal(file), ""), EXPECT_EQ(kernel_refusal(file, registry), "");
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "grit/description.hpp"
#include "plugins/registry.hpp"

namespace grit {

class SchemaCheck {
 public:
  explicit SchemaCheck(const Description& schema);
  ~SchemaCheck();
  /// Why a file is refused; empty if it is accepted.
  std::string refusal(const std::filesystem::path& file) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Why the kernel refuses a file; empty if it accepts the file with all its stages.
std::string kernel_refusal(const std::filesystem::path& file, const Registry& registry);

}  // namespace grit
