// Makes a plugin from the struct of a contact law.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "grit/contact/cpu_loop.hpp"
#include "grit/contact/device_kernel.hpp"
#include "grit/contact/law.hpp"
#include "grit/plugin.hpp"

/// The kernel for GPUs, which grit_plugin() of CMake adds to a plugin where nvcc is; else both are null.
extern "C" [[gnu::weak, gnu::visibility("hidden")]] const char grit_ptx[];
extern "C" [[gnu::weak, gnu::visibility("hidden")]] const char grit_ptx_end[];

namespace grit {

/// The ContactLaw that the kernel calls, made from the struct of a law.
template <class Law>
class LawPlugin final : public ContactLaw {
  using Pair = typename Law::template Pair<double>;
  using State = typename Law::template State<double>;

 public:
  void declare(Parameters& parameters) override {
    settings_.declare(parameters);
    if constexpr (has_single)
      parameters.add("precision", precision_)
          .one_of({"double", "single"})
          .doc("precision of contacts between bodies; positions, overlaps, wall contacts and sums stay double");
  }
  void clear_materials() override { materials_.clear(), interfaces_.clear(); }
  void declare_material(const std::string& name, Parameters& parameters) override {
    materials_[name].declare(parameters);
  }
  void declare_interface(const std::string& a, const std::string& b, Parameters& parameters) override {
    interfaces_[std::minmax(a, b)].declare(parameters);
  }
  void mix(std::span<const std::string> materials, std::size_t of_bodies) override {
    count_ = materials.size(), of_bodies_ = of_bodies;
    table_.clear(), wall_table_.clear();
    features_ = 0;
    for (std::size_t i = 0; i < count_; ++i)
      for (std::size_t j = 0; j < count_; ++j) {
        const std::string &a = materials[i], &b = materials[j];
        const auto& interface = interfaces_[std::minmax(a, b)];
        table_.push_back(Law::mix(settings_, materials_[a], materials_[b], interface, false));
        wall_table_.push_back(Law::mix(settings_, materials_[a], materials_[b], interface, true));
        if (i < of_bodies && j < of_bodies) features_ |= features_of(table_.back());
        if (i < of_bodies) features_ |= features_of(wall_table_.back());
      }
  }

  std::vector<StateField> state() const override {
    const auto all = detail::state_fields<Law>();
    std::vector<StateField> kept;
    for (std::size_t f = 0; f < all.size(); ++f)
      if (keeps(f)) kept.push_back(all[f]);
    return kept;
  }
  LawLoop loop() const override {
    LawLoop loop{.lanes = single() ? lane_width<SingleLane> : lane_width<Lane>,
                 .precision = precision_,
                 .parts = {},
                 .inactive = {}};
    for (unsigned bit = 0; bit < detail::feature_count<Law>; ++bit)
      ((features_ >> bit & 1) != 0 ? loop.parts : loop.inactive).push_back(Law::traits.features[bit]);
    return loop;
  }
  void evaluate_pairs(PairBatch& batch) const override {
    if constexpr (has_single)
      if (single()) return pairs<SingleLane>(batch);
    pairs<Lane>(batch);
  }
  void evaluate_pairs_reference(PairBatch& batch) const override {
    if constexpr (has_single)
      if (single()) return pairs<float>(batch);
    pairs<double>(batch);
  }
  void evaluate_walls(WallBatch& batch) const override {
    with_features([&]<unsigned F>() {
      if (batch.losses != nullptr) detail::wall_loop<Law, F, Lane, true>(batch, wall_table_.data(), count_);
      else detail::wall_loop<Law, F, Lane, false>(batch, wall_table_.data(), count_);
    });
  }
  std::optional<DeviceLaw> device() const override {
    if (single()) return {};
    return DeviceLaw{.parameters = std::as_bytes(std::span(table_)),
                     .materials = static_cast<std::uint32_t>(count_),
                     .features = features_,
                     .ptx = {grit_ptx, grit_ptx_end}};
  }
  void evaluate_device_pairs(const DevicePairs& pairs, const void* parameters, std::uint32_t first,
                             std::uint32_t last) const override {
    with_features([&]<unsigned F>() {
      const DevicePairKernel<Law, F> kernel{pairs, static_cast<const Pair*>(parameters),
                                            static_cast<std::uint32_t>(count_)};
      for (std::uint32_t body = first; body < last; ++body) kernel(body);
    });
  }
  Stiffness stiffness(const PairSize& pair, std::size_t a, std::size_t b) const override {
    return Law::stiffness(pair, (pair.wall ? wall_table_ : table_)[a * count_ + b]);
  }
  bool has_reach() const override { return Law::traits.reach; }
  double reach([[maybe_unused]] const PairSize& pair, [[maybe_unused]] std::size_t a,
               [[maybe_unused]] std::size_t b) const override {
    if constexpr (Law::traits.reach)
      return Law::template reach<double>((pair.wall ? wall_table_ : table_)[a * count_ + b], pair.radius_a,
                                         pair.radius_b);
    else return 0;
  }
  std::vector<double> reaches([[maybe_unused]] double radius) const override {
    std::vector<double> all;
    if constexpr (Law::traits.reach)
      for (const bool wall : {false, true})
        for (std::size_t i = 0; i < of_bodies_; ++i)
          for (std::size_t j = 0; j < (wall ? count_ : of_bodies_); ++j)
            all.push_back(Law::template reach<double>((wall ? wall_table_ : table_)[i * count_ + j], radius, radius));
    return all;
  }
  std::vector<double> mixed(std::size_t a, std::size_t b, bool wall) const override {
    const auto* const numbers = reinterpret_cast<const double*>(&(wall ? wall_table_ : table_)[a * count_ + b]);
    return {numbers, numbers + detail::member_count<Pair, double>};
  }
  ElasticEnergy energy(const PairSize& pair, std::size_t a, std::size_t b,
                       std::span<const double> state) const override {
    State numbers{};
    for (std::size_t f = 0, kept = 0; kept < state.size(); ++f)
      if (keeps(f)) detail::member<double>(numbers, f) = state[kept++];
    return Law::energy(pair, (pair.wall ? wall_table_ : table_)[a * count_ + b], numbers);
  }

