// Checks of a restored state. A checkpoint may have been altered: what is used as an index or a length is checked
// first.
#pragma once

#include <string>

#include "grit/error.hpp"

namespace grit {

/// Throws Error unless a restored state fits; `fault`: what it would be, as "a contact is of a body that is not there".
inline void expect_restored(bool fits, const char* fault) {
  if (!fits)
    throw Error(std::string("the saved state is damaged or was altered: ") + fault +
                "; use another checkpoint, or start again");
}

}  // namespace grit
