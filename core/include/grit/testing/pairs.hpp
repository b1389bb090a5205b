// Spheres, and their pairs in the blocks that a contact law evaluates.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "grit/contact/contact_law.hpp"
#include "grit/contact/device_pairs.hpp"
#include "grit/contact/fields.hpp"

namespace grit::test {

/// A sphere with its state.
struct Ball {
  Vec3 position = Vec3::Zero();
  double radius = 1;
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
  double mass = 1;  ///< kg; infinite: fixed
  std::uint8_t material = 0;
};

/// Pairs in the memory layout of the kernel. Padding pairs a body with a dummy body far away, whose index is the number
/// of bodies.
class Pairs {
 public:
  explicit Pairs(const ContactLaw& law, double dt) : law_(&law), fields_(law.state()), dt(dt) { close(); }

  std::uint32_t add(const Ball& ball) {
    open();
    position_.push_back({ball.position.x(), ball.position.y(), ball.position.z(), ball.radius});
    velocity_.push_back({ball.velocity.x(), ball.velocity.y(), ball.velocity.z(), 1 / ball.mass});
    spin_.push_back({ball.spin.x(), ball.spin.y(), ball.spin.z(), 1 / (0.4 * ball.mass * ball.radius * ball.radius)});
    material_.push_back(ball.material);
    close();
    return static_cast<std::uint32_t>(count() - 1);
  }
  /// Pairs a with b at the next position; returns the position.
  std::size_t pair(std::uint32_t a, std::uint32_t b, std::uint8_t image = 0) {
    if (used_ == a_.size()) {
      a_.resize(used_ + block_size, 0), b_.resize(used_ + block_size, pad_), image_.resize(used_ + block_size, 0);
      touching_.push_back(0), acting_.push_back(0), row_.resize(used_ + block_size);
      state_.resize(state_.size() + fields_.size() * block_size, 0.0);
    }
    a_[used_] = a, b_[used_] = b, image_[used_] = image;
    return used_++;
  }
  /// Changes to another law; fields of the history that both have are kept.
  void change(const ContactLaw& law) {
    const std::vector<StateField> before = std::exchange(fields_, law.state());
    law_ = &law;
    const std::vector<double> all =
        std::exchange(state_, std::vector<double>(touching_.size() * fields_.size() * block_size, 0.0));
    for (const auto& [from, to] : moves_of_fields(before, fields_))
      for (std::size_t block = 0; block < touching_.size(); ++block)
        std::copy_n(all.begin() + static_cast<std::ptrdiff_t>((block * before.size() + from) * block_size), block_size,
                    state_.begin() + static_cast<std::ptrdiff_t>((block * fields_.size() + to) * block_size));
  }
  /// Makes the next pair a padding pair.
  void skip() { pair(0, pad_); }

  std::size_t count() const { return position_.size() - 1; }
  std::size_t places() const { return used_; }
  std::size_t fields() const { return fields_.size(); }
  Row& position(std::size_t i) { return position_[i]; }
  Row& velocity(std::size_t i) { return velocity_[i]; }
  Row& spin(std::size_t i) { return spin_[i]; }
  std::uint8_t material(std::size_t i) const { return material_[i]; }
  std::uint32_t a(std::size_t place) const { return a_[place]; }
  std::uint32_t b(std::size_t place) const { return b_[place]; }
  std::uint8_t image(std::size_t place) const { return image_[place]; }
  double& state(std::size_t place, std::size_t field) {
    return state_[(place / block_size * fields_.size() + field) * block_size + place % block_size];
  }
  std::vector<double> state(std::size_t place) {
    std::vector<double> numbers;
    for (std::size_t f = 0; f < fields_.size(); ++f) numbers.push_back(state(place, f));
    return numbers;
  }
  void mark_contacts(std::size_t place) { touching_[place / block_size] |= 1u << (place % block_size); }
  bool touching(std::size_t place) const { return (touching_[place / block_size] >> (place % block_size) & 1) != 0; }
  /// Whether it overlaps or has a force, with a law that has a reach.
  bool acts(std::size_t place) const { return (acting_[place / block_size] >> (place % block_size) & 1) != 0; }
  /// Results of the law: `row` acts on b, `sum` is the total of a body as `a` of its pairs.
  const ContactRow& row(std::size_t place) const { return row_[place]; }
  const BodySum& sum(std::size_t body) const { return sum_[body]; }
  double overlap(std::size_t place) const { return row_[place].moment.w; }
  double largest_overlap() const { return largest_overlap_; }

