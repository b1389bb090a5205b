// A processor with memory of its own that steps bodies: a GPU, or its emulation on the CPU.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "device/device_motion.hpp"
#include "grit/contact/contact_law.hpp"
#include "grit/contact/device_pairs.hpp"

namespace grit {

/// Functions are called from the thread that owns the simulation. Work is done in the order of the calls; read() waits
/// for what was called before.
class Device {
 public:
  virtual ~Device() = default;
  virtual std::string name() const = 0;
  /// Memory of the device, aligned for any type; throws Error if there is not enough.
  virtual void* allocate(std::size_t bytes) = 0;
  virtual void release(void* memory) noexcept = 0;
  virtual void write(void* to, const void* from, std::size_t bytes) = 0;
  virtual void read(void* to, const void* from, std::size_t bytes) = 0;
  /// Runs the kernel of the law for so many bodies. `parameters`: those of `on_device` in the memory of the device.
  virtual void evaluate(const ContactLaw& law, const DeviceLaw& on_device, const DevicePairs& pairs,
                        const void* parameters, std::uint32_t bodies) = 0;
  /// Runs DeviceMotion for all its bodies, chunk by chunk.
  virtual void move(const DeviceMotion& motion) = 0;
};

/// An array in the memory of a device.
template <class T>
class DeviceArray {
 public:
  explicit DeviceArray(Device& device) : device_(device) {}
  ~DeviceArray() { device_.release(data_); }
  DeviceArray(const DeviceArray&) = delete;
  DeviceArray& operator=(const DeviceArray&) = delete;

  T* data() const { return static_cast<T*>(data_); }
  std::size_t size() const { return size_; }
  /// Its values are then undefined.
  void resize(std::size_t size) {
    if (size > room_) {
      device_.release(std::exchange(data_, nullptr));
      room_ = 0;
      data_ = device_.allocate((size + size / 16) * sizeof(T));
      room_ = size + size / 16;
    }
    size_ = size;
  }
  void write(std::span<const T> values) {
    resize(values.size());
    device_.write(data_, values.data(), values.size_bytes());
  }
  void read(std::span<T> values) const { device_.read(values.data(), data_, values.size_bytes()); }

 private:
  Device& device_;
  void* data_ = nullptr;
  std::size_t size_ = 0, room_ = 0;
};

}  // namespace grit
