#include "input/places.hpp"

#include <algorithm>
#include <optional>

namespace grit {
namespace {

bool is_at_or_in(const std::string& inner, const std::string& outer) {
  return inner.starts_with(outer) && (inner.size() == outer.size() || inner[outer.size()] == '/');
}

std::optional<std::string> written_by(const Document& document, const std::vector<std::string>& pointers,
                                      std::size_t stage) {
  const std::string at = "/stages/" + std::to_string(stage);
  const Description& described = document.json().at(Description::json_pointer(at));
  if (const auto ramps = described.find("ramps"); ramps != described.end() && ramps->is_array())
    for (std::size_t i = ramps->size(); i-- > 0;) {
      const std::string ramped = ramps->at(i).value("pointer", "");
      if (std::ranges::any_of(pointers, [&](const auto& one) { return is_at_or_in(ramped, one); }))
        return at + "/ramps/" + std::to_string(i);
    }
  for (const std::string& one : pointers)
    if (document.json().contains(Description::json_pointer(at + "/change" + one))) return at + "/change" + one;
  return std::nullopt;
}

}  // namespace

std::string written_last(const Document& document, const std::vector<std::string>& pointers, std::size_t stages) {
  for (std::size_t stage = stages; stage-- > 0;)
    if (const auto there = written_by(document, pointers, stage)) return *there;
  return pointers.front();
}

}  // namespace grit
