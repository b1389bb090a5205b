// Frames, as `grit report` and runs that begin from them read them.
#include "fuzz.hpp"
#include "output/read_frames.hpp"
#include "storage/frame_state.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace grit;
  const auto path = fuzz::file_of_input("000000.h5", data, size);
  fuzz::allow_refusal([&] { read_frame(path); });
  fuzz::allow_refusal([&] { read_maps(path); });
  fuzz::allow_refusal([&] { read_frame_state(path); });
  return 0;
}
