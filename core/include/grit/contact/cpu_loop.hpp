// The loops over pairs and wall contacts that call a law, for CPUs. They are templates of the law, so that its plugin
// compiles them with evaluate() inlined.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

#include "grit/contact/batch.hpp"
#include "grit/contact/contact_law.hpp"
#include "grit/contact/contact_point.hpp"
#include "grit/contact/law.hpp"
#include "grit/contact/law_members.hpp"
#include "grit/contact/pair_point.hpp"

namespace grit {

namespace detail {

template <class Law, unsigned Features, class L>
[[gnu::always_inline]] constexpr Loss<L> losses_of(const ContactPoint<L>& at,
                                                   const typename Law::template Pair<L>& pair,
                                                   const typename Law::template State<L>& before,
                                                   const typename Law::template State<L>& after,
                                                   const Response<L>& response) {
  if constexpr (Law::traits.losses) return Law::template losses<Features>(at, pair, before, after, response);
  else return {};
}

/// `left`: minus the dissipation of each lane.
template <class L>
inline void add_losses(const Loss<L>& left, Losses& losses) {
  losses.friction -= total(left.friction), losses.rolling -= total(left.rolling);
  losses.viscosity -= total(left.viscosity);
}

/// Parameters of contacts, one contact per lane.
template <class Law, class L, class Index>
[[gnu::always_inline]] constexpr auto load_pair(const typename Law::template Pair<double>* table, Index index) {
  typename Law::template Pair<L> pair;
  for (std::size_t m = 0; m < member_count<typename Law::template Pair<double>, double>; ++m) {
    const auto number = [&](std::size_t k) { return reinterpret_cast<const double*>(table + index(k))[m]; };
    member<L>(pair, m) = gather_lanes<L>(number);
  }
  return pair;
}

/// The same where all contacts are between the same two materials.
template <class Law, class L>
[[gnu::always_inline]] constexpr auto broadcast_pair(const typename Law::template Pair<double>& numbers) {
  typename Law::template Pair<L> pair;
  for (std::size_t m = 0; m < member_count<typename Law::template Pair<double>, double>; ++m)
    member<L>(pair, m) = L(reinterpret_cast<const double*>(&numbers)[m]);
  return pair;
}

/// Prefetches bodies and contact histories: memory latency is as long as several contacts, and the processor cannot
/// predict the order of the bodies.
class Ahead {
 public:
  [[gnu::always_inline]] constexpr Ahead(const PairBatch& batch, std::size_t fields) : batch_(batch), fields_(fields) {
    const std::size_t blocks = std::max<std::size_t>(1, batch.last_near - batch.first_block);
    share_ = (batch.next_count + blocks - 1) / blocks;
    // A cache line holds two rows.
    step_ = batch.next == nullptr ? 64 / sizeof(Row) : 1;
    share_ = (share_ + step_ - 1) / step_ * step_;
  }
  /// Prefetches some of the bodies, and the contact history of the block after next if it has contacts.
  [[gnu::always_inline]] constexpr void operator()(std::size_t block) const {
    const double* const state = batch_.state + (block + 2) * fields_ * block_size;
    if (block + 2 < batch_.last_block && batch_.touching[block + 2] != 0)
      for (std::size_t f = 0; f < fields_; ++f) __builtin_prefetch(state + f * block_size, 1);
    const std::size_t first = (block - batch_.first_block) * share_;
    const std::size_t last = std::min<std::size_t>(batch_.next_count, first + share_);
    for (std::size_t k = first; k < last; k += step_) {
      const std::size_t i = batch_.next != nullptr ? batch_.next[k] : batch_.next_first + k;
      __builtin_prefetch(batch_.position + i), __builtin_prefetch(batch_.velocity + i),
          __builtin_prefetch(batch_.spin + i);
    }
  }