 private:
  /// Calls `run.operator()<F>()` with the active features as a compile-time constant.
  template <unsigned F = 0, class Run>
  void with_features(Run run) const {
    if constexpr (F < (1u << detail::feature_count<Law>)) {
      if constexpr (F == detail::with_prerequisites<Law>(F))
        if (F == features_) return run.template operator()<F>();
      with_features<F + 1>(run);
    }
  }
  template <class L>
  void pairs(PairBatch& batch) const {
    with_features([&]<unsigned F>() {
      // The scalar reference and several materials take the general loop. Others have loops of their own; in single
      // precision one serves periodic domains and all others.
      const bool general = lane_width<L> == 1 || batch.material != nullptr, energies = batch.losses != nullptr;
      if (general && energies) detail::evaluate_pairs<Law, F, L, true, false, true>(batch, table_.data(), count_);
      else if (general) detail::evaluate_pairs<Law, F, L, true, false, false>(batch, table_.data(), count_);
      else if constexpr (lane_width<L> > 1) {
        if (is_single<L> || batch.image != nullptr) {
          if (energies) detail::evaluate_pairs<Law, F, L, true, true, true>(batch, table_.data(), count_);
          else detail::evaluate_pairs<Law, F, L, true, true, false>(batch, table_.data(), count_);
        } else if constexpr (!is_single<L>) {
          if (energies) detail::evaluate_pairs<Law, F, L, false, true, true>(batch, table_.data(), count_);
          else detail::evaluate_pairs<Law, F, L, false, true, false>(batch, table_.data(), count_);
        }
      }
    });
  }

  static unsigned features_of([[maybe_unused]] const Pair& pair) {
    if constexpr (detail::feature_count<Law> != 0) return detail::with_prerequisites<Law>(Law::features(pair));
    else return 0;
  }
  bool keeps(std::size_t field) const { return (detail::fields_used<Law>(features_) >> field & 1) != 0; }

  static constexpr bool has_single = Law::traits.single_precision;
  bool single() const { return precision_ == "single"; }

  typename Law::Settings settings_;
  std::string precision_ = "double";
  std::map<std::string, typename Law::Material> materials_;
  std::map<std::pair<std::string, std::string>, typename Law::Interface> interfaces_;
  std::vector<Pair> table_, wall_table_;  // of two bodies; of a body and a wall
  std::size_t count_ = 0, of_bodies_ = 0;
  unsigned features_ = 0;
};

/// The PluginInfo that grit_plugin() of a law returns. `doc` is one line.
template <class Law>
PluginInfo contact_law_plugin(const char* name, const char* version, const char* doc,
                              const BuildTag& tag = build_tag()) {
  static_assert(check_law<Law>());
#if defined(__CUDACC__)
  [[maybe_unused]] const auto on_gpu = &detail::pairs_on_gpu<Law>;  // compiles it
#endif
  PluginInfo info{.tag = tag};
  info.kind = "contact", info.name = name, info.version = version, info.doc = doc;
  if constexpr (LawDefinition<Law>) info.make_contact = []() -> ContactLaw* { return new LawPlugin<Law>; };
  return info;
}

}  // namespace grit
