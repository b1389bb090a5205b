// Whether a value matters, by trying a little more and a little less of it.
#pragma once

#include <functional>
#include <string>

#include "grit/description.hpp"

namespace grit {

/// Whether all is the `same("other value, as JSON")` with 1 % more and less of a number, or of one with its unit as a
/// text; and with one more of a whole number, which may take no 1 %. False for 0, for all else, and where no other
/// value is allowed.
bool changes_nothing(const Description& value, const std::function<bool(const std::string&)>& same);

}  // namespace grit