 private:
  const PairBatch& batch_;
  std::size_t fields_, share_, step_;
};

/// Collects contacts of registers with few of them, to evaluate them together. In flowing material most candidate pairs
/// are not in contact, and those in contact change all the time.
template <std::size_t Fields>
class Waiting {
 public:
  void add(std::size_t place) { place_[count_++] = place; }
  bool none() const { return count_ == 0; }
  bool has_room_for_a_block() const { return count_ + block_size <= most; }

  /// The collected contacts as a batch of their own, which adds to the same sums.
  PairBatch take(const PairBatch& from) {
    const std::size_t blocks = (count_ + block_size - 1) / block_size;
    for (std::size_t k = 0; k < blocks * block_size; ++k) {
      const bool used = k < count_;
      a_[k] = from.a[place_[used ? k : 0]], b_[k] = used ? from.b[place_[k]] : from.dummy_body;
      image_[k] = used && from.image != nullptr ? from.image[place_[k]] : 0;
      for (std::size_t f = 0; f < Fields; ++f) history(state_, k, f) = used ? history(from.state, place_[k], f) : 0;
    }
    std::fill_n(touching_, blocks, std::uint8_t{0});  // no contact opens here
    PairBatch own = from;
    own.a = a_, own.b = b_, own.image = from.image != nullptr ? image_ : nullptr;
    own.first_block = 0, own.last_block = own.last_near = blocks, own.next_count = 0;
    own.state = state_, own.touching = touching_, own.asleep_until = nullptr;
    own.acting = from.acting != nullptr ? acting_ : nullptr;
    own.row = from.row != nullptr ? row_ : nullptr;
    return own;
  }
  /// Writes their histories and rows back, and empties the collection.
  void put_back(const PairBatch& to) {
    for (std::size_t k = 0; k < count_; ++k) {
      for (std::size_t f = 0; f < Fields; ++f) history(to.state, place_[k], f) = history(state_, k, f);
      if (to.row != nullptr) to.row[place_[k] - to.first_block * block_size] = row_[k];
      if (to.acting != nullptr && (acting_[k / block_size] >> (k % block_size) & 1) != 0)
        to.acting[place_[k] / block_size] |= static_cast<std::uint8_t>(1u << (place_[k] % block_size));
    }
    count_ = 0;
  }

 private:
  static constexpr std::size_t most = 64;
  static double& history(double* state, std::size_t place, std::size_t f) {
    return state[(place / block_size * Fields + f) * block_size + place % block_size];
  }

  std::size_t count_ = 0;
  std::size_t place_[most];
  std::uint32_t a_[most], b_[most];
  std::uint8_t image_[most], touching_[most / block_size] = {}, acting_[most / block_size] = {};
  alignas(64) double state_[most * Fields + block_size];
  ContactRow row_[most];
};

/// Collects opened contacts with their histories. They are rare and evaluated outside the loop.
template <std::size_t Fields>
class Parted {
 public:
  bool has_room_for_a_block() const { return count_ + block_size <= most; }
  void add(std::size_t place, const double* state) {
    place_[count_] = place;
    for (std::size_t f = 0; f < Fields; ++f) state_[count_ * Fields + f] = state[f * block_size];
    ++count_;
  }
  /// Calls use(place, state) for each, and empties the collection.
  template <class Use>
  void take(Use use) {
    for (std::size_t k = 0; k < count_; ++k) use(place_[k], std::span<const double>(state_ + k * Fields, Fields));
    count_ = 0;
  }

