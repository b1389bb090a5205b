#include "report/description_differences.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "grit/toolkit/text_file.hpp"
#include "input/document.hpp"

namespace grit {
namespace {

constexpr std::size_t longest_vector = 6;  // that is one value: a tensor
constexpr std::size_t longest_object = 80;

/// A value of each run; null where a description has none.
using ValueOfEach = std::vector<const Description*>;

std::string value_text(const Description& value) {
  if (value.is_string()) return value == "" ? "\"\"" : value.get<std::string>();
  if (value.is_number_float()) return fmt::format("{}", value.get<double>());
  if (value.is_array() && value.size() > longest_vector) return fmt::format("{} entries", value.size());
  if (!value.is_structured()) return value.dump();
  std::vector<std::string> parts;
  for (const auto& [key, part] : value.items())
    parts.push_back(value.is_array() ? value_text(part) : key + ": " + value_text(part));
  const std::string text = fmt::format("{}", fmt::join(parts, ", "));
  return visible_text(value.is_array() ? "[" + text + "]" : "{" + text + "}", longest_object);
}

bool is_vector(const Description& value) {
  return value.is_array() && value.size() <= longest_vector &&
         std::ranges::none_of(value, [](const Description& part) { return part.is_structured(); });
}

class DescriptionComparison {
 public:
  /// Adds the differences at a pointer and below.
  void add(const ValueOfEach& values, const std::string& pointer) {
    const Description* const first = *std::ranges::find_if(values, [](const auto* value) { return value != nullptr; });
    const auto alike = [&](const Description* value) { return value == nullptr || *value == *first; };
    const bool all_alike = std::ranges::all_of(values, alike);
    const bool complete = std::ranges::find(values, nullptr) == values.end();
    if (all_alike && complete) return;
    const auto all_are = [&](auto holds) {
      return std::ranges::all_of(values, [&](const Description* value) { return value == nullptr || holds(*value); });
    };
    if (!all_alike && all_are([](const Description& value) { return value.is_object(); }))
      return add_members(values, pointer, {});
    if (!all_alike && complete && all_are([&](const Description& value) {
          return value.is_array() && value.size() == first->size() && !is_vector(value);
        }))
      return add_entries(values, pointer);
    found.push_back({pointer, {}});
    for (const Description* value : values) found.back().values.push_back(value == nullptr ? "" : value_text(*value));
  }

  /// The same for the members of objects, without some.
  void add_members(const ValueOfEach& values, const std::string& pointer, const std::vector<std::string>& without) {
    std::vector<std::string> keys;
    for (const Description* value : values)
      if (value != nullptr)
        for (const auto& [key, member] : value->items())
          if (std::ranges::find(keys, key) == keys.end() && std::ranges::find(without, key) == without.end())
            keys.push_back(key);
    for (const std::string& key : keys) add(members(values, key), pointer + '/' + pointer_token(key));
  }

  static ValueOfEach members(const ValueOfEach& values, const std::string& key) {
    ValueOfEach members;
    for (const Description* value : values)
      members.push_back(value != nullptr && value->contains(key) ? &value->at(key) : nullptr);
    return members;
  }

  std::vector<DescriptionDifference> found;

 private:
  void add_entries(const ValueOfEach& values, const std::string& pointer) {
    for (std::size_t i = 0; i < values.front()->size(); ++i) {
      ValueOfEach entries;
      for (const Description* value : values) entries.push_back(&value->at(i));
      add(entries, pointer + '/' + std::to_string(i));
    }
  }
};

std::vector<DescriptionDifference> complete_differences(const ValueOfEach& descriptions) {
  DescriptionComparison comparison;
  comparison.add_members(descriptions, "", {"title", "output"});
  return std::move(comparison.found);
}

/// None if the descriptions are not of one scenario.
std::vector<DescriptionDifference> written_differences(const ValueOfEach& unexpanded) {
  DescriptionComparison comparison;
  const auto type = [](const Description& description) {
    const Description::json_pointer at("/scenario/type");
    return description.contains(at) ? description.at(at) : Description();
  };
  const auto same_type = [&](const Description* one) { return type(*one) == type(*unexpanded.front()); };
  if (!std::ranges::all_of(unexpanded, same_type) || type(*unexpanded.front()).is_null()) return {};
  comparison.add(DescriptionComparison::members(unexpanded, "scenario"), "/scenario");
  comparison.add_members(unexpanded, "", {"scenario", "title", "output"});
  return std::move(comparison.found);
}

}  // namespace

std::vector<DescriptionDifference> description_differences(std::span<const RunResults> runs) {
  std::vector<std::size_t> described;
  for (std::size_t i = 0; i < runs.size(); ++i)
    if (runs[i].at("/description").is_object()) described.push_back(i);
  if (described.size() < 2) return {};
  const auto all = [&](const char* pointer) {
    ValueOfEach values;
    for (const std::size_t i : described) values.push_back(&runs[i].at(pointer));
    return values;
  };
  auto differences = complete_differences(all("/description"));
  if (differences.empty()) return {};
  if (auto written = written_differences(all("/source/unexpanded")); !written.empty()) differences = std::move(written);
  for (DescriptionDifference& difference : differences) {
    std::vector<std::string> values(runs.size());
    for (std::size_t i = 0; i < described.size(); ++i) values[described[i]] = std::move(difference.values[i]);
    difference.values = std::move(values);
  }
  return differences;
}

}  // namespace grit