  void evaluate() { run(&ContactLaw::evaluate_pairs); }
  void evaluate_reference() { run(&ContactLaw::evaluate_pairs_reference); }
  /// As a chunk with all bodies: sums of both bodies, no rows.
  void evaluate_within() { run(&ContactLaw::evaluate_pairs, true); }
  /// As devices do, whose sums are the totals of both bodies. Returns whether both bodies of every pair have found the
  /// same bits.
  bool evaluate_on_device() {
    const auto bodies = static_cast<std::uint32_t>(count());
    std::vector<std::vector<std::pair<DeviceNeighbour, std::size_t>>> lists(bodies);  // with the position of the pair
    for (std::size_t c = 0; c < used_; ++c) {
      if (b_[c] == pad_) continue;
      lists[a_[c]].push_back({{.body = b_[c], .image = image_[c], .is_a = 0}, c});
      lists[b_[c]].push_back({{.body = a_[c], .image = image_[c], .is_a = 1}, c});
    }
    std::vector<std::uint32_t> first{0};
    std::vector<DeviceNeighbour> neighbours;
    std::vector<std::size_t> place;
    for (const auto& list : lists) {
      for (const auto& [neighbour, c] : list) neighbours.push_back(neighbour), place.push_back(c);
      first.push_back(static_cast<std::uint32_t>(neighbours.size()));
    }
    const std::size_t entries = place.size();
    std::vector<std::uint8_t> contact(entries);
    std::vector<double> histories(entries * fields_.size());
    for (std::size_t e = 0; e < entries; ++e) {
      contact[e] = static_cast<std::uint8_t>((touching(place[e]) ? DevicePairs::in_contact : 0) |
                                             (acts(place[e]) ? DevicePairs::is_acting : 0));
      for (std::size_t f = 0; f < fields_.size(); ++f) histories[f * entries + e] = state(place[e], f);
    }
    sum_.assign(position_.size(), {});
    const auto on_device = law_->device();
    const std::vector<std::byte> parameters(on_device->parameters.begin(), on_device->parameters.end());
    law_->evaluate_device_pairs({.position = position_.data(),
                                 .velocity = velocity_.data(),
                                 .spin = spin_.data(),
                                 .material = one_material ? nullptr : material_.data(),
                                 .shifts = shifts.empty() ? nullptr : shifts.data(),
                                 .first = first.data(),
                                 .neighbour = neighbours.data(),
                                 .contact = contact.data(),
                                 .state = histories.data(),
                                 .entries = entries,
                                 .dt = dt,
                                 .again = false,
                                 .sum = sum_.data()},
                                parameters.data(), 0, bodies);
    bool same = true;
    std::vector<std::size_t> entry(used_, entries);
    largest_overlap_ = 0;
    for (std::size_t body = 0; body < bodies; ++body) largest_overlap_ = std::max(largest_overlap_, sum_[body].force.w);
    for (std::size_t e = 0; e < entries; ++e) {
      const std::size_t c = place[e], other = std::exchange(entry[c], e);
      const auto bit = static_cast<std::uint8_t>(1u << (c % block_size));
      const auto set = [&](std::uint8_t& mask, std::uint8_t flag) {
        mask = static_cast<std::uint8_t>((contact[e] & flag) != 0 ? mask | bit : mask & ~bit);
      };
      set(touching_[c / block_size], DevicePairs::in_contact), set(acting_[c / block_size], DevicePairs::is_acting);
      for (std::size_t f = 0; f < fields_.size(); ++f) state(c, f) = histories[f * entries + e];
      if (other == entries) continue;
      same = same && contact[e] == contact[other];
      for (std::size_t f = 0; f < fields_.size(); ++f)
        same = same && histories[f * entries + e] == histories[f * entries + other];
    }
    return same;
  }
  /// Evaluates again at the same instant.
  void evaluate_again() { run(&ContactLaw::evaluate_pairs, false, true); }
  /// Moves all bodies through one step, then evaluates.
  void step() {
    for (std::size_t i = 0; i < count(); ++i) {
      Row &x = position_[i], &v = velocity_[i];
      x.x += dt * v.x, x.y += dt * v.y, x.z += dt * v.z;
    }
    for (ImageShift& shift : shifts) {
      Row &x = shift.position, &v = shift.velocity;
      x.x += dt * v.x, x.y += dt * v.y, x.z += dt * v.z;
    }
    evaluate();
  }
  /// Lets the forces act on velocities and spins for one step.
  void kick() {
    std::vector<BodySum> total = sum_;
    for (std::size_t c = 0; c < used_; ++c) total[b_[c]].force += row_[c].force, total[b_[c]].moment += row_[c].moment;
    for (std::size_t i = 0; i < count(); ++i) {
      Row &v = velocity_[i], &w = spin_[i];
      const Row &f = total[i].force, &m = total[i].moment;
      v = {v.x + dt * v.w * f.x, v.y + dt * v.w * f.y, v.z + dt * v.w * f.z, v.w};
      w = {w.x + dt * w.w * m.x, w.y + dt * w.w * m.y, w.z + dt * w.w * m.z, w.w};
    }
  }

