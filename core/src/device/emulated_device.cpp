#include "device/emulated_device.hpp"

#include <cstring>
#include <new>

namespace grit {

namespace {
constexpr std::align_val_t alignment{64};
}

void* EmulatedDevice::allocate(std::size_t bytes) { return ::operator new(bytes, alignment); }

void EmulatedDevice::release(void* memory) noexcept { ::operator delete(memory, alignment); }

void EmulatedDevice::write(void* to, const void* from, std::size_t bytes) {
  if (bytes > 0) std::memcpy(to, from, bytes);
}

void EmulatedDevice::read(void* to, const void* from, std::size_t bytes) {
  if (bytes > 0) std::memcpy(to, from, bytes);
}

void EmulatedDevice::evaluate(const ContactLaw& law, const DeviceLaw&, const DevicePairs& pairs, const void* parameters,
                              std::uint32_t bodies) {
  team_.each(chunks_of(bodies), [&](std::size_t chunk) {
    const ChunkRange range(chunk, bodies);
    law.evaluate_device_pairs(pairs, parameters, static_cast<std::uint32_t>(range.first),
                              static_cast<std::uint32_t>(range.last));
  });
}

void EmulatedDevice::move(const DeviceMotion& motion) {
  team_.each(chunks_of(motion.bodies), [&](std::size_t chunk) {
    const ChunkRange range(chunk, motion.bodies);
    DeviceChunk all = motion(static_cast<std::uint32_t>(range.first));
    for (std::size_t i = range.first + 1; i < range.last; ++i)
      all = DeviceChunk::join(all, motion(static_cast<std::uint32_t>(i)));
    motion.chunk[chunk] = all;
  });
}

}  // namespace grit
