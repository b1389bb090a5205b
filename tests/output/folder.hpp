// A folder of a test, and what errors say.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "support/own_folder.hpp"

namespace grit {

using Folder = OwnFolder;

/// What the error of type E says that `act` throws.
template <class E, class Act>
std::string error_of(Act act) {
  try {
    act();
  } catch (const E& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

}  // namespace grit
