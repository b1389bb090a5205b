// A test's folder, and error messages.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "support/own_folder.hpp"

namespace grit {

using Folder = OwnFolder;

/// The message of the error of type E that `act` throws.
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
