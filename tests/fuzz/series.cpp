// series.h5, as `grit report` reads it.
#include <chrono>

#include "fuzz.hpp"
#include "output/read_results.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace grit;
  fuzz::allow_refusal([&] {
    const auto path = fuzz::file_of_input("series.h5", data, size);
    const SeriesFile series(path.parent_path(), std::chrono::milliseconds(0));
    for (const std::string& name : series.channels()) fuzz::allow_refusal([&] { series.channel(name); });
  });
  return 0;
}
