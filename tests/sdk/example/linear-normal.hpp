// A spring along the normal and nothing else: the least that a contact law can be.
#pragma once

#include "grit/contact/law.hpp"

namespace mine {

struct LinearNormal : grit::LawBase {
  using Settings = NoParameters;
  using Interface = NoParameters;
  struct Material {
    double stiffness = 1e4;
    void declare(Parameters& p) {
      p.add("stiffness", stiffness).unit("N/m").symbol("k").above(0).doc("of one grain's spring; two act in series");
    }
  };

  template <class L>
  struct Pair {
    L stiffness;
  };
  template <class L>
  struct State {};
  static constexpr LawTraits traits{};

  static Pair<double> mix(const Settings&, const Material& a, const Material& b, const Interface&, bool) {
    return {a.stiffness * b.stiffness / (a.stiffness + b.stiffness)};
  }
  template <unsigned Features, class L>
  [[gnu::always_inline]] static Response<L> evaluate(const ContactPoint<L>& at, const Pair<L>& pair,
                                                           State<L>&) {
    return {.normal_force = pair.stiffness * at.overlap};
  }
  static Stiffness stiffness(const PairSize&, const Pair<double>& pair) {
    return {.normal = pair.stiffness};
  }
  static ElasticEnergy energy(const PairSize& size, const Pair<double>& pair, const State<double>&) {
    return {.normal = 0.5 * pair.stiffness * size.overlap * size.overlap};
  }
};

}  // namespace mine
