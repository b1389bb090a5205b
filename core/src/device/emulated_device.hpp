// A device emulated on the CPU: the same kernels in loops over bodies.
#pragma once

#include "device/device.hpp"
#include "threads/team.hpp"

namespace grit {

/// Its memory is memory of the process. Results are identical for any number of threads.
class EmulatedDevice final : public Device {
 public:
  explicit EmulatedDevice(Team& team) : team_(team) {}

  std::string name() const override { return "emulated device"; }
  void* allocate(std::size_t bytes) override;
  void release(void* memory) noexcept override;
  void write(void* to, const void* from, std::size_t bytes) override;
  void read(void* to, const void* from, std::size_t bytes) override;
  void evaluate(const ContactLaw& law, const DeviceLaw& on_device, const DevicePairs& pairs, const void* parameters,
                std::uint32_t bodies) override;
  void move(const DeviceMotion& motion) override;

 private:
  Team& team_;
};

}  // namespace grit
