// The kernel that evaluates a law on a device.
#pragma once

#include "grit/contact/device_pairs.hpp"
#include "grit/contact/law_members.hpp"
#include "grit/contact/pair_point.hpp"

namespace grit {

/// Evaluates the pairs of one body. The terms of its sums are added in the order of its list.
template <class Law, unsigned Features>
struct DevicePairKernel {
  using Parameters = typename Law::template Pair<double>;

  DevicePairs in;
  const Parameters* parameters;  ///< [material of a][material of b]
  std::uint32_t materials;

  constexpr void operator()(std::uint32_t own) const {
    using detail::member;
    constexpr auto kept = detail::kept_fields<Law, Features>;
    const detail::PairStep<double> step(in.dt, in.again);
    Vec<double> force{}, moment{};
    double deepest = 0;
    for (std::uint32_t entry = in.first[own]; entry < in.first[own + 1]; ++entry) {
      const DeviceNeighbour other = in.neighbour[entry];
      const std::uint32_t a = other.is_a != 0 ? other.body : own, b = other.is_a != 0 ? own : other.body;
      const RowLanes<double> pa = row(in.position[a]), pb = row(in.position[b]);
      Vec<double> between = pb.xyz() - pa.xyz();
      if (other.image != 0) between = between + row(in.shifts[other.image].position).xyz();
      const double square = dot(between, between);
      const Parameters& pair = parameters[in.material != nullptr ? in.material[a] * materials + in.material[b] : 0];
      double furthest = pa.w + pb.w;
      if constexpr (Law::traits.reach) furthest += Law::template reach<double>(pair, pa.w, pb.w);
      if (!(square < furthest * furthest)) {
        if (in.contact[entry] == 0) continue;
        in.contact[entry] = 0;
        for (std::size_t f = 0; f < kept.size(); ++f) in.state[f * in.entries + entry] = 0;
        continue;
      }
      const RowLanes<double> va = row(in.velocity[a]), vb = row(in.velocity[b]);
      Vec<double> apart = vb.xyz() - va.xyz();
      if (other.image != 0) apart = apart + row(in.shifts[other.image].velocity).xyz();
      const auto point = detail::pair_point<Law::traits.reach, double>(between, apart, square, pa, pb, va, vb,
                                                                       row(in.spin[a]), row(in.spin[b]), step);
      typename Law::template State<double> state{};
      for (std::size_t f = 0; f < kept.size(); ++f) member<double>(state, kept[f]) = in.state[f * in.entries + entry];
      const Response<double> response = Law::template evaluate<Features>(point.at, pair, state);
      for (std::size_t f = 0; f < kept.size(); ++f) in.state[f * in.entries + entry] = member<double>(state, kept[f]);
      const bool acts = point.at.overlap >= 0 || response.normal_force != 0;
      in.contact[entry] = static_cast<std::uint8_t>(DevicePairs::in_contact | (acts ? DevicePairs::is_acting : 0));
      deepest = max(deepest, detail::relative_overlap(point.at));
      const auto on = detail::pair_forces(point, response, true);
      force = other.is_a != 0 ? force + on.force : force - on.force;
      moment = moment + (other.is_a != 0 ? on.moment_b : on.moment_a);
    }
    in.sum[own] = {{force.x, force.y, force.z, deepest}, {moment.x, moment.y, moment.z, 0}};
  }

 private:
  static constexpr RowLanes<double> row(const Row& row) { return {row.x, row.y, row.z, row.w}; }
};

#if defined(__CUDACC__)
namespace detail {

/// Runs the kernel of one body with these features.
template <class Law, unsigned F = 0>
__device__ void evaluate_with(unsigned features, const DevicePairs& pairs,
                              const typename Law::template Pair<double>* parameters, std::uint32_t materials,
                              std::uint32_t body) {
  if constexpr (F < (1u << feature_count<Law>)) {
    if constexpr (F == with_prerequisites<Law>(F))
      if (F == features) return DevicePairKernel<Law, F>{pairs, parameters, materials}(body);
    evaluate_with<Law, F + 1>(features, pairs, parameters, materials, body);
  }
}

/// What a GPU runs, a thread for each body.
template <class Law>
__global__ void pairs_on_gpu(DevicePairs pairs, const typename Law::template Pair<double>* parameters,
                             std::uint32_t materials, unsigned features, std::uint32_t bodies) {
  const std::uint32_t body = blockIdx.x * blockDim.x + threadIdx.x;
  if (body < bodies) evaluate_with<Law>(features, pairs, parameters, materials, body);
}

}  // namespace detail
#endif

}  // namespace grit
