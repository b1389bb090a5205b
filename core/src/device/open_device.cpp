#include "device/open_device.hpp"

#include <dlfcn.h>

#include <boost/preprocessor/stringize.hpp>
#include <filesystem>
#include <system_error>

#include "device/emulated_device.hpp"
#include "grit/error.hpp"
#include "plugins/loader.hpp"

namespace grit {
namespace {

std::filesystem::path gpu_component() { return library_directory() / "cuda.so"; }

std::unique_ptr<Device> open_gpu() {
  const auto file = gpu_component();
  if (!has_gpu_component())
    throw FileError("this build has no code for GPUs: " + file.string() +
                    " is missing; install CUDA and build again, or run it without --device gpu");
  void* const library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw FileError(file.string() + " cannot be opened: " + ::dlerror());
  void* const entry = ::dlsym(library, BOOST_PP_STRINGIZE(GRIT_CUDA_ENTRY));
  if (entry == nullptr) throw FileError(file.string() + " is of another build of grit; build or install both together");
  return std::unique_ptr<Device>(reinterpret_cast<Device* (*)()>(entry)());
}

}  // namespace

bool has_gpu_component() {
  std::error_code none;
  return std::filesystem::exists(gpu_component(), none);
}

std::unique_ptr<Device> open_device(DeviceKind kind, Team& team) {
  if (kind == DeviceKind::gpu) return open_gpu();
  return std::make_unique<EmulatedDevice>(team);
}

}  // namespace grit
