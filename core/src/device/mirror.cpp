#include "device/mirror.hpp"

#include <numeric>
#include <utility>

#include "grit/error.hpp"

namespace grit {
namespace {

constexpr std::uint32_t no_entry = ~0u;

}  // namespace

DeviceMirror::DeviceMirror(std::unique_ptr<Device> device)
    : device_(std::move(device)),
      position_(*device_),
      velocity_(*device_),
      spin_(*device_),
      rotation_(*device_),
      state_(*device_),
      material_(*device_),
      contact_(*device_),
      first_(*device_),
      neighbour_(*device_),
      shifts_(*device_),
      sum_(*device_),
      chunk_(*device_),
      parameters_(*device_) {}

void DeviceMirror::take(const Bodies& bodies, const ContactTable& pairs, std::shared_ptr<const ContactLaw> law,
                        bool one_material, bool advanced) {
  const std::size_t count = bodies.count();
  const auto own = [count](const auto& array) { return std::span(array.data(), count); };
  position_.write(own(bodies.position)), velocity_.write(own(bodies.velocity)), spin_.write(own(bodies.spin));
  material_.write(one_material ? std::span<const std::uint8_t>() : own(bodies.material));
  rotation_.write(bodies.rotation.empty() ? std::span<const double>()
                                          : std::span(bodies.rotation.front().data(), 3 * count));
  law_ = std::move(law);
  const auto on_device = law_->device();
  if (!on_device) throw Error("the contact law cannot be evaluated on a device");
  on_device_ = *on_device;
  parameters_.write(on_device_.parameters);
  fields_ = law_->state().size();
  take_lists(pairs, count);
  sum_.resize(count), chunk_.resize(chunks_of(count)), chunks_.resize(chunks_of(count));
  advanced_ = advanced, requested_ = false;
}

void DeviceMirror::take_lists(const ContactTable& pairs, std::size_t bodies) {
  std::vector<std::uint32_t> first(bodies + 1, 0);
  std::size_t entries = 0;
  pairs.each_candidate([&](std::size_t c) { ++first[pairs.a(c) + 1], ++first[pairs.b(c) + 1], entries += 2; });
  if (entries >= no_entry) throw Error("there are too many pairs of bodies near each other for a device");
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  std::vector<DeviceNeighbour> neighbours(entries);
  std::vector<std::uint8_t> contact(entries, 0);
  std::vector<double> state(entries * fields_, 0.0);
  entry_.assign(pairs.candidates(), no_entry);
  periodic_ = false;
  pairs.each_candidate([&](std::size_t c) {
    const std::uint32_t a = pairs.a(c), b = pairs.b(c), of_a = next[a]++, of_b = next[b]++;
    const std::uint16_t image = pairs.image(c);
    periodic_ = periodic_ || image != 0;
    neighbours[of_a] = {.body = b, .image = image, .is_a = 0},
    neighbours[of_b] = {.body = a, .image = image, .is_a = 1};
    entry_[c] = of_a;
    if (!pairs.contacts(c)) return;
    contact[of_a] = contact[of_b] =
        static_cast<std::uint8_t>(DevicePairs::in_contact | (pairs.acts(c) ? DevicePairs::is_acting : 0));
    const std::vector<double> history = pairs.state(c);
    for (std::size_t f = 0; f < fields_; ++f) state[f * entries + of_a] = state[f * entries + of_b] = history[f];
  });
  first_.write(first), neighbour_.write(neighbours), contact_.write(contact), state_.write(state);
}

std::span<const DeviceChunk> DeviceMirror::step(const ImageShift* shifts, double dt, const MotionStep& step) {
  const auto bodies = static_cast<std::uint32_t>(position_.size());
  if (periodic_) shifts_.write({shifts, all_images});
  const DevicePairs pairs{.position = position_.data(),
                          .velocity = velocity_.data(),
                          .spin = spin_.data(),
                          .material = material_.size() > 0 ? material_.data() : nullptr,
                          .shifts = periodic_ ? shifts_.data() : nullptr,
                          .first = first_.data(),
                          .neighbour = neighbour_.data(),
                          .contact = contact_.data(),
                          .state = state_.data(),
                          .entries = contact_.size(),
                          .dt = dt,
                          .again = advanced_,
                          .sum = sum_.data()};
  device_->evaluate(*law_, on_device_, pairs, parameters_.data(), bodies);
  device_->move({.position = position_.data(),
                 .velocity = velocity_.data(),
                 .spin = spin_.data(),
                 .sum = sum_.data(),
                 .rotation = rotation_.size() > 0 ? rotation_.data() : nullptr,
                 .chunk = chunk_.data(),
                 .bodies = bodies,
                 .drift = step.drift,
                 .kick = kick_of<Four>(step.settings, step),
                 .mean = mean_flow_of<Four>(step),
                 .shears = step.shears()});
  chunk_.read(chunks_);
  advanced_ = false;
  return chunks_;
}

void DeviceMirror::fetch(Bodies& bodies) const {
  const auto own = [&](auto& array) { return std::span(array.data(), bodies.count()); };
  position_.read(own(bodies.position)), velocity_.read(own(bodies.velocity)), spin_.read(own(bodies.spin));
  if (rotation_.size() > 0) rotation_.read({bodies.rotation.front().data(), rotation_.size()});
}

void DeviceMirror::fetch(ContactTable& pairs) const {
  std::vector<std::uint8_t> contact(contact_.size());
  std::vector<double> state(state_.size());
  contact_.read(contact), state_.read(state);
  pairs.each_candidate([&](std::size_t c) {
    const std::uint32_t entry = entry_[c];
    const bool touches = (contact[entry] & DevicePairs::in_contact) != 0;
    pairs.set_contact(c, touches, (contact[entry] & DevicePairs::is_acting) != 0);
    for (std::size_t f = 0; f < fields_; ++f) pairs.set_history(c, f, state[f * contact.size() + entry]);
  });
}

}  // namespace grit
