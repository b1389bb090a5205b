// Files of checkpoints, as bytes. Their seal finds nearly every change; state.cpp is about what it does not find.
#include "fuzz.hpp"
#include "storage/state_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace grit;
  fuzz::allow_refusal([&] { read_state(fuzz::file_of_input("checkpoint.h5", data, size)); });
  return 0;
}
