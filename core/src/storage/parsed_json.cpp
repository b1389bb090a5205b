#include "storage/parsed_json.hpp"

namespace grit {

Description parsed_json(const std::string& text) {
  constexpr int most_levels = 100;
  bool too_deep = false;
  Description json = Description::parse(
      text,
      [&](int depth, Description::parse_event_t event, Description&) {
        using Event = Description::parse_event_t;
        const bool opens = event == Event::array_start || event == Event::object_start;
        too_deep = too_deep || (opens && depth >= most_levels);
        return !too_deep;
      },
      false);
  return too_deep ? Description(Description::value_t::discarded) : json;
}

}  // namespace grit
