// Devices by their kind.
#pragma once

#include <memory>

#include "device/device.hpp"
#include "grit/simulation.hpp"
#include "threads/team.hpp"

namespace grit {

/// Whether this build has the component for GPUs.
bool has_gpu_component();
/// `team`: threads of an emulated device, which must live as long. Throws FileError if there is no such device.
std::unique_ptr<Device> open_device(DeviceKind kind, Team& team);

}  // namespace grit
