// Calibrations.
#include "calibration/description.hpp"
#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace grit;
  fuzz::allow_refusal([&] {
    const auto calibration = load_calibration(fuzz::file_of_input("calibration.json", data, size));
    for (const auto& [name, parameter] : calibration.parameters)
      parameter.value(parameter.place(parameter.first_value()));
  });
  return 0;
}