 private:
  void open() { position_.pop_back(), velocity_.pop_back(), spin_.pop_back(), material_.pop_back(); }
  void close() {
    position_.push_back({1e18, 1e18, 1e18, 0}), velocity_.push_back({}), spin_.push_back({}), material_.push_back(0);
    const auto last = static_cast<std::uint32_t>(count());
    std::replace(b_.begin(), b_.end(), pad_, last);
    pad_ = last;
  }
  void run(void (ContactLaw::*evaluate)(PairBatch&) const, bool within = false, bool again = false) {
    sum_.assign(position_.size(), {});
    PairBatch batch{.position = position_.data(),
                    .velocity = velocity_.data(),
                    .spin = spin_.data(),
                    .a = a_.data(),
                    .b = b_.data(),
                    .image = shifts.empty() ? nullptr : image_.data(),
                    .material = one_material ? nullptr : material_.data(),
                    .shifts = shifts.data(),
                    .first_block = 0,
                    .last_block = a_.size() / block_size,
                    .last_near = a_.size() / block_size,
                    .last_body = static_cast<std::uint32_t>(count() - 1),
                    .dummy_body = pad_,
                    .next = nullptr,
                    .next_first = 0,
                    .next_count = 0,
                    .dt = dt,
                    .again = again,
                    .closing = closing,
                    .state = state_.data(),
                    .touching = touching_.data(),
                    .acting = acting_.data(),
                    .asleep_until = asleep_until.empty() ? nullptr : asleep_until.data(),
                    .row = within ? nullptr : row_.data(),
                    .sum = sum_.data(),
                    .largest_overlap = std::numeric_limits<double>::quiet_NaN(),
                    .losses = losses};
    (law_->*evaluate)(batch);
    largest_overlap_ = batch.largest_overlap;
  }

  const ContactLaw* law_;
  std::vector<StateField> fields_;
  std::vector<Row> position_, velocity_, spin_;
  std::vector<std::uint8_t> material_, image_, touching_, acting_;
  std::vector<std::uint32_t> a_, b_;
  std::vector<double> state_;
  std::vector<ContactRow> row_;
  std::vector<BodySum> sum_;
  std::uint32_t pad_ = 0;
  std::size_t used_ = 0;
  double largest_overlap_ = 0;

 public:
  double dt;
  bool one_material = true;
  double closing = 0;
  std::vector<float> asleep_until;  ///< by block; empty: none is skipped
  std::vector<ImageShift> shifts;   ///< the first must be zero
  Losses* losses = nullptr;         ///< added to
};

inline Vec3 vec(const Row& row) { return xyz(row); }
inline void set(Row& row, const Vec3& v) { row = {v.x(), v.y(), v.z(), row.w}; }

/// A sphere in contact with a wall at rest or in motion.
class WallPair {
 public:
  WallPair(const ContactLaw& law, const Ball& ball, double dt) : law_(&law), dt_(dt), state_(law.state().size()) {
    position = {ball.position.x(), ball.position.y(), ball.position.z(), ball.radius};
    velocity = {ball.velocity.x(), ball.velocity.y(), ball.velocity.z(), 1 / ball.mass};
    spin = {ball.spin.x(), ball.spin.y(), ball.spin.z(), 1 / (0.4 * ball.mass * ball.radius * ball.radius)};
  }
  /// Evaluates `contact`, which the caller must have set.
  void evaluate() {
    sum = {};
    contact.body = 0;
    WallBatch batch{.position = &position,
                    .velocity = &velocity,
                    .spin = &spin,
                    .material = nullptr,
                    .count = 1,
                    .contact = &contact,
                    .dt = dt_,
                    .again = false,
                    .state = state_.data(),
                    .row = &row,
                    .sum = &sum,
                    .largest_overlap = 0,
                    .losses = nullptr};
    law_->evaluate_walls(batch);
  }
  /// Changes to another law; fields of the history that both have are kept.
  void change(const ContactLaw& law) {
    const std::vector<StateField> before = law_->state(), now = law.state();
    const std::vector<double> all = std::exchange(state_, std::vector<double>(now.size(), 0.0));
    for (const auto& [from, to] : moves_of_fields(before, now)) state_[to] = all[from];
    law_ = &law;
  }
  void clear() { state_.assign(state_.size(), 0.0); }
  std::vector<double>& state() { return state_; }
  /// The moment of the law on the wall, without that of the shear force.
  Vec3 law_moment() const { return vec(row.moment) - contact.overlap * contact.normal.cross(vec(row.force)); }

  Row position, velocity, spin;
  WallContact contact{.normal = -Vec3::UnitZ(),
                      .normal_before = -Vec3::UnitZ(),
                      .velocity = Vec3::Zero(),
                      .spin = Vec3::Zero(),
                      .overlap = 0,
                      .body = 0,
                      .wall = 0,
                      .feature = 0,
                      .material = 0};
  ContactRow row;
  BodySum sum;

 private:
  const ContactLaw* law_;
  double dt_;
  std::vector<double> state_;
};

}  // namespace grit::test