 private:
  static constexpr std::size_t most = 64;
  std::size_t count_ = 0;
  std::size_t place_[most];
  double state_[most * Fields + 1];
};

/// Books the elastic energy of the springs of an opened contact as dissipated, and that of a bond that broke.
template <class Law, unsigned Features>
void lose_springs(const PairBatch& batch, const typename Law::template Pair<double>* table, std::size_t materials,
                  std::size_t place, std::span<const double> history) {
  const std::uint32_t a = batch.a[place], b = batch.b[place];
  Vec3 between = xyz(batch.position[b]) - xyz(batch.position[a]),
       apart = xyz(batch.velocity[b]) - xyz(batch.velocity[a]);
  if (batch.image != nullptr && batch.image[place] != 0) {
    const ImageShift& shift = batch.shifts[batch.image[place]];
    between += xyz(shift.position), apart += xyz(shift.velocity);
  }
  const double radius_a = batch.position[a].w, radius_b = batch.position[b].w;
  // When they were last in contact.
  const double overlap = radius_a + radius_b - (between - batch.dt * apart).norm();
  typename Law::template State<double> state{};
  for (std::size_t f = 0; f < history.size(); ++f) member<double>(state, kept_fields<Law, Features>[f]) = history[f];
  const std::size_t kind = batch.material != nullptr ? batch.material[a] * materials + batch.material[b] : 0;
  const PairSize size{.radius_a = radius_a,
                      .radius_b = radius_b,
                      .inverse_mass_a = batch.velocity[a].w,
                      .inverse_mass_b = batch.velocity[b].w,
                      .overlap = Law::traits.reach ? overlap : std::max(0.0, overlap),
                      .wall = false};
  const ElasticEnergy held = Law::energy(size, table[kind], state);
  batch.losses->friction += held.shear, batch.losses->rolling += held.rolling;
  if (size.overlap < 0) batch.losses->viscosity += held.normal;
}

/// The loop over candidate pairs. L is Lane or SingleLane, or a number for the scalar reference. It starts with block
/// `from` and stops when `waiting` or `parted`, if given, is full; returns the next block. Flattened: a call in it
/// would pass lanes through memory, which was measured to double the time. Not inlined, so that tests/vectorisation
/// finds it. The arithmetic is the same for all pairs, so that the result of a pair does not depend on its position in
/// the list.
template <class Law, unsigned Features, class L, bool Periodic, bool OneKind, bool EnergyTerms>
[[gnu::flatten, gnu::noinline]] std::size_t pair_loop(PairBatch& out, const typename Law::template Pair<double>* table,
                                                      std::size_t materials, std::size_t from,
                                                      Waiting<kept_fields<Law, Features>.size()>* waiting,
                                                      Parted<kept_fields<Law, Features>.size()>* parted) {
  constexpr auto& kept = kept_fields<Law, Features>;
  constexpr std::size_t width = lane_width<L>, fields = kept.size();
  using State = typename Law::template State<L>;
  const PairBatch batch = out;  // a copy, which sums cannot alias
  using W = Wide<L>;
  const PairStep<L> step(batch.dt, batch.again);
  L largest(0.0);
  // Losses are subtracted: of a law without losses the compiler removes x − 0, but not x + 0.
  Loss<W> left{W(0.0), W(0.0), W(0.0)};
  const std::size_t first_row = batch.first_block * block_size;
  const std::uint32_t last_body = batch.last_body;
  const Ahead ahead(batch, fields);
  // Registers with fewer contacts than this are collected. Measured: 55 ns per collected contact, nearly half of it for
  // copying, and 125 ns per register.
  constexpr int few = width * 3 / 4;

  std::size_t block = from;
  for (; block < batch.last_block; ++block) {
    if (waiting != nullptr && !waiting->has_room_for_a_block()) break;
    if (EnergyTerms && parted != nullptr && !parted->has_room_for_a_block()) break;
    ahead(block);
    const std::uint32_t before = batch.touching[block];
    if (before == 0 && batch.asleep_until != nullptr && batch.closing < batch.asleep_until[block]) continue;
    std::uint32_t contacts_now = 0;
    [[maybe_unused]] std::uint32_t acting_now = 0;
    L gap(std::numeric_limits<float>::max());
    for (std::size_t sub = 0; sub < block_size; sub += width) {
      const std::size_t first = block * block_size + sub;
      const std::uint32_t* ia = batch.a + first;
      const std::uint32_t* ib = batch.b + first;
      const auto index_a = [=](std::size_t k) { return ia[k]; };
      const auto index_b = [=](std::size_t k) { return ib[k]; };
      const auto image = [&](std::size_t k) { return batch.image[first + k]; };
      const auto shift = [&](std::size_t k) { return image(k) * (sizeof(ImageShift) / sizeof(Row)); };

      // Contact and overlap, a small difference of large numbers, are computed in double precision.
      const RowLanes<W> pa = load_rows<W>(batch.position, index_a), pb = load_rows<W>(batch.position, index_b);
      Vec<W> between = pb.xyz() - pa.xyz();
      bool shifted = false;
      if constexpr (Periodic) {
        if (batch.image != nullptr)
          for (std::size_t k = 0; k < width; ++k) shifted |= image(k) != 0;
        if (shifted) between = between + load_rows<W>(&batch.shifts->position, shift).xyz();
      }
      const W square = dot(between, between), radii = pa.w + pb.w;
      typename Law::template Pair<L> pair;
      const auto take_parameters = [&]() __attribute__((always_inline)) {
        if constexpr (OneKind) {
          pair = broadcast_pair<Law, L>(table[0]);  // memory operands; kept in registers, others would spill
        } else {
          const auto kind = [&](std::size_t k) {
            return batch.material != nullptr ? batch.material[ia[k]] * materials + batch.material[ib[k]] : 0;
          };
          pair = load_pair<Law, L>(table, kind);
        }
      };
      W furthest = radii;  // distance of the centres up to which they interact
      if constexpr (Law::traits.reach) {
        take_parameters();
        furthest = radii + widened(Law::template reach<L>(pair, in_precision<L>(pa.w), in_precision<L>(pb.w)));
      }
      const auto contacts = mask_in_precision<L>(square < furthest * furthest);
      const std::uint32_t now = bits(contacts);
      const auto length = [&] { return sqrt(in_precision<L>(square)); };
      double* state_at = nullptr;
      if constexpr (fields > 0) state_at = batch.state + block * fields * block_size + sub;
      contacts_now |= now << sub;
      constexpr std::uint32_t all = (1u << width) - 1u;
      const std::uint32_t gone_now = before >> sub & all & ~now;
      if constexpr (EnergyTerms && fields > 0)
        for (std::uint32_t gone = gone_now; gone != 0; gone &= gone - 1) {
          const auto k = static_cast<std::size_t>(std::countr_zero(gone));
          parted->add(first + k, state_at + k);
        }
      if (now == 0 || (waiting != nullptr && std::popcount(now) < few)) {
        for (std::uint32_t gone = gone_now; gone != 0; gone &= gone - 1) {
          const auto k = static_cast<std::size_t>(std::countr_zero(gone));
          for (std::size_t f = 0; f < fields; ++f) state_at[f * block_size + k] = 0;
          if (batch.row != nullptr) batch.row[first - first_row + k] = {};
        }
        for (std::uint32_t here = now; here != 0; here &= here - 1)
          waiting->add(first + static_cast<std::size_t>(std::countr_zero(here)));
        if constexpr (is_single<L>)
          gap = min(gap, in_precision<L>(square - furthest * furthest) / (length() + in_precision<L>(furthest)));
        else gap = min(gap, length() - furthest);
        continue;
      }

      const RowLanes<W> va = load_rows<W>(batch.velocity, index_a), wa = load_rows<W>(batch.spin, index_a);
      const RowLanes<W> vb = load_rows<W>(batch.velocity, index_b), wb = load_rows<W>(batch.spin, index_b);
      Vec<W> apart = vb.xyz() - va.xyz();
      if constexpr (Periodic) {
        if (shifted) apart = apart + load_rows<W>(&batch.shifts->velocity, shift).xyz();
      }
      const PairPoint<L> point = pair_point<Law::traits.reach, L>(between, apart, square, pa, pb, va, vb, wa, wb, step);
      const ContactPoint<L>& at = point.at;
      largest = max(largest, relative_overlap(at));

      State state{};
      for (std::size_t f = 0; f < fields; ++f) member<L>(state, kept[f]) = load_lanes<L>(state_at + f * block_size);
      [[maybe_unused]] const State before_step = state;
      if constexpr (!Law::traits.reach) take_parameters();
      const Response<L> response = Law::template evaluate<Features>(at, pair, state);
      const L zero(0.0);
      if constexpr (Law::traits.reach)
        acting_now |=
            (now & (bits(at.overlap >= zero) | bits(response.normal_force > zero) | bits(response.normal_force < zero)))
            << sub;
      if constexpr (EnergyTerms) {
        const Loss<L> own = losses_of<Law, Features>(at, pair, before_step, state, response);
        left.friction = left.friction - widened(select(contacts, own.friction, zero));
        left.rolling = left.rolling - widened(select(contacts, own.rolling, zero));
        left.viscosity = left.viscosity - widened(select(contacts, own.viscosity, zero));
      }
      for (std::size_t f = 0; f < fields; ++f)
        store_lanes(select(contacts, member<L>(state, kept[f]), zero), state_at + f * block_size);

      const PairForces<L> acts = pair_forces(point, response, contacts);
      const L normal_force = select(contacts, response.normal_force, zero);
      const L shown_overlap = select(contacts, at.overlap, zero);

      BodySum* const sum = batch.sum;
      if (batch.row == nullptr) {
        // Padding adds zeros to the last body of the chunk.
        const auto own_b = [=](std::size_t k) { return std::min(ib[k], last_body); };
        store_rows(widened(acts.force.x), widened(acts.force.y), widened(acts.force.z), W(0.0),
                   [=](std::size_t k, const Quad& force) {
                     sum[ia[k]].force -= force;
                     sum[own_b(k)].force += force;
                   });
        store_rows(widened(acts.moment_b.x), widened(acts.moment_b.y), widened(acts.moment_b.z), W(0.0),
                   [=](std::size_t k, const Quad& moment) { sum[own_b(k)].moment += moment; });
      } else {
        ContactRow* const row = batch.row + (first - first_row);
        store_rows(widened(acts.force.x), widened(acts.force.y), widened(acts.force.z), widened(normal_force),
                   [=](std::size_t k, const Quad& force) {
                     store(force, row[k].force);
                     if (sum != nullptr) sum[ia[k]].force -= force;
                   });
        store_rows(widened(acts.moment_b.x), widened(acts.moment_b.y), widened(acts.moment_b.z), widened(shown_overlap),
                   [=](std::size_t k, const Quad& moment) { store(moment, row[k].moment); });
      }
      if (sum != nullptr)
        store_rows(widened(acts.moment_a.x), widened(acts.moment_a.y), widened(acts.moment_a.z), W(0.0),
                   [=](std::size_t k, const Quad& moment) { sum[ia[k]].moment += moment; });
    }
    batch.touching[block] = static_cast<std::uint8_t>(contacts_now);
    if constexpr (Law::traits.reach)
      if (batch.acting != nullptr) batch.acting[block] = static_cast<std::uint8_t>(acting_now);
    // The reduction exceeds the rounding error of the sum and its terms by far.
    if (contacts_now == 0 && batch.asleep_until != nullptr)
      batch.asleep_until[block] = static_cast<float>(smallest(min(L(1 - 1e-6) * (L(batch.closing) + gap), L(1e30))));
  }
  out.largest_overlap = detail::largest(largest);
  if constexpr (EnergyTerms) add_losses(left, *out.losses);
  return block;
}

/// All pairs of a batch.
template <class Law, unsigned Features, class L, bool Periodic, bool OneKind, bool EnergyTerms>
void evaluate_pairs(PairBatch& batch, const typename Law::template Pair<double>* table, std::size_t materials) {
  constexpr auto loop = pair_loop<Law, Features, L, Periodic, OneKind, EnergyTerms>;
  Waiting<kept_fields<Law, Features>.size()> waiting;
  Parted<kept_fields<Law, Features>.size()> parted;
  double largest = 0;
  for (std::size_t next = batch.first_block; next < batch.last_block;) {
    next = loop(batch, table, materials, next, &waiting, &parted);
    if constexpr (EnergyTerms)
      parted.take([&](std::size_t place, std::span<const double> state) {
        lose_springs<Law, Features>(batch, table, materials, place, state);
      });
    largest = std::max(largest, batch.largest_overlap);
    // If only `parted` was full, the collected contacts stay: the energy balance must not change the order of sums.
    if (waiting.none() || (next < batch.last_block && waiting.has_room_for_a_block())) continue;
    PairBatch together = waiting.take(batch);
    loop(together, table, materials, 0, nullptr, nullptr);
    waiting.put_back(batch);
    largest = std::max(largest, together.largest_overlap);
  }
  batch.largest_overlap = largest;
}

/// Calls use(f) for groups of four numbers, starting at f, that cover `count` numbers; the last group may overlap the
/// one before. No calls if count < 4.
template <std::size_t count, class Use>
[[gnu::always_inline]] constexpr void for_fours(Use use) {
  for (std::size_t f = 0; f + 4 <= count; f += 4) use(f);
  if constexpr (count > 4 && count % 4 != 0) use(count - 4);
}

/// The loop over wall contacts. They are few, so histories are stored contact by contact. Not inlined, as pair_loop.
template <class Law, unsigned Features, class L, bool EnergyTerms>
[[gnu::flatten, gnu::noinline]] void wall_loop(WallBatch& batch, const typename Law::template Pair<double>* table,
                                               std::size_t materials) {
  constexpr auto& kept = kept_fields<Law, Features>;
  constexpr std::size_t width = lane_width<L>, fields = kept.size();
  using State = typename Law::template State<L>;
  const L per_dt(batch.dt > 0 ? 1 / batch.dt : 0.0), turns(batch.again ? 0.0 : 1.0);
  const double history_dt = batch.again ? 0 : batch.dt;
  const L place([](std::size_t k) { return k; });
  L most(0.0);
  Loss<L> left{L(0.0), L(0.0), L(0.0)};
  for (std::size_t first = 0; first < batch.count; first += width) {
    const std::size_t used = std::min(width, batch.count - first);
    // Lanes past the end repeat the last contact and are not stored.
    const auto contact = [&](std::size_t k) -> const WallContact& {
      return batch.contact[first + std::min(k, used - 1)];
    };
    const auto body = [&](std::size_t k) { return contact(k).body; };
    const RowLanes<L> pa = load_rows<L>(batch.position, body), va = load_rows<L>(batch.velocity, body),
                      wa = load_rows<L>(batch.spin, body);
    // The members are contiguous: the fourth number of a row belongs to the next member.
    const auto rows = [&](Vec3 WallContact::*member) {
      return load_fours<L>([&](std::size_t k) { return (contact(k).*member).data(); });
    };
    static_assert(offsetof(WallContact, overlap) == offsetof(WallContact, spin) + sizeof(Vec3));
    const Vec<L> normal = rows(&WallContact::normal).xyz(), normal_before = rows(&WallContact::normal_before).xyz(),
                 wall_velocity = rows(&WallContact::velocity).xyz();
    const RowLanes<L> spin_and_overlap = rows(&WallContact::spin);
    const Vec<L> wall_spin = spin_and_overlap.xyz();

    ContactPoint<L> at;
    at.normal = normal;
    at.overlap = spin_and_overlap.w;
    at.radius_a = at.radius_b = pa.w;
    at.branch_fraction = L(1.0);
    at.inverse_mass_a = va.w, at.inverse_mass_b = L(0.0);
    at.turn = make_turn(normal, normal_before, wa.xyz(), wall_spin, history_dt, turns);
    // The last term moves the wall's velocity to the sphere's surface: a sphere that a rotating wall carries along, or
    // that pivots about an edge, does not slip.
    at.velocity = wall_velocity - va.xyz() - cross(pa.w * wa.xyz(), L(0.5) * at.turn.bisector) +
                  (at.overlap * per_dt) * (normal - normal_before);
    at.spin = wall_spin - wa.xyz();
    at.dt = L(history_dt);

    const auto history = [&](std::size_t k) { return batch.state + (first + std::min(k, used - 1)) * fields; };
    State state{};
    for_fours<fields>([&](std::size_t f) __attribute__((always_inline)) {
      const RowLanes<L> row = load_fours<L>([&](std::size_t k) { return history(k) + f; });
      member<L>(state, kept[f]) = row.x, member<L>(state, kept[f + 1]) = row.y;
      member<L>(state, kept[f + 2]) = row.z, member<L>(state, kept[f + 3]) = row.w;
    });
    for (std::size_t f = 0; fields < 4 && f < fields; ++f)
      member<L>(state, kept[f]) = gather_lanes<L>([&](std::size_t k) { return history(k)[f]; });
    const auto kind = [&](std::size_t k) {
      const std::size_t own = batch.material != nullptr ? batch.material[contact(k).body] : 0;
      return own * materials + contact(k).material;
    };
    bool alike = true;
    for (std::size_t k = 1; k < width; ++k) alike = alike & (kind(k) == kind(0));
    const auto pair = alike ? broadcast_pair<Law, L>(table[kind(0)]) : load_pair<Law, L>(table, kind);
    [[maybe_unused]] const State before_step = state;
    const Response<L> response = Law::template evaluate<Features>(at, pair, state);
    if constexpr (EnergyTerms) {
      const Loss<L> own = losses_of<Law, Features>(at, pair, before_step, state, response);
      const auto counts = place < L(static_cast<double>(used));
      left.friction = left.friction - select(counts, own.friction, L(0.0));
      left.rolling = left.rolling - select(counts, own.rolling, L(0.0));
      left.viscosity = left.viscosity - select(counts, own.viscosity, L(0.0));
    }

    // Shear acts where slip is computed: at the sphere's surface, one overlap behind the surface of the wall.
    const Vec<L> force = response.normal_force * normal + response.shear, lever = cross(normal, response.shear);
    const Vec<L> moment_a = -response.moment - pa.w * lever, moment_wall = response.moment + at.overlap * lever;
    for_fours<fields>([&](std::size_t f) __attribute__((always_inline)) {
      store_rows(member<L>(state, kept[f]), member<L>(state, kept[f + 1]), member<L>(state, kept[f + 2]),
                 member<L>(state, kept[f + 3]), [&](std::size_t k, const Quad& numbers) {
                   if (k < used) std::memcpy(history(k) + f, &numbers, sizeof numbers);
                 });
    });
    for (std::size_t k = 0; fields < 4 && k < used; ++k)
      for (std::size_t f = 0; f < fields; ++f) history(k)[f] = lane(member<L>(state, kept[f]), k);
    store_rows(force.x, force.y, force.z, response.normal_force, [&](std::size_t k, const Quad& on_wall) {
      if (k >= used) return;
      store(on_wall, batch.row[first + k].force);
      batch.sum[contact(k).body].force -= on_wall;
    });
    store_rows(moment_wall.x, moment_wall.y, moment_wall.z, at.overlap, [&](std::size_t k, const Quad& on_wall) {
      if (k < used) store(on_wall, batch.row[first + k].moment);
    });
    store_rows(moment_a.x, moment_a.y, moment_a.z, L(0.0), [&](std::size_t k, const Quad& on_body) {
      if (k < used) batch.sum[contact(k).body].moment += on_body;
    });
    most = max(most, at.overlap / pa.w);
  }
  batch.largest_overlap = largest(most);
  if constexpr (EnergyTerms) add_losses(left, *batch.losses);
}

}  // namespace detail

}  // namespace grit
