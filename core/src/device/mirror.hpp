// Bodies and contacts in the memory of a device, where they are stepped.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bodies/bodies.hpp"
#include "contact/contact_table.hpp"
#include "device/device.hpp"
#include "motion/motion.hpp"

namespace grit {

/// While a device steps the bodies, what it has is the truth: the host's bodies and contacts are copies that are
/// brought up to date when something asks for them. Contact histories that the host advances for a sample are not sent
/// back, so that a run does not depend on what is sampled; those at the end of a stage are. Neighbour lists are made by
/// the host.
class DeviceMirror {
 public:
  explicit DeviceMirror(std::unique_ptr<Device> device);

  /// After the host has changed bodies, lists or settings: the next step sends them.
  void request() { requested_ = true; }
  bool requested() const { return requested_; }
  /// Sends everything. `advanced`: contact histories already include this instant.
  void take(const Bodies& bodies, const ContactTable& pairs, std::shared_ptr<const ContactLaw> law, bool one_material,
            bool advanced);

  /// Whether contact histories on the device already include this instant.
  bool advanced() const { return advanced_; }
  /// Evaluates all pairs and moves all bodies by one step. Returns the extremes by chunk. `shifts`: of periodic images;
  /// `dt`: of the last step [s].
  std::span<const DeviceChunk> step(const ImageShift* shifts, double dt, const MotionStep& step);

  /// Bring the host's copies up to date.
  void fetch(Bodies& bodies) const;
  void fetch(ContactTable& pairs) const;

 private:
  void take_lists(const ContactTable& pairs, std::size_t bodies);

  std::unique_ptr<Device> device_;
  DeviceArray<Row> position_, velocity_, spin_;
  DeviceArray<double> rotation_, state_;
  DeviceArray<std::uint8_t> material_, contact_;
  DeviceArray<std::uint32_t> first_;
  DeviceArray<DeviceNeighbour> neighbour_;
  DeviceArray<ImageShift> shifts_;
  DeviceArray<BodySum> sum_;
  DeviceArray<DeviceChunk> chunk_;
  DeviceArray<std::byte> parameters_;
  std::shared_ptr<const ContactLaw> law_;
  DeviceLaw on_device_;
  std::vector<std::uint32_t> entry_;  // of each candidate of the table, in the list of its a
  std::vector<DeviceChunk> chunks_;
  std::size_t fields_ = 0;
  bool requested_ = true, advanced_ = false, periodic_ = false;
};

}  // namespace grit
